"""Helpers of the end-to-end tests: running the program, reading a history, a small case to start from.

The program and the source tree come from the environment (CTest sets both): RICOCHET_PROGRAM and RICOCHET_SOURCE_DIR. By hand,
`python3 -B -m unittest hertz_test.Hertz` runs the tests of a class.
"""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = pathlib.Path(os.environ["RICOCHET_PROGRAM"])
SOURCE = pathlib.Path(os.environ["RICOCHET_SOURCE_DIR"])
MESHES = SOURCE / "tests" / "data" / "meshes"
SCRIPT = pathlib.Path(sys.argv[0])
if SCRIPT.name.endswith("_test.py") and "__main__" not in SCRIPT.read_text(encoding="utf-8"):
    sys.exit(f"{SCRIPT}: python3 -B -m unittest {SCRIPT.stem} runs its tests; as a program it would run none")
# Time limit in seconds for a run of the program: much longer with the sanitizers.
TIME_LIMIT = float(os.environ.get("RICOCHET_TIME_LIMIT", "500"))
DISC = SOURCE / "cases" / "disc" / "disc.toml"
sys.path.insert(0, str(SOURCE / "benchmarks"))  # closed forms

# In a quantity, a row that is neither the first nor the last: it belongs to another time once the step is changed.
OTHER_ROW = re.compile(r"\[(?!0\]|-1\])")

# A square of side 1 in the group "body": four nodes, all of them on its boundary, "bottom".
TWO_TRIANGLES = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "bottom"
2 2 "body"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
6
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 1 1 3 4
4 1 2 1 1 4 1
5 2 2 2 1 1 2 3
6 2 2 2 1 1 3 4
$EndElements
"""

# Each scheme with its usual mass.
SCHEMES = {"midpoint": "consistent", "klr-conserving": "consistent", "newmark": "equivalent",
           "semi-explicit": "equivalent-lumped", "reduced-kane": "equivalent"}


def between_plates(motion):
    """Returns obstacles and contacts for a disc of diameter 5 with the boundary "skin" on a plate, under another one that moves."""
    return """[obstacle.bottom]
type = "plane"
point = [0, 0]
normal = [0, 1]
[obstacle.top]
type = "plane"
point = [0, 5.0]
normal = [0, -1]
motion = ["0", "MOTION"]
[[contact]]
group = "skin"
obstacle = "bottom"
friction = 0.3
[[contact]]
group = "skin"
obstacle = "top"
friction = 0.3
""".replace("MOTION", motion)


def method(scheme, preset="textbook-half"):
    """Returns the settings that give a case a scheme, with its mass; newmark also needs its parameters."""
    values = {"time.scheme": scheme, "mass.type": SCHEMES[scheme]}
    return values | {"time.preset": preset} if scheme == "newmark" else values


def body_case(mesh, point, up, drive, *, body="body", bottom="bottom", degree=None, lame=(100.0, 50.0), mass="consistent",
              scheme="newmark", step=0.01, end=0.3):
    """Returns a body of one material and a floor; `drive` are the sections that make it move."""
    return (f'[mesh]\nfile = "{mesh}"\n' + (f"degree = {degree}\n" if degree else "")
            + f'[[material]]\ngroup = "{body}"\ndensity = 1.0\nlambda = {lame[0]}\nmu = {lame[1]}\n'
            f'[obstacle.floor]\ntype = "plane"\npoint = {list(point)}\nnormal = {list(up)}\n'
            f'[[contact]]\ngroup = "{bottom}"\nobstacle = "floor"\n'
            f'{drive}[mass]\ntype = "{mass}"\n[time]\nscheme = "{scheme}"\n'
            + ('preset = "trapezoidal"\n' if scheme == "newmark" else "") + f"step = {step}\nend = {end}\n")


def gravity(*acceleration):
    return f"[load]\ngravity = {list(acceleration)}\n"


def initial_velocity(*velocity):
    return f"[initial]\nvelocity = {list(velocity)}\n"


def block_case(mesh="quadrilateral_o1_msh41_ascii.msh"):
    """Returns a block of quadrilaterals (the parallelogram of quadrilateral.geo) that falls on a floor."""
    return ('title = "A block falls"\n' + body_case(MESHES / mesh, [0.0, 0.0], [0.0, 1.0], gravity(0.0, -10.0))
            + '[[probe]]\nname = "foot"\nat = [1.3, 0.1]\n')


# A disc of radius 1 that rotates by 0.07 rad until it has left a smooth floor again; no cell rotates by more than 0.1
# rad.
SPINNING = body_case(MESHES / "disc_o2_msh41_ascii.msh", [0.0, 0.0], [0.0, 1.0],
                     '[initial]\nvelocity = ["-0.1*(y - 1.005)", "-0.05 + 0.1*x"]\n', bottom="boundary", degree=2, mass="equivalent",
                     scheme="reduced-kane", step=0.01, end=0.9).replace("degree", "refine = 2\nmove = [0.0, 1.005]\ndegree", 1)


def with_sphere(case, centre, radius, velocity):
    """Returns a case of `body_case` with a moving sphere in place of the floor."""
    sphere = f'type = "sphere"\ncentre = {centre}\nradius = {radius}\nvelocity = {velocity}\n'
    return re.sub(r'type = "plane"\npoint = .*\nnormal = .*\n', sphere, case)


def with_more(path, text):
    """Returns a case of the collection with additional sections and without its expectations, to be written
    anywhere."""
    case = path.read_text(encoding="utf-8").split("[[expect]]")[0]
    return case.replace('file = "', f'file = "{path.parent}/') + text


# Each script begins without meshes, so that none depends on those of another one, or of the user.
MESH_CACHE = tempfile.TemporaryDirectory(prefix="ricochet-cache-")
os.environ["RICOCHET_CACHE"] = MESH_CACHE.name
# Precedes a command that is to respect the modes of files and folders, which root may override.
RESPECTS_MODES = ("setpriv", "--bounding-set", "-dac_override", "--") if os.geteuid() == 0 else ()


def run(*arguments, directory=None, environment=None, before=()):
    """Returns the finished process of the program, with its output as text. `before` precedes the command."""
    return subprocess.run([*before, str(PROGRAM), *map(str, arguments)], cwd=directory, env=environment, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=TIME_LIMIT)


def settings(values):
    """Returns the command-line arguments of `--set` for a dictionary of key paths."""
    return [argument for key, value in values.items() for argument in ("--set", f"{key}={value}")]


class History:
    """history.csv, read strictly: the same number of fields in every row, none empty, every one a finite number."""

    def __init__(self, path):
        text = pathlib.Path(path).read_text(encoding="ascii")
        if not text.endswith("\n"):
            raise ValueError(f"{path}: the last line is not complete")
        header, *lines = text[:-1].split("\n")
        self.names = header.split(",")
        if len(set(self.names)) != len(self.names):
            raise ValueError(f"{path}: a column is there twice")
        self.rows = []
        for number, line in enumerate(lines, start=2):
            fields = line.split(",")
            if len(fields) != len(self.names):
                raise ValueError(f"{path}:{number}: {len(fields)} fields under {len(self.names)} columns")
            row = [float(field) for field in fields]  # an empty field is no number
            if not all(map(math.isfinite, row)):
                raise ValueError(f"{path}:{number}: a number is not finite")
            self.rows.append(row)

    def __getitem__(self, name):
        column = self.names.index(name)
        return [row[column] for row in self.rows]

    def largest_energy(self):
        return max(abs(value) for name in ("total_energy", "kinetic_energy", "elastic_energy") for value in self[name])


def summary_of(folder):
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def write_msh(path, groups, nodes, cells):
    """Writes a mesh in Gmsh's format 2.2: `groups` as '2 1 "body"', points of the plane, cells as (type, group, corners)."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups)), *groups, "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{i} {x!r} {y!r} 0" for i, (x, y) in enumerate(nodes, start=1)] + ["$EndNodes", "$Elements", str(len(cells))]
    lines += [f"{i} {kind} 2 {tag} {tag} {' '.join(map(str, corners))}" for i, (kind, tag, corners) in enumerate(cells, start=1)]
    path.write_text("\n".join(lines + ["$EndElements"]) + "\n", encoding="ascii")


def wait_for(condition, seconds=60):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError("nothing has happened")
        time.sleep(0.002)


def total_variation(values):
    return sum(abs(after - before) for before, after in zip(values, values[1:]))


class TestCase(unittest.TestCase):
    """A test with a folder of its own, which is removed afterwards."""

    maxDiff = None

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ricochet-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def expect_status(self, status, process):
        self.assertEqual(process.returncode, status,
                         f"{' '.join(map(str, process.args))}\nstdout:\n{process.stdout}\nstderr:\n{process.stderr}")
        return process

    def simulate(self, case, name="out", values=None, options=("--quiet",)):
        """Runs a case that must succeed. Returns the folder of its results."""
        output = self.folder / name
        self.expect_status(0, run("run", case, "-o", output, *options, *settings(values or {})))
        return output
