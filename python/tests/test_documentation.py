"""Every block of Python in the pages runs in the folder of the case that it uses."""

import os
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

PAGES = ("docs/python.md", "docs/coupling.md")
BLOCKS = [block for page in PAGES for block in re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.S)]


def test_there_are_blocks():
    assert len(BLOCKS) >= 6


@pytest.mark.parametrize("number", range(len(BLOCKS)))
def test_a_block_runs_and_says_something(number, tmp_path):
    shutil.copytree(ROOT / "cases/puck", tmp_path / "puck")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "MPLBACKEND": "Agg"}
    outcome = subprocess.run([sys.executable, "-c", BLOCKS[number]], cwd=tmp_path / "puck", env=environment, capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.strip()
