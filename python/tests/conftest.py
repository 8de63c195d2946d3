import os
import pathlib
import shutil
import tempfile

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Each file begins without meshes, so that none depends on those of another one, or of the user.
MESH_CACHE = tempfile.TemporaryDirectory(prefix="ricochet-cache-")
os.environ["RICOCHET_CACHE"] = MESH_CACHE.name


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
