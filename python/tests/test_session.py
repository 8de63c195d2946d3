"""Sessions: steps, their state, and changes between steps."""

import logging
import os
import subprocess
import sys
import threading
import time

import numpy
import pytest

import ricochet as rc

from conftest import ROOT

SHORT = {"time.end": 1e-4}


def test_views_cannot_be_written_and_outlive_the_session(puck):
    session = rc.Session(puck, SHORT)
    view = session.displacement
    with pytest.raises(ValueError):
        view[0, 0] = 1.0
    session.step()
    del session
    assert numpy.isfinite(view).all()


def test_matrices_give_the_energies(puck):
    session = rc.Session(puck, SHORT)
    session.run()
    v, u = session.velocity.reshape(-1), session.displacement.reshape(-1)
    energies = session.energies
    assert 0.5 * v @ (session.mass @ v) == pytest.approx(energies["kinetic_energy"], rel=1e-12)
    stiffness = session.stiffness()
    # The puck has moved as a whole, so the sum consists of large terms that cancel.
    rounding = 8 * numpy.finfo(float).eps * 0.5 * abs(u) @ (abs(stiffness) @ abs(u))
    assert rounding < 1e-5 * energies["kinetic_energy"]
    assert 0.5 * u @ (stiffness @ u) == pytest.approx(energies["elastic_energy"], rel=1e-6, abs=rounding)


def test_reactions_are_the_force_of_the_history(puck, tmp_path):
    with rc.Session(puck, {"time.end": 6e-4}) as session:
        session.write_to(tmp_path / "out")
        seen = []
        session.run(lambda s: seen.append(s.contact_force.sum(axis=0)))
    run = rc.open(tmp_path / "out")
    forces = numpy.array(seen)
    assert forces[:, 1].max() > 0
    assert forces[:, 1] == pytest.approx(run.history["contact_force_y"][1:], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("scheme, friction", [("reduced-kane", 0.3), ("reduced-kane", 0.0), ("mean-reaction", 0.0), ("reduced-midpoint", 0.0)])
def test_contact_forces_change_the_momentum(puck, scheme, friction):
    """Forces that acted over a step; with mean reactions those at its end differ."""
    session = rc.Session(puck, {"time.end": 6e-4, "time.scheme": scheme, "contact.0.friction": friction})

    def momentum():
        return (session.mass @ session.velocity.reshape(-1)).reshape(-1, 2).sum(axis=0)

    momenta, forces, times = [momentum()], [], [session.time]

    def look(session):
        momenta.append(momentum())
        forces.append(session.contact_force.sum(axis=0))
        times.append(session.time)

    session.run(look)
    impulses = numpy.array(forces) * numpy.diff(times)[:, numpy.newaxis]
    assert impulses[:, 1].max() > 1e-4 * momenta[0][0]
    assert numpy.diff(momenta, axis=0) == pytest.approx(impulses, rel=1e-8, abs=1e-12 * momenta[0][0])


def test_loads_velocities_and_obstacles_can_be_changed(puck):
    still = {"initial.velocity": [0.0, 0.0], **SHORT}
    session = rc.Session(puck, still)
    mass = session.mass.sum() / session.dimension
    session.set_velocity([0.0, 2.0])
    assert session.energies["load_work"] == pytest.approx(0.5 * session.velocity.reshape(-1) @ session.mass @ session.velocity.reshape(-1))
    assert session.energies["load_work"] == pytest.approx(2.0 * mass, rel=0.05)
    session.run()
    assert session.displacement[:, 1].mean() == pytest.approx(2.0 * session.time, rel=1e-2)

    wall = rc.Session(puck, {"initial.velocity": [0.0, 0.0], "time.end": 1e-3})
    wall.set_obstacle_velocity("wall", [0.0, 0.0])
    wall.set_obstacle_velocity("wall", [0.0, 0.5])
    wall.run()
    assert wall.energies["obstacle_work"] > 0
    assert abs(wall.energies["energy_residual"]) < 1e-10
    with pytest.raises(rc.UsageError, match="before the session starts"):
        late = rc.Session(puck, SHORT)
        late.step()
        late.set_obstacle_velocity("wall", [0.0, 0.5])
    with pytest.raises(rc.InputError, match="there is no obstacle"):
        rc.Session(puck).set_obstacle_velocity("wal", [0.0, 0.5])

    pulled = rc.Session(puck, still)
    force = numpy.zeros_like(pulled.points)
    force[:, 0] = 1.0
    pulled.set_load(force)
    pulled.run()
    assert pulled.energies["load_work"] > 0
    with pytest.raises(rc.InputError, match="nodes x"):
        pulled.set_load(numpy.zeros(7))
    with pytest.raises(rc.InputError, match="not finite"):
        pulled.set_load([numpy.nan, 0.0])


def test_goes_on_from_bytes_and_files(puck, tmp_path):
    whole = rc.Session(puck, SHORT)
    for _ in range(40):
        whole.step()
    saved = whole.save(tmp_path / "state.ckpt")
    whole.run()
    for source in (saved, tmp_path / "state.ckpt"):
        other = rc.Session(puck, SHORT)
        other.resume(source)
        assert other.step_number == 40
        other.run()
        assert (other.displacement == whole.displacement).all()
    with pytest.raises(rc.InputError):
        rc.Session(puck, SHORT).resume(saved[:-10])
    with pytest.raises(rc.InputError, match="friction"):
        rc.Session(puck, {"contact.0.friction": 0.1, **SHORT}).resume(saved)


def test_errors_in_callbacks_end_the_run_cleanly(puck, tmp_path):
    class Mine(Exception):
        pass

    def each(session):
        if session.step_number == 30:
            raise Mine("thirty")

    with pytest.raises(Mine, match="thirty"):
        rc.run(puck, tmp_path / "out", SHORT, each=each)
    run = rc.open(tmp_path / "out")
    assert run.status == "interrupted" and run.summary["steps"] == 30
    finished = rc.run(puck, tmp_path / "out", SHORT, resume=True)
    whole = rc.run(puck, tmp_path / "whole", SHORT)
    assert (finished.history["total_energy"] == whole.history["total_energy"]).all()


def test_a_failing_step_ends_loops_that_wait_for_the_end(puck, tmp_path):
    # No iteration can solve this case.
    session = rc.Session(puck, {"time.step": 1e-6, "material.0.law": "neo-hookean", "time.end": 5e-3, "initial.velocity": [0, -2000.0]})
    session.write_to(tmp_path / "out")
    with pytest.raises(rc.NotConvergedError) as caught:
        while session.time < session.end:
            session.step()
    assert isinstance(caught.value, ArithmeticError)
    failed = rc.open(tmp_path / "out")
    assert failed.status == "failed"
    with pytest.raises(rc.Error, match="has failed: step"):
        failed.check()


def test_numbers_that_are_not_real_are_refused(puck):
    session = rc.Session(puck, SHORT)
    session.set_obstacle_velocity("wall", [0.0, 0.0])
    session.start()
    load = numpy.zeros_like(session.displacement)
    for wrong in (load + 1j, numpy.ma.masked_array(load, mask=numpy.ones_like(load)), [None, 1.0], "12", [1.0, 2.0j]):
        for use in (session.set_load, session.set_velocity, lambda v: session.set_obstacle_velocity("wall", v)):
            with pytest.raises(rc.InputError, match="real numbers|masked"):
                use(wrong)
    session.set_load(load.astype(numpy.float32))
    session.set_load([1, 2])


def test_steps_after_the_end_are_warned_of(puck):
    session = rc.Session(puck, SHORT)
    while session.step():
        pass
    assert session.warnings == []
    assert not session.step() and not session.step()
    assert len(session.warnings) == 1 and "the run has ended: this call of step()" in session.warnings[0]


def test_a_case_of_somebody_else_is_not_replaced(tmp_path):
    from test_mesh import CASE, square

    points, quads = square()
    mesh = rc.Mesh(points, {"quad": quads}, {"bottom": numpy.flatnonzero(points[:, 1] < 0.01)})
    for name in ("case.toml", "case.msh"):
        folder = tmp_path / name.replace(".", "-")
        folder.mkdir()
        (folder / name).write_text("mine\n")
        for force in (False, True):
            with pytest.raises(rc.FileAccessError, match=f"{name}: no earlier run has written this file"):
                rc.run(CASE, folder, mesh=mesh, force=force)
        assert [path.name for path in folder.iterdir()] == [name] and (folder / name).read_text() == "mine\n"
    assert rc.run(CASE, tmp_path / "out", mesh=mesh).status == "done"
    assert rc.run(CASE, tmp_path / "out", mesh=mesh, force=True).status == "done"


def test_other_threads_work_meanwhile_and_may_not_look(cases):
    session = rc.Session(cases / "ball/ball.toml", {"time.end": 1.0})
    session.start()
    counted, refused, stop = [0], [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            try:
                session.displacement
            except rc.UsageError as problem:
                assert "another thread" in str(problem)
                refused[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    for _ in range(100):
        session.step()
    stop.set()
    thread.join()
    assert counted[0] > 100 and refused[0] > 0


def test_warnings_go_to_logging(puck, caplog):
    with caplog.at_level(logging.INFO, logger="ricochet"):
        session = rc.Session(puck, {"initial.parameters.unused": 1})
    assert len(session.warnings) == 1
    assert [record.levelname for record in caplog.records] == ["WARNING"]
    assert "no formula" in caplog.records[0].getMessage()


def test_what_does_not_fit_together(puck, tmp_path):
    session = rc.Session(puck, SHORT)
    with pytest.raises(rc.UsageError):
        session.finish()
    session.write_to(tmp_path / "out")
    with pytest.raises(rc.UsageError):
        session.write_to(tmp_path / "other")
    session.run()
    run = session.finish()
    assert run.status == "done" and session.finish().status == "done"
    with pytest.raises(rc.UsageError):
        session.step()
    with pytest.raises(rc.FileAccessError, match="already holds a run"):
        rc.run(puck, tmp_path / "out", SHORT)
    assert rc.run(puck, tmp_path / "out", SHORT, resume=True).status == "done"


def test_false_of_numpy_ends_a_run_too(puck):
    for answer in (False, numpy.bool_(False)):
        session = rc.Session(puck, SHORT)
        session.run(lambda s: answer)
        assert session.step_number == 1
    for answer in (None, True, numpy.bool_(True), 0):
        session = rc.Session(puck, SHORT)
        session.run(lambda s: answer)
        assert session.step_number == session.steps


def test_files_that_cannot_be_used_are_errors_of_ricochet(puck, tmp_path):
    session = rc.Session(puck, SHORT)
    for use in (lambda: session.save(tmp_path / "none" / "a"), lambda: session.save(tmp_path), lambda: session.resume(tmp_path / "none")):
        with pytest.raises(rc.FileAccessError, match=f"^{tmp_path}.*: [A-Z]") as caught:
            use()
        assert caught.value.errno and caught.value.filename
    assert sorted(os.listdir(tmp_path)) == ["puck"]  # nothing half written
    for use in (lambda: session.save(3), lambda: session.resume(3), lambda: session.write_to(3), lambda: rc.open(None), lambda: rc.plot(3),
                lambda: rc.open_study([]), lambda: session.write_to(""), lambda: rc.open("a\0b"), lambda: session.write_to(tmp_path / "\udcff")):
        with pytest.raises(rc.UsageError):
            use()


def test_states_are_written_to_pipes_and_not_over_them(puck, tmp_path):
    session = rc.Session(puck, SHORT)
    pipe, got = tmp_path / "pipe", []
    os.mkfifo(pipe)
    thread = threading.Thread(target=lambda: got.append(pipe.read_bytes()))
    thread.start()
    saved = session.save(pipe)
    thread.join()
    assert got == [saved] and pipe.is_fifo()
    link, file = tmp_path / "link", tmp_path / "file"
    file.write_bytes(b"old")
    link.symlink_to(file)
    session.save(link)
    assert link.is_symlink() and file.read_bytes() == saved


@pytest.mark.parametrize("stderr", ["None", "closed()", "full()"])
def test_a_run_outlives_whoever_watches_it(puck, tmp_path, stderr):
    script = f"""
import io, os, sys
import ricochet as rc

from conftest import ROOT

def closed():
    stream = open(os.devnull, "w")
    stream.close()
    return stream

class full(io.StringIO):
    def write(self, text):
        raise BrokenPipeError(32, "nobody reads")

sys.stderr = {stderr}
for progress in (None, True):
    session = rc.Session({puck!r}, {{"time.end": 1e-2}})
    session.run(progress=progress)
    assert session.step_number == session.steps
"""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    outcome = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr


def test_a_run_whose_case_cannot_be_written_is_closed(tmp_path):
    from test_mesh import CASE, square

    points, quads = square()
    mesh = rc.Mesh(points, {"quad": quads}, {"bottom": numpy.flatnonzero(points[:, 1] < 0.01)})
    (tmp_path / "out/case.toml").mkdir(parents=True)
    with pytest.raises(rc.FileAccessError, match="case.toml"):
        rc.run(CASE, tmp_path / "out", mesh=mesh)
    assert rc.open(tmp_path / "out").status == "interrupted"
    (tmp_path / "out/case.toml").rmdir()
    assert rc.run(CASE, tmp_path / "out", mesh=mesh, force=True).status == "done"


def test_a_load_on_tied_nodes_acts_on_what_they_follow():
    session = rc.Session(ROOT / "cases/tied/tied.toml")
    session.start()
    load = numpy.zeros_like(session.displacement)
    load[:, 0] = 1e-3
    before = session.mass @ session.velocity.ravel()
    session.set_load(load)
    for _ in range(5):
        session.step()
    gained = (session.mass @ session.velocity.ravel() - before).reshape(load.shape).sum(axis=0)[0]
    assert abs(gained - load[:, 0].sum() * session.time) < 1e-9 * abs(gained)


@pytest.mark.parametrize("file_format", ["xdmf", "vtkhdf"])
def test_threads_read_what_a_session_writes(puck, tmp_path, file_format):
    session = rc.Session(puck, {"time.end": 2e-4, "output.fields_every": 2, "output.format": file_format})
    session.write_to(tmp_path / "out")
    session.run(lambda s: s.step_number < 20)
    shared, stop, problems = rc.open(tmp_path / "out"), threading.Event(), []

    def read():
        try:
            while not stop.is_set():
                for run in (shared, rc.open(tmp_path / "out")):
                    assert numpy.isfinite(run.frames[-1]["displacement"]).all()
                rc.Case(puck, {"initial.parameters.unused": 1})
        except rc.InputError as problem:
            if "try again" not in str(problem) and "continues" not in str(problem):
                problems.append(problem)
        except BaseException as problem:
            problems.append(problem)

    threads = [threading.Thread(target=read) for _ in range(3)]
    for thread in threads:
        thread.start()
    session.run()
    run = session.finish()
    stop.set()
    for thread in threads:
        thread.join()
    assert not problems
    assert run.status == "done" and len(run.frames) == 101
