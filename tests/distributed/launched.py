"""ricochet-mpi as a user launches it, for the tests beside this file."""

import contextlib
import json
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "end_to_end"))
import interrupted_runs  # noqa: E402
from harness import DISC, TIME_LIMIT, TestCase, run, settings, with_more  # noqa: E402

PROGRAM = os.environ["RICOCHET_MPI_PROGRAM"]
MPIRUN = os.environ["RICOCHET_MPIRUN"]

PROBES = interrupted_runs.PROBES + """
[[probe]]
name = "wall"
boundary = "boundary"
"""

# A fast disc that bounces once, with friction; few steps, frequent checkpoints.
BOUNCE = {"contact.0.friction": 0.3, "initial.velocity": "[0.03,-0.1]", "output.checkpoint_every": 40,
          "output.fields_every": 20, "time.end": 0.06, "solver.tolerance": 1e-12}


def command(ranks, *arguments):
    return [MPIRUN, "-n", str(ranks), PROGRAM, *map(str, arguments)]


def several(ranks, *arguments, directory=None):
    return subprocess.run(command(ranks, *arguments), cwd=directory, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=TIME_LIMIT)


def own_lines(text):
    """Returns the lines of ricochet, without those of mpirun."""
    return [line for line in text.splitlines() if line.startswith("ricochet")]


def processes_of(process):
    """Returns the processes started by mpirun, in the order of their ranks."""
    found = []
    for folder in pathlib.Path("/proc").iterdir():
        with contextlib.suppress(OSError):
            if folder.name.isdigit() and int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1]) == process.pid:
                found.append(int(folder.name))
    return sorted(found)


class Distributed(TestCase):
    def setUp(self):
        super().setUp()
        self.disc = self.write("disc.toml", with_more(DISC, PROBES))

    def bounce(self, ranks, name, *options, values=None):
        arguments = ["run", self.disc, "-o", self.folder / name, "--quiet", *options, *settings(values or BOUNCE)]
        return several(ranks, *arguments) if ranks > 0 else run(*arguments, "--set", "solver.method=iterative")

    def start(self, ranks, name, values):
        arguments = ["run", self.disc, "-o", self.folder / name, "--quiet", *settings(values)]
        return subprocess.Popen(command(ranks, *arguments), text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)

    def summary(self, name):
        return json.loads((self.folder / name / "summary.json").read_text())

    def expect_same_files(self, one, other):
        for path in (self.folder / one).iterdir():
            if path.suffix in (".csv", ".h5", ".xdmf"):
                self.assertEqual(path.read_bytes(), (self.folder / other / path.name).read_bytes(), path.name)
