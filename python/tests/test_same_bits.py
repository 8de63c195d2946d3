"""Python and the program compute the same bits, on every shipped case."""

import subprocess

import h5py
import numpy
import pytest

import ricochet as rc
from conftest import ROOT

STEPS = 12
CASES = sorted(str(path.relative_to(ROOT)) for path in (ROOT / "cases").glob("*/*.toml"))


def shortened(path):
    """Returns changes that shorten a case to a dozen steps."""
    values = rc.Case(path).values
    step = values["time.step"]
    length = float(values["time.largest"]) if step == "adaptive" else float(step)
    return {"time.end": STEPS * length, "output.fields_every": 4}


def datasets(path):
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


@pytest.mark.parametrize("name", CASES)
def test_a_run_of_python_has_the_bits_of_the_program(name, tmp_path, program):
    path = str(ROOT / name)
    changes = shortened(path)
    arguments = [argument for key, value in changes.items() for argument in ("--set", f"{key}={value!r}")]
    outcome = subprocess.run([program, "run", path, "-o", tmp_path / "program", "--quiet", *arguments], capture_output=True, text=True)
    assert outcome.returncode in (0, 5), outcome.stderr
    run = rc.run(path, tmp_path / "python", changes)
    assert (tmp_path / "program/history.csv").read_bytes() == (tmp_path / "python/history.csv").read_bytes()
    of_program, of_python = datasets(tmp_path / "program/results.h5"), datasets(tmp_path / "python/results.h5")
    assert of_program.keys() == of_python.keys() and len(of_program) > 2
    for key, values in of_program.items():
        assert values.tobytes() == of_python[key].tobytes(), key
    # Python also reads back the content of the files.
    frames = sorted(key for key in of_program if key.startswith("frames/"))
    for field in run.fields:
        last = [key for key in frames if key.endswith("/" + field)][-1]
        assert numpy.array_equal(run.frame(number=-1)[field], of_program[last], equal_nan=True), field


@pytest.mark.parametrize("name", ["cases/puck/puck.toml", "cases/incline/incline.toml", "cases/ball/ball.toml"])
def test_a_loop_of_steps_has_the_bits_of_a_run(name, tmp_path):
    path = str(ROOT / name)
    changes = shortened(path)
    run = rc.run(path, tmp_path / "whole", changes)
    session = rc.Session(path, changes)
    while session.time < session.end:
        assert session.step()
    assert not session.step() and session.at_end
    last = run.frame(number=-1)
    numbers = session.node_numbers
    assert (last["displacement"][numbers][:, :session.dimension] == session.displacement).all()
    assert (run.points[numbers] == session.points).all()
    assert run.history["kinetic_energy"][-1] == session.energies["kinetic_energy"]
