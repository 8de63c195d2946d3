#!/usr/bin/python3
"""The two balls of cases/balls with CalculiX: the same mesh of ten-node tetrahedra, material, supports and velocities.

  calculix_balls.py [--only TEXT] [--figure FILE] [--keep DIRECTORY]

CalculiX (ccx) has *DYNAMIC, the implicit alpha method of Hilber, Hughes and Taylor, and contact of surface to surface by penalty.
Prints a table beside Ricochet's runs and Hertz' closed form; returns 0 when the rows that should agree do. docs/peers.md explains it.
CCX=PROGRAM and RICOCHET=PROGRAM name programs elsewhere.
"""

import argparse
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import meshio
import numpy as np

import ours

sys.path.insert(0, str(ours.ROOT / "benchmarks"))
from hertz import PointImpact

CASE = ours.ROOT / "cases" / "balls" / "balls.toml"
RADIUS, YOUNG, POISSON, DENSITY, SPEED = 10.0, 2.1e5, 0.3, 7.8e-9, 1000.0  # mm, N, s, t
END, LOW = 6.5e-5, 2.0  # s; N: contact ends for the table when the force falls below it, 0.2 % of the largest
FACES = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))  # S1 to S4 of CalculiX' tetrahedra
FORCE, DURATION, LOSS = 0.02, 0.02, 0.005  # required agreement with Hertz, and the tolerated change of energy


class Ball:
    """Nodes, tetrahedra, faces of the contact boundary, nodes on both planes of symmetry."""

    def __init__(self):
        mesh = meshio.read(CASE.parent / "ball.msh")
        self.points = RADIUS * mesh.points
        self.cells = np.vstack([block.data for block in mesh.cells if block.type == "tetra10"])  # in VTK's order, as CalculiX'
        groups = {name: np.vstack([block.data for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"])
                                   if block.type == "triangle6" and tags[0] == tag])
                  for name, (tag, dimension) in mesh.field_data.items() if dimension == 2}
        self.plane_x, self.plane_y = np.unique(groups["plane-x"]), np.unique(groups["plane-y"])
        lower = {frozenset(face[:3]) for face in groups["lower"]}
        self.lower = [(cell, side) for cell, nodes in enumerate(self.cells) for side, face in enumerate(FACES, start=1)
                      if frozenset(nodes[list(face)]) in lower]
        for node, (a, b) in enumerate(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)), start=4):
            ends = self.points[self.cells[:, [a, b]]]
            off = np.linalg.norm(self.points[self.cells[:, node]] - ends.mean(axis=1), axis=1)
            if (off > 0.2 * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)).any():
                sys.exit("ball.msh: nodes of its tetrahedra are not in the order that this script expects")


def deck(ball, penalty, dynamic, contact="SURFACE TO SURFACE"):
    """Returns the input file; `penalty` in MPa/mm. The lower ball is the upper one rotated by 180 degrees about (1, 1,
    0): x and y are exchanged, z changes its sign."""
    count, cells = len(ball.points), len(ball.cells)
    upper, lower = ball.points, np.stack([ball.points[:, 1], ball.points[:, 0], -ball.points[:, 2]], axis=1)
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{i + 1},{x[0]:.12e},{x[1]:.12e},{x[2]:.12e}" for i, x in enumerate(np.vstack([upper, lower]))]
    for k, name in enumerate(("UPPER", "LOWER")):
        lines += [f"*ELEMENT, TYPE=C3D10, ELSET={name}"]
        lines += [f"{k * cells + i + 1}," + ",".join(str(k * count + node + 1) for node in nodes) for i, nodes in enumerate(ball.cells)]
        lines += [f"*SURFACE, NAME=S{name}, TYPE=ELEMENT"] + [f"{k * cells + cell + 1},S{side}" for cell, side in ball.lower]
    for name, nodes in (("NUPPER", np.arange(count)), ("X0", np.append(ball.plane_x, count + ball.plane_y)),
                        ("Y0", np.append(ball.plane_y, count + ball.plane_x))):
        lines += [f"*NSET, NSET={name}"] + [f"{node + 1}," for node in nodes]
    lines += f"""*ELSET, ELSET=EALL
UPPER, LOWER
*MATERIAL, NAME=STEEL
*ELASTIC
{YOUNG}, {POISSON}
*DENSITY
{DENSITY}
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=HARD
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{penalty:g}
*CONTACT PAIR, INTERACTION=HARD, TYPE={contact}
SUPPER, SLOWER
*BOUNDARY
X0, 1, 1
Y0, 2, 2
*INITIAL CONDITIONS, TYPE=VELOCITY
NUPPER, 3, {-SPEED}
*STEP, INC=100000
{dynamic}
*EL PRINT, ELSET=EALL, TOTALS=ONLY, FREQUENCY=1
ELSE, ELKE
*CONTACT PRINT, SLAVE=SUPPER, MASTER=SLOWER, TOTALS=ONLY, FREQUENCY=1
CF
*CONTACT PRINT, TOTALS=ONLY, FREQUENCY=1
CELS
*END STEP
""".split("\n")
    return "\n".join(lines)


class Run:
    """Force and energies (elastic, kinetic and of the penalty) of whole balls at every step; N, s, mJ. `start`: the
    initial energy."""

    def __init__(self, seconds, iterations, rows, start):
        self.seconds, self.iterations, self.steps, self.start = seconds, iterations, len(rows), start
        self.time, self.force, elastic, kinetic, self.penalty = np.vstack([[0.0, 0.0, 0.0, start, 0.0], rows]).T
        self.energy = elastic + kinetic + self.penalty
        last = np.flatnonzero(self.force > LOW)[-1]
        self.peak, self.end = self.force.max(), np.interp(-LOW, -self.force[last:last + 2], self.time[last:last + 2])
        self.impulse = np.trapz(self.force, self.time) / (2 * start / SPEED)  # relative to the initial momentum


def calculix(ball, directory, penalty, dynamic, start):
    """Returns a run, or the one that --keep left in the directory."""
    directory.mkdir(parents=True, exist_ok=True)
    if not (directory / "seconds").exists():
        (directory / "balls.inp").write_text(deck(ball, penalty, dynamic))
        with open(directory / "balls.log", "w") as log:
            seconds = ours.processor_seconds(lambda: subprocess.run(
                [os.environ.get("CCX", "ccx"), "balls"], cwd=directory, stdout=log, stderr=log, check=True,
                env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}))
        (directory / "seconds").write_text(f"{seconds}")
    printed, number = (directory / "balls.dat").read_text(), r"([-+.\dE]+)"
    forces = re.findall(rf"and time\s+{number}\s+total surface force.*\s+\S+\s+\S+\s+{number}", printed)
    energies = [re.findall(rf"{text} and time\s+{number}\s+{number}", printed)
                for text in ("total internal energy for set EALL", "total kinetic energy for set EALL")]
    springs = re.findall(rf"total contact spring energy for time\s+{number}\s+{number}", printed)
    force, spring = dict(forces), dict(springs)  # at each instant; neither is printed while the balls are apart
    rows = [[float(instant)] + [4 * float(each) for each in (force.get(instant, 0), elastic, kinetic, spring.get(instant, 0))]
            for (instant, elastic), (_, kinetic) in zip(*energies)]
    iterations = [line for line in (directory / "balls.cvg").read_text().split("\n") if re.match(r"\s+\d", line)]
    return Run(float((directory / "seconds").read_text()), len(iterations), rows, start)


def ricochet(directory, step):
    settings = {"time.step": repr(step), "time.end": repr(END)}
    seconds = ours.processor_seconds(ours.run, CASE, directory / "run", settings, fields=False)
    columns = ours.history(directory / "run")
    values = np.column_stack([columns[name] for name in ("time", "contact.force_z", "elastic_energy", "kinetic_energy")]) * [1, 4, 4e3, 4e3] @ np.eye(4, 5)
    return Run(seconds, 0, values[1:], values[0, 3])


def hertz():
    """Returns the largest force, the duration, and the instant at which the force falls below LOW."""
    impact = PointImpact.of_bodies([(YOUNG, POISSON)] * 2, [RADIUS] * 2, [4 * math.pi / 3 * RADIUS**3 * DENSITY] * 2, SPEED)
    return impact.force, impact.duration, impact.duration - (LOW / impact.stiffness) ** (2 / 3) / SPEED


AUTOMATIC = f"*DYNAMIC\n1e-6, {END}"


def fixed(step, alpha=""):
    return f"*DYNAMIC, DIRECT{alpha}\n{step}, {END}"


ROWS = {  # name: penalty in MPa/mm, procedure
    "penalty 1e7, step 1 µs": (1e7, fixed(1e-6)),
    "penalty 1e7, step 1 µs, alpha = 0": (1e7, fixed(1e-6, ", ALPHA=0.")),
    "penalty 1e7, automatic step": (1e7, AUTOMATIC),
}


def draw(path, runs, closed_form):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(7, 5.4), height_ratios=(3, 2))
    for (name, run), style in zip(runs.items(), ("k-", "C7--", "C0:", "C1-", "C2-.", "C3--", "C4-", "C5-")):
        above.plot(1e6 * run.time, run.force, style, label=name, linewidth=1.2)
        below.plot(1e6 * run.time, 100 * (run.energy / run.start - 1), style, linewidth=1.2)
    above.plot(1e6 * closed_form[1] / 2, closed_form[0], "k+", markersize=11, label="Hertz: largest force and duration")
    above.plot(1e6 * closed_form[1], 0, "k+", markersize=11)
    above.set_ylabel("contact force, N")
    above.legend(fontsize=7, frameon=False)
    below.set_ylabel("energy, change in %")
    below.set_xlabel("time, µs")
    for axes in (above, below):
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--only", default="", help="only the rows of CalculiX whose name contains this text")
    parser.add_argument("--figure", help="draw forces and energies into this file")
    parser.add_argument("--keep", help="directory in which CalculiX's files are kept, and those of earlier runs are reused")
    arguments = parser.parse_args()
    (force, duration, end), ball, runs, agree = hertz(), Ball(), {}, True
    print(f"Hertz: largest force {force:.2f} N, duration {1e6 * duration:.3f} µs, less than {LOW:g} N from {1e6 * end:.3f} µs on\n\n"
          f"{'':40s} force, N            less from, µs       impulse / energy, %      of the      steps  iterations  processor, s\n"
          f"{'':80s} momentum   at the end  penalty", flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        def report(name, run):
            runs[name] = run
            errors = run.peak / force - 1, run.end / end - 1
            print(f"{name:40s} {run.peak:8.2f} {100 * errors[0]:+6.2f} %   {1e6 * run.end:7.2f} {100 * errors[1]:+6.2f} %   "
                  f"{run.impulse:9.5f} {100 * (run.energy[-1] / run.start - 1):+10.4f} {100 * run.penalty.max() / run.start:8.3f} "
                  f"{run.steps:9d} {run.iterations or '-':>9} {run.seconds:12.1f}", flush=True)
            return errors

        for step in (1e-6, 5e-7, 2.5e-7):
            report(f"Ricochet, step {1e6 * step:g} µs", ricochet(pathlib.Path(scratch), step))
        start = next(iter(runs.values())).start
        for name, (penalty, dynamic) in ROWS.items():
            if arguments.only not in name:
                continue
            directory = pathlib.Path(arguments.keep or scratch) / re.sub(r"\W+", "-", name)
            errors = report(f"CalculiX, {name}", calculix(ball, directory, penalty, dynamic, start))
            lost = abs(runs[f"CalculiX, {name}"].energy[-1] / start - 1)
            # Automatic steps grow to a tenth of the contact, and create energy.
            agree = agree and (dynamic == AUTOMATIC or abs(errors[0]) < FORCE and abs(errors[1]) < DURATION and lost < LOSS)
    if arguments.figure:
        draw(arguments.figure, runs, (force, duration))
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
