import os
import pathlib
import shutil

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture
def cases():
    """The shipped cases."""
    return ROOT / "cases"


@pytest.fixture
def program():
    """The program of the same build."""
    from ricochet.program import program

    return program()


@pytest.fixture
def puck(tmp_path):
    """A copy of the small case cases/puck, to be changed by a test."""
    shutil.copytree(ROOT / "cases" / "puck", tmp_path / "puck")
    os.chdir(tmp_path)
    return str(tmp_path / "puck" / "puck.toml")
