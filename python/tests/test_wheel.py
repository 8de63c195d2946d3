"""A wheel of the existing build, installed into a folder of its own, is complete."""

import importlib.util
import os
import subprocess
import sys

import pytest
from conftest import ROOT

SCRIPT = """
import sys, ricochet as rc
assert rc.__file__.startswith(sys.argv[1]), rc.__file__
run = rc.run(sys.argv[2], sys.argv[3] + "/out", {"time.end": 1e-4})
study = rc.study(sys.argv[2], {"contact.0.friction": [0.0, 0.3]}, sys.argv[3] + "/study", {"time.end": 1e-5})
assert study.done == 2, study.notes
assert open(run.report()).read(2) == "<!"
print(rc.__version__, len(run.time))
"""


@pytest.mark.skipif(importlib.util.find_spec("pip") is None, reason="pip is not installed")
def test_a_wheel_is_complete(tmp_path, program):
    environment = {**os.environ, "RICOCHET_BUILD": os.path.dirname(program), "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    environment.pop("PYTHONPATH", None)
    source = tmp_path / "source"
    source.mkdir()
    for name in ("CMakeLists.txt", "LICENSE", "README.md", "pyproject.toml", "setup.py", "python", "src"):
        (source / name).symlink_to(ROOT / name)
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--no-build-isolation"]
    subprocess.run([*pip, "--target", tmp_path / "site", source], env=environment, check=True, cwd=tmp_path)
    environment.update(PYTHONPATH=str(tmp_path / "site"), LD_LIBRARY_PATH="")
    command = [sys.executable, "-c", SCRIPT, str(tmp_path / "site"), str(ROOT / "cases/puck/puck.toml"), str(tmp_path)]
    outcome = subprocess.run(command, env=environment, capture_output=True, text=True, cwd=tmp_path)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.split()[1] == "101"
    # Its libraries are not those in the folder of the build.
    (module,) = (tmp_path / "site/ricochet").glob("_core.*.so")
    libraries = subprocess.run(["ldd", module], capture_output=True, text=True, check=True).stdout
    assert str(tmp_path / "site/ricochet/lib/libricochet.so.0") in libraries
