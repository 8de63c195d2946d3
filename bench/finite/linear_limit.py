#!/usr/bin/env python3
"""In the limit of small loads, laws of finite strain agree with the linear law.

    /usr/bin/python3 bench/finite/linear_limit.py [CASE.toml …] [--factors 1e-7 1e-8 1e-4] [--seconds 120] [--output out/linear-limit]

Runs cases with loads, velocities, prescribed and initial displacements, velocities of obstacles, bounds of friction and the gaps of
the start times a factor, once with law = "linear" and once with each law of finite strain, and compares forces and displacements of
history.csv, each relative to the largest in the linear run. Coefficients of friction, times and stiffnesses stay as they are, so that the motion is
the same one, times the factor. Exceptions, which the table names:

- Gaps are scaled by moving planes along their normals, and parts towards each other. Where the boundary is curved, so is the gap,
  and the curvature stays: fewer nodes touch than in the case. A bowl is not moved.
- Stiffness damping, which finite strain refuses, is omitted.
- Displacements are found to the rounding of positions, so a stiff body whose displacements are small already needs a larger factor.
- With friction, and between bodies, reduced-kane uses the end reactions at finite strain, and so does the linear run here.
- A run that takes longer than --seconds is stopped: the steps until then are compared.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tomllib

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from measurement import BUILD, ROOT, history

AGREEMENT = 1e-6
LAWS = ("saint-venant-kirchhoff", "neo-hookean")
# Parts that start at a distance, with the motion that closes (1 - factor) of the gap.
GAPS_OF_PARTS = {"bars-pair/pair": ("two", 0, 0.0005), "bars-pair/hammer": ("pile", 0, 0.0005), "balls/balls": ("upper", 2, 4.76e-8),
                 "balls/unequal": ("upper", 2, 3.57e-8), "ball-block/ball-block": ("ball", 2, 6.418e-8)}


def scaled(value, factor):
    if isinstance(value, str):
        return value if value == "static" else f"({factor!r})*({value})"
    return [scaled(entry, factor) for entry in value] if isinstance(value, list) else factor * value


def closest(path, case, contact, obstacle):
    """Returns the smallest distance of a contact boundary from a plane, and whether all of it has that distance."""
    import meshio  # python3-meshio

    names = [contact["group"]] if isinstance(contact["group"], str) else contact["group"]
    part, group = names[0].split(".", 1) if "part" in case else (None, names[0])
    entry = case["part"][part] if part else case["mesh"]
    if "turn" in entry:
        return 0.0, False
    mesh = meshio.read(path.parent / entry["file"])
    tag, of_group = mesh.field_data[group]
    blocks = [block.data[tags == tag] for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]) if block.dim == of_group]
    nodes = np.unique(np.concatenate([block.ravel() for block in blocks]))
    dimension = len(obstacle["normal"])
    places = mesh.points[nodes, :dimension] * entry.get("scale", 1.0) + np.array(entry.get("move", [0.0] * dimension))
    normal = np.array(obstacle["normal"]) / np.linalg.norm(obstacle["normal"])
    gaps = (places - np.array(obstacle["point"])) @ normal
    return gaps.min(), gaps.max() - gaps.min() < 1e-9 * np.ptp(mesh.points)


def overrides(path, case, factor):
    """Returns settings that scale the case, and the quantities that could not be scaled."""
    settings, notes = {}, []
    for section, keys in (("load", ("gravity", "body_force")), ("initial", ("displacement", "velocity"))):
        for key in keys:
            if key in case.get(section, {}):
                settings[f"{section}.{key}"] = scaled(case[section][key], factor)
    for section, keys in (("support", ("value",)), ("traction", ("value",)), ("motion", ("velocity", "spin")), ("contact", ("friction_bound",))):
        for number, entry in enumerate(case.get(section, [])):
            for key in keys:
                if key in entry:
                    settings[f"{section}.{number}.{key}"] = scaled(entry[key], factor)
    for name, part in case.get("part", {}).items():
        for key in ("velocity", "spin"):
            if key in part:
                settings[f"part.{name}.{key}"] = scaled(part[key], factor)
    for number, material in enumerate(case["material"]):
        if material.get("damping", {}).get("stiffness", 0.0):
            settings[f"material.{number}.damping.stiffness"] = 0.0
            notes.append("without damping")
    for name, obstacle in case.get("obstacle", {}).items():
        for key in ("velocity", "rotation_rate"):
            if key in obstacle:
                settings[f"obstacle.{name}.{key}"] = scaled(obstacle[key], factor)
        if obstacle["type"] != "plane":
            notes.append("curved obstacle, not moved")
            continue
        gaps = [closest(path, case, contact, obstacle) for contact in case["contact"] if contact.get("obstacle") == name]
        gap = min(entry[0] for entry in gaps)
        if not all(entry[1] for entry in gaps):
            notes.append("curved boundary: fewer nodes touch")
        if gap > 0:
            normal = np.array(obstacle["normal"]) / np.linalg.norm(obstacle["normal"])
            settings[f"obstacle.{name}.point"] = [float(x) for x in np.array(obstacle["point"]) + (1.0 - factor) * gap * normal]
    for name, entry in [("mesh", case["mesh"])] * ("file" in case.get("mesh", {})) + [(f"part.{name}", entry) for name, entry in case.get("part", {}).items()]:
        settings[f"{name}.file"] = str(path.parent / entry["file"])
    time = case["time"]
    if time.get("scheme", "reduced-kane") == "reduced-kane" and "reaction_weight" not in time and any("friction" in contact or "against" in contact for contact in case["contact"]):
        settings["time.reaction_weight"] = "end"
        notes.append("end reactions")
    key = f"{path.parent.name}/{path.stem}"
    if key in GAPS_OF_PARTS:
        part, axis, gap = GAPS_OF_PARTS[key]
        move = list(case["part"][part].get("move", [0.0, 0.0, 0.0]))
        move[axis] -= (1.0 - factor) * gap
        settings[f"part.{part}.move"] = move
    return settings, notes


def run(path, settings, directory, seconds, program):
    command = [program, "run", path, "-o", directory, "--force", "--quiet", "--log-level", "error", "--threads", "1", "--set", "output.fields_every=0"]
    for key, value in settings.items():
        command += ["--set", f"{key}={json.dumps(value) if not isinstance(value, str) else value}"]
    done = subprocess.run(["timeout", str(seconds), *map(str, command)], cwd=ROOT, check=False, capture_output=True, text=True)
    if done.returncode not in (0, 5, 124, 143):
        return done.stderr.strip().split("\n")[-1]
    if not (directory / "history.csv").is_file():
        return f"not started within {seconds:g} s"
    return {name: np.array(column) for name, column in history(directory).items()}


def differences(linear, other):
    """Returns the largest difference of forces and of displacements, relative to the largest of the run, and the number
    of steps compared."""
    rows = min(len(linear["step"]), len(other["step"]))
    found = {}
    for kind, words in (("force", ("force", "reaction")), ("displacement", (".displacement",))):
        names = [name for name in linear if any(word in name for word in words) and name[-2:] in ("_x", "_y", "_z")]
        scale = max((np.abs(linear[name][:rows]).max() for name in names), default=0.0)
        found[kind] = max((np.abs(linear[name][:rows] - other[name][:rows]).max() / scale for name in names), default=0.0) if scale else 0.0
    return found["force"], found["displacement"], rows - 1


def compare(path, factor, seconds, output, program):
    with open(path, "rb") as file:
        case = tomllib.load(file)
    if any(material.get("law", "linear") != "linear" for material in case["material"]):
        return None
    settings, notes = overrides(path, case, factor)
    name = f"{path.parent.name}/{path.stem}"
    text = path.read_text(encoding="utf-8").split("[[expect]]")[0]
    path = output / name / path.name
    path.parent.mkdir(parents=True, exist_ok=True)
    # Some cases watch only nodes that touch; something must move.
    path.write_text(text + '\n[[probe]]\nname = "whole-body"\ngroup = "all"\n', encoding="utf-8")
    linear = run(path, settings, output / name / "linear", seconds, program)
    cells, worst = [], 0.0
    for law in LAWS:
        of_law = {f"material.{number}.{key}": value for number in range(len(case["material"])) for key, value in (("law", law), ("dilatation", "pointwise"))}
        other = run(path, settings | of_law, output / name / law, seconds, program)
        problem = linear if isinstance(linear, str) else other
        if isinstance(problem, str):
            cells += [problem[:150], "", ""]
            worst = float("inf")
        else:
            force, displacement, steps = differences(linear, other)
            cells += [f"{force:.1e}", f"{displacement:.1e}", str(steps)]
            worst = max(worst, force, displacement)
    return worst, [name, f"{factor:g}", *cells, "; ".join(dict.fromkeys(notes))]


def best(path, factors, *arguments):
    """Returns the first factor at which the laws agree, or else the one with the best agreement."""
    found = []
    for factor in factors:
        result = compare(path, factor, *arguments)
        if result is None:
            return None
        found.append(result)
        if result[0] <= AGREEMENT:
            break
    return min(found, key=lambda entry: entry[0])[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", type=pathlib.Path, help="case files (default: all of cases/)")
    parser.add_argument("--factors", type=float, nargs="+", default=[1e-7, 1e-8, 1e-4], help="factors of loads, motions and gaps; the first suitable one is used (default: %(default)s)")
    parser.add_argument("--seconds", type=float, default=120, help="time after which a run is stopped (default: %(default)s)")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "out" / "linear-limit", help="directory of the runs (default: %(default)s)")
    parser.add_argument("--program", type=pathlib.Path, default=BUILD / "ricochet", help="(default: %(default)s)")
    arguments = parser.parse_args()
    print("| case | factor | SVK: forces | displacements | steps | neo-Hookean: forces | displacements | steps | |\n|---|---|---|---|---|---|---|---|---|", flush=True)
    for path in arguments.cases or sorted((ROOT / "cases").glob("*/*.toml")):
        cells = best(path.resolve(), arguments.factors, arguments.seconds, arguments.output.resolve(), arguments.program.resolve())
        if cells:
            print("| " + " | ".join(cells) + " |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
