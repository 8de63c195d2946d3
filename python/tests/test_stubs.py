"""Types: what mypy is told of the module is what is there."""

import os
import subprocess
import sys


def test_stubs_say_what_is_there():
    environment = {**os.environ, "MYPYPATH": os.pathsep.join(path for path in sys.path if path.endswith("build/python"))}
    outcome = subprocess.run([sys.executable, "-m", "mypy.stubtest", "ricochet._core", "--ignore-missing-stub"], env=environment,
                             capture_output=True, text=True, cwd="/tmp")
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
