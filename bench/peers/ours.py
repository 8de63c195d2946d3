"""Runs Ricochet and reads its results."""

import os
import pathlib
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import measurement
from measurement import ROOT, processor_seconds

PROGRAM = pathlib.Path(os.environ.get("RICOCHET", ROOT / "build" / "ricochet"))


def run(case, directory, settings, fields=True, limit=None):
    """Runs the case with `settings` (key: value), writing the fields of every step, or none; for at most `limit`
    seconds."""
    settings = {"output.fields_every": 1 if fields else 0, **settings}
    if fields:
        settings.setdefault("output.fields", '["displacement", "velocity", "acceleration", "contact_pressure", "friction_traction"]')
    command = [str(PROGRAM), "run", str(case), "-o", str(directory), "--force", "--quiet", "--threads", "1"]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        sys.exit(f"{' '.join(command)}: not finished after {limit} s")
    if result.returncode not in (0, 5):  # 5: expectations of the case refer to its own scheme
        sys.exit(f"{' '.join(command)}: {result.stderr.strip()}")


class Steps:
    """Motion and forces of the contact nodes in every step, as arrays by step, node and component."""

    def __init__(self, directory, body, group):
        nodes, lengths = body.nodes(group), body.lengths(group)
        with h5py.File(pathlib.Path(directory) / "results.h5") as file:
            if not np.array_equal(file["mesh/nodes"][:, :2], body.points):
                sys.exit(f"{directory}: its nodes differ from those of the mesh file")
            frames = [file["frames"][name] for name in sorted(file["frames"])]
            self.displacement = np.array([frame["displacement"][:][nodes, :2] for frame in frames])
            self.velocity = np.array([frame["velocity"][:][nodes, :2] for frame in frames])
            self.normal_force = np.array([frame["contact_pressure"][:][nodes] for frame in frames]) * lengths
            self.friction = np.zeros_like(self.displacement)
            if "friction_traction" in frames[0]:
                self.friction = np.array([frame["friction_traction"][:][nodes, :2] for frame in frames]) * lengths[:, None]


def history(directory):
    """Returns the columns of history.csv as arrays."""
    return {name: np.array(column) for name, column in measurement.history(directory).items()}


def states(directory):
    """Returns displacement, velocity and acceleration of all dofs at every step."""
    with h5py.File(pathlib.Path(directory) / "results.h5") as file:
        frames = [file["frames"][name] for name in sorted(file["frames"])]
        return [tuple(frame[name][:, :2].ravel() for name in ("displacement", "velocity", "acceleration")) for frame in frames]
