"""Every example runs, its own assertions hold, and it writes a picture."""

import os
import subprocess
import sys

import pytest
from conftest import ROOT
from matplotlib.image import imread

SCRIPTS = sorted((ROOT / "examples").glob("[0-9]*.py"))
NOTEBOOKS = sorted((ROOT / "examples").glob("*.ipynb"))
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "MPLBACKEND": "Agg"}


def is_a_picture(path):
    """Returns whether a file is a PNG of sufficient size with a drawing: at least one per cent of it is not white."""
    pixels = imread(path)
    return path.read_bytes().startswith(b"\x89PNG") and min(pixels.shape[:2]) > 150 and (pixels[..., :3].min(axis=2) < 0.9).mean() > 0.01


def test_all_are_in_the_gallery():
    assert SCRIPTS and NOTEBOOKS
    gallery = (ROOT / "examples/README.md").read_text(encoding="utf-8")
    for path in SCRIPTS + NOTEBOOKS:
        assert f"({path.name})" in gallery
        picture = ROOT / "examples/pictures" / f"{path.stem}.png"
        assert f"(pictures/{picture.name})" in gallery
        assert is_a_picture(picture) and picture.stat().st_size < 60000


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_runs(script, tmp_path):
    outcome = subprocess.run([sys.executable, "-B", str(script), str(tmp_path / "made")], cwd=tmp_path, env=ENVIRONMENT,
                             capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stderr
    assert len(outcome.stdout.splitlines()) >= 2  # numbers
    assert is_a_picture(tmp_path / "made/picture.png")
    assert [path.name for path in tmp_path.iterdir()] == ["made"]  # and nothing elsewhere


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path, monkeypatch):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    for name in ("PYTHONPATH", "MPLBACKEND"):
        monkeypatch.setenv(name, ENVIRONMENT[name])
    # The kernel leaves files in its home.
    for name in ("IPYTHONDIR", "JUPYTER_RUNTIME_DIR"):
        monkeypatch.setenv(name, str(tmp_path / "kernel"))
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert code and not any(cell.outputs or cell.execution_count for cell in code), "it is stored without outputs"
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert is_a_picture(tmp_path / "out" / path.stem / "picture.png")
