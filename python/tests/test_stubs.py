"""Types: the stubs for mypy agree with the module, and the package with the stubs."""

import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).parent


def mypy(*arguments):
    package = next(path for path in sys.path if os.path.isfile(os.path.join(path, "ricochet/_core.pyi")))
    outcome = subprocess.run([sys.executable, "-m", *arguments], env={**os.environ, "PYTHONPATH": package, "MYPYPATH": package, "MYPY_CACHE_DIR": os.devnull},
                             capture_output=True, text=True, cwd="/")
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr


def test_stubs_say_what_is_there():
    mypy("mypy.stubtest", "ricochet._core", "--mypy-config-file", str(HERE / "mypy.ini"), "--allowlist", str(HERE / "stubtest_allowed.txt"))


def test_the_package_keeps_to_its_types():
    mypy("mypy", "--config-file", str(HERE / "mypy.ini"), "-p", "ricochet")
