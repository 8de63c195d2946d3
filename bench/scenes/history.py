"""Runs of the program, their histories, and the differences of two histories."""

import json
import math
import os
import pathlib
import re
import subprocess
import sys

from quantities import LENGTH

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs"))

from history_columns import documented_columns  # noqa: E402

TIME_LIMIT = 300  # seconds
OUT_OF_SIGHT = 100  # sizes of the model: a larger gap stands for none
# Errors, which rounding or the time step decides, are not compared.
ENERGIES = {name for name, _, unit, _ in documented_columns() if unit == "energy"} - {"energy_residual", "integration_error", "velocity_correction"}
# Columns by the last part of their names: (class of quantities that are compared, kind, dimensions).
VECTORS = {"contact_force": ("force", "vector", "force"), "force": ("force", "vector", "force"), "support": ("force", "vector", "force"),
           "reaction_tangential": ("force", "vector", "force"), "momentum": ("momentum", "vector", "momentum"),
           "angular_momentum": ("angular momentum", "axial", "angular momentum"), "moment": ("moment", "axial", "energy"),
           "displacement": ("displacement", "vector", "length"), "velocity": ("velocity", "vector", "speed"),
           "rotation": ("rotation", "axial", "angle"), "spin": ("spin", "axial", "rate")}
SCALARS = {"reaction_normal": ("force", "force"), "pressure": ("pressure", "stress"), "gap": ("gap", "length")}


class Run:
    """A finished run: `status`, `messages`, and the columns of its history if there is one."""

    def __init__(self, program, case, output, *arguments, resume=False):
        command = [program, "run", *(["--resume", output] if resume else [case, "-o", output, "--force"]), "--log-level", "info"]
        if "--threads" not in arguments:
            arguments = (*arguments, "--threads", "1")
        try:
            process = subprocess.run([*map(str, command), *arguments], capture_output=True, text=True, timeout=TIME_LIMIT,
                                     check=False, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"})
            self.status, self.messages = process.returncode, process.stderr
        except subprocess.TimeoutExpired:
            self.status, self.messages = "none", f"not finished after {TIME_LIMIT} s"
        self.output, self.columns, self.summary = output, {}, {}
        if (output / "history.csv").exists():
            self.read()

    def read(self):
        self.bytes = (self.output / "history.csv").read_bytes()
        header, *rows = self.bytes.decode("ascii").splitlines()
        values = [list(map(float, row.split(","))) for row in rows]
        self.columns = {name: list(column) for name, column in zip(header.split(","), zip(*values))}
        if (self.output / "summary.json").exists():
            self.summary = json.loads((self.output / "summary.json").read_text(encoding="utf-8"))

    def alike_until(self, other):
        """Returns the first row from which the method itself may differ between two runs: a step that one of them
        divides, or holds, as it found no solution of the whole step, or whose adaptive length differs."""
        times, theirs = self.columns["time"], other.columns["time"]
        rows = min(len(times), len(theirs))
        scale = theirs[-1] / times[-1] if len(times) == len(theirs) and times[-1] > 0 else None
        if scale is None and rows > 1:
            scale = theirs[1] / times[1]
        for k in range(1, rows):
            if abs(theirs[k] - scale * times[k]) > 1e-9 * abs(theirs[k]):
                rows = k
                break
        return min(rows, self.first_makeshift, other.first_makeshift)

    def first_choice(self):
        """Returns the first row in which points of a surface that touches itself represent others."""
        return next((k for k, count in enumerate(self.columns.get("left_out_points", [])) if count > 0), len(self.columns["time"]))

    @property
    def first_makeshift(self):
        """Returns the first row of a step that was divided or held; infinite if none was."""
        rows = [int(number) for number in re.findall(r"step (\d+) is computed in parts", self.messages)]
        times = [float(time) for time in re.findall(r"at t = (\S+) the pairing of", self.messages)]
        rows += [next((k for k, t in enumerate(self.columns["time"]) if t >= 0.999 * time), 0) for time in times]
        return min(rows, default=math.inf)

    def error(self):
        lines = [line for line in self.messages.splitlines() if line.startswith("ricochet: ")]
        return lines[-1].split(": ", 2)[-1] if lines else ""

    def energy_scale(self):
        return max((max(map(abs, self.columns[name])) for name in ("kinetic_energy", "elastic_energy", "total_energy")), default=0.0)

    def finite(self):
        return all(math.isfinite(v) for column in self.columns.values() for v in column)


def quantities_of(names, dimension):
    """Returns [(class, kind, dimensions, names of the columns)] of the quantities compared."""
    result, used = [], set()
    for name in names:
        tail = name.split(".")[-1]
        base, _, axis = tail.rpartition("_")
        if name in used:
            continue
        if name in ENERGIES:
            result.append(("energy", "scalar", "energy", [name]))
        elif tail in SCALARS:
            family, dims = SCALARS[tail]
            result.append((family, "scalar", dims, [name]))
        elif axis in ("x", "y", "z") and (base in VECTORS or name.startswith("momentum.") or name.startswith("pair_force.")):
            key = base if base in VECTORS else "momentum" if name.startswith("momentum.") else "force"
            family, kind, dims = VECTORS[key]
            axes = "z" if kind == "axial" and dimension == 2 else "xyz"[:dimension]
            columns = [f"{name[:-1]}{a}" for a in axes]
            used.update(columns)
            result.append((family, kind, dims, columns))
    return result


def floors(scene, run):
    """Returns the sizes below which differences of a class are meaningless: the rounding of positions and forces."""
    energy, mass, size = run.energy_scale(), scene.mass(), scene.size()
    momentum = math.sqrt(2 * mass * energy)
    return {"energy": energy, "force": 0.1 * energy / size, "moment": 0.1 * energy, "momentum": momentum,
            "angular momentum": momentum * size, "displacement": 1e-6 * size, "gap": 1e-6 * size}


def as_seen(values, kind, dims, frame):
    if kind == "axial" and len(values) == 1:
        return (frame.apply(values[0], "axial", dims),)
    if kind == "scalar":
        return (frame.apply(values[0], "scalar", dims),)
    return frame.apply(tuple(values), kind, dims)


def deviations(scene, run, other, frame, keep=lambda family, columns: True, adjust=None, until=math.inf):
    """Returns the largest difference per row of `run`, seen in `frame`, from `other`, relative to the largest of its
    class; and the worst column.

    `adjust(columns, values, time)` may change the values of `run` before they are transformed, as by the motion of an
    observer; only rows before `until` are compared.
    """
    dims_of, d = scene.dims, scene.dimension
    chosen = [q for q in quantities_of(run.columns, d) if keep(q[0], q[3]) and all(c in other.columns for c in q[3])]
    scales, far = floors(scene, run), OUT_OF_SIGHT * scene.size()
    for family, _, _, columns in chosen:
        scales[family] = max(scales.get(family, 0.0), *(max((v for v in map(abs, run.columns[c]) if family != "gap" or v < far), default=0.0) for c in columns))
    rows, worst = [], (0.0, "")
    for k in range(min(until, run.alike_until(other), len(run.columns["time"]))):
        largest = 0.0
        for family, kind, dims, columns in chosen:
            scale = scales[family] * frame.factor(dims_of[dims])
            if scale == 0:
                continue
            values = [run.columns[c][k] for c in columns]
            if family == "gap" and min(abs(values[0]), abs(other.columns[columns[0]][k]) / frame.factor(LENGTH)) > far:
                continue
            if adjust:
                values = adjust(columns, values, run.columns["time"][k])
            seen = as_seen(values, kind, dims_of[dims], frame)
            if family == "angular momentum" and any(frame.shift):
                seen = moved_moment(run, k, columns, seen, frame, dims_of)
            difference = max(abs(a - other.columns[c][k]) for a, c in zip(seen, columns)) / scale
            largest = max(largest, difference)
            worst = max(worst, (difference, f"{columns[0]} in row {k}"))
        rows.append(largest)
    return rows, worst


def moved_moment(run, k, columns, seen, frame, dims_of):
    """Returns the angular momentum about the origin of the other frame, which adds the moment of the momentum at the
    shift."""
    d = len(frame.shift)
    p = frame.apply(tuple(run.columns[f"momentum_{a}"][k] for a in "xyz"[:d]), "vector", dims_of["momentum"])
    s = [frame.length * x for x in frame.shift]
    if d == 2:
        return (seen[0] + s[0] * p[1] - s[1] * p[0],)
    return tuple(a + s[(i + 1) % 3] * p[(i + 2) % 3] - s[(i + 2) % 3] * p[(i + 1) % 3] for i, a in enumerate(seen))
