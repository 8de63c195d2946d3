"""Ends of sessions: interruptions, signals and exceptions leave a checkpoint from which a run can continue."""

import logging
import os
import signal
import subprocess
import sys
import time

import pytest

import ricochet as rc
from ricochet import stopping

SHORT = {"time.end": 1e-4}


def test_ctrl_c_leaves_a_run_to_go_on_with(puck, tmp_path):
    script = f"import ricochet as rc; rc.run({puck!r}, {str(tmp_path / 'out')!r}, {{'time.end': 1.0}})"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    child = subprocess.Popen([sys.executable, "-c", script], env=environment, stderr=subprocess.PIPE, text=True)
    deadline = time.time() + 60
    while time.time() < deadline and not (tmp_path / "out/history.csv").exists():
        time.sleep(0.1)
    time.sleep(1.0)
    child.send_signal(signal.SIGINT)
    _, said = child.communicate(timeout=60)
    assert child.returncode == -signal.SIGINT or "KeyboardInterrupt" in said
    run = rc.open(tmp_path / "out")
    assert run.status == "interrupted" and run.summary["steps"] > 0
    assert run.summary["checkpoint_step"] == run.summary["steps"]


def interrupted_by(number, script, output):
    """Ends a script by a signal during its run. Returns the status of the process, and the run."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    child = subprocess.Popen([sys.executable, "-c", script], env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "going\n", child.stderr.read()
    time.sleep(0.3)
    child.send_signal(number)
    child.communicate(timeout=60)
    return child.returncode, rc.open(output)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("loop", ["session.run()", "while session.step(): pass", "session.step(); time.sleep(60)",
                                  "session.run(lambda s: time.sleep(1))"])
def test_what_ends_the_program_with_a_checkpoint_does_so_here(puck, tmp_path, number, loop):
    script = f"""
import time, ricochet as rc
session = rc.Session({puck!r}, {{"time.end": 10.0}})
session.write_to({str(tmp_path / 'out')!r})
print("going", flush=True)
{loop}
"""
    status, run = interrupted_by(number, script, tmp_path / "out")
    assert status == 128 + number
    assert run.status == "interrupted" and run.summary["checkpoint_step"] > 0
    assert run.summary["checkpoint_step"] == run.summary["steps"]
    if loop == "session.run()":  # in other loops it may arrive between two steps
        assert f"stopped by {signal.Signals(number).name}" in run.summary["message"]
    assert rc.Session(puck, {"time.end": 10.0}).write_to(tmp_path / "out", resume=True) is None


def test_a_handler_of_the_program_stays(puck, tmp_path):
    heard = []
    stopping._writing.clear()  # sessions of other tests
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    before = signal.signal(signal.SIGTERM, lambda *_: heard.append(True))
    try:
        session = rc.Session(puck, SHORT)
        session.write_to(tmp_path / "out")
        os.kill(os.getpid(), signal.SIGTERM)
        session.run()
        assert session.finish().status == "done" and heard == [True]
    finally:
        signal.signal(signal.SIGTERM, before)
    with rc.Session(puck, SHORT) as session:
        session.write_to(tmp_path / "other")
        assert signal.getsignal(signal.SIGTERM) is not before
        session.run()
    assert signal.getsignal(signal.SIGTERM) is before


def test_an_exception_leaves_a_checkpoint_also_of_a_session_without_a_context(puck, tmp_path):
    def each(s):
        if s.step_number == 7:
            raise ValueError("seven")

    session = rc.Session(puck, SHORT)
    session.write_to(tmp_path / "out")
    with pytest.raises(ValueError, match="seven"):
        session.run(each)
    assert [path.name for path in (tmp_path / "out").glob("*.ckpt")] == ["checkpoint-000000007.ckpt"]
    session.run()  # and the session can continue
    session.finish()
    whole = rc.run(puck, tmp_path / "whole", SHORT)
    assert (tmp_path / "out/history.csv").read_bytes() == (tmp_path / "whole/history.csv").read_bytes() and whole.status == "done"


def test_ctrl_c_within_a_message_ends_the_run(puck, tmp_path, caplog):
    """A handler of messages is Python code, too, in which the interruption may occur."""
    class Interrupted(logging.Handler):
        def emit(self, record):
            if "rotated" in record.getMessage():
                signal.raise_signal(signal.SIGINT)
                for _ in range(1000):  # it is raised between two instructions
                    pass

    handler = Interrupted()
    logging.getLogger("ricochet").addHandler(handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            rc.run(puck, tmp_path / "out", {"time.end": 1.0})
    finally:
        logging.getLogger("ricochet").removeHandler(handler)
    run = rc.open(tmp_path / "out")
    assert run.status == "interrupted" and 4000 < run.summary["steps"] < 10000
