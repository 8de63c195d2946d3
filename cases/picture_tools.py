"""Code shared by the pictures of the cases: runs, and files."""
import csv
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "benchmarks"))  # closed forms
EXACT = {"color": "0.6", "linewidth": 4, "solid_capstyle": "butt"}


def run(case, name, *settings):
    """The columns of history.csv by name, as arrays."""
    directory = f"out/pictures/{name}"
    command = ["build/ricochet", "run", f"cases/{case}.toml", "-o", directory, "--force", "--quiet", "--log-level", "error"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(f"{directory}/history.csv", newline="") as file:
        rows = csv.reader(file)
        names = next(rows)
        return dict(zip(names, np.array([[float(entry) for entry in row] for row in rows]).T))


def save(figure, path):
    for axes in figure.axes:
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=80)
    print(path)
