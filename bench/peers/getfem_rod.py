#!/usr/bin/python3
"""GetFEM's demo_dynamic_contact_1D.py (Y. Renard, F. Chouly), unchanged, compared with Ricochet on the rod of cases/rod.

  getfem_rod.py DEMO [--tolerance 1e-8]

DEMO is interface/tests/python/demo_dynamic_contact_1D.py of GetFEM's sources; Debian's package does not have it. Prints a
table; returns 0 if the rows of the same scheme agree. docs/peers.md explains it.
"""

import argparse
import contextlib
import io
import os
import runpy
import sys
import tempfile

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"
os.environ["MPLBACKEND"] = "Agg"

import getfem
import numpy as np

import ours

# GetFEM's SuperLU crashes in Debian 12 (5.4.2+dfsg1-3): the demo's systems of 51 unknowns are solved by LAPACK.
getfem.linsolve_superlu = lambda matrix, right: (np.linalg.solve(matrix.full(), right)[:, None], 1.0)

CASE = ours.ROOT / "cases" / "rod" / "quadrilaterals.toml"  # 50 square cells along, 5 across: uniform across, it is the rod
CELLS, STEP, END, HEIGHT = 50, 0.005, 6.0, 0.1

EXPLICIT = {"time.scheme": "paoli-schatzman", "time.stiffness": "explicit", "mass.type": "lumped"}
ALL = None
# Name, settings of the demo, settings of ours, minimum number of steps that agree (0: different schemes), number of
# steps by which our row of the force is earlier.
ROWS = [
    ("newmark, consistent mass", "version = 0; beta = 0.25",
     {"time.scheme": "newmark", "time.preset": "trapezoidal", "mass.type": "consistent"}, 250, 0),
    ("paoli-schatzman", "version = 1; beta = 0; lump_mass_matrix = 1", EXPLICIT, ALL, 1),
    ("paoli-schatzman, e = 0.5", "version = 1; beta = 0; lump_mass_matrix = 1; e_PS = 0.5", {**EXPLICIT, "time.restitution": 0.5},
     ALL, 1),
    ("paoli-schatzman, e = 1", "version = 1; beta = 0; lump_mass_matrix = 1; e_PS = 1", {**EXPLICIT, "time.restitution": 1.0},
     250, 1),
    ("taylor-flanagan", "version = 4; beta = 0; lump_mass_matrix = 1", {"time.scheme": "taylor-flanagan", "mass.type": "lumped"},
     0, 1),
]
PERTURBED = {"initial.displacement": '["(0.5-0.5*x)*(1+4e-16)", "0"]'}


def theirs(demo, settings):
    sys.argv = [demo, f"NX = {CELLS}; T = {END}; dt = {STEP}; do_final_plot = False; {settings}"]
    with contextlib.redirect_stdout(io.StringIO()):
        values = runpy.run_path(demo)
    return values["store_u0"], -values["store_s0"], values["store_E"]


def mine(directory, settings, steps):
    ours.run(CASE, directory, {**settings, "time.step": repr(STEP), "time.end": repr(STEP * steps)}, fields=False)
    columns = ours.history(directory)
    return columns["tip.displacement_x"], columns["contact_force_x"] / HEIGHT, columns["total_energy"] / HEIGHT


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("demo")
    parser.add_argument("--tolerance", type=float, default=1e-8)
    arguments = parser.parse_args()
    steps, agree = round(END / STEP), True

    def compare(a, b):
        each = [abs(x - y) / abs(x).max() for x, y in zip(a, b)]
        beyond = [np.flatnonzero(e > arguments.tolerance) for e in each]
        return [e.max() for e in each], min((int(x[0]) for x in beyond if len(x)), default=None)

    print("largest difference / largest value                                    ours from ours,   | theirs: stress at the end  | ours\n"
          f"{'scheme':26s} steps displacement       stress    from step  started 4e-16 off |   largest    variation     |   largest    variation")
    with tempfile.TemporaryDirectory() as directory:
        for name, demo, settings, agrees, shift in ROWS:
            a, b = mine(directory + "/run", settings, steps), theirs(arguments.demo, demo)
            other = mine(directory + "/run", {**settings, **PERTURBED}, steps)
            force = a[1][:len(a[1]) - shift], b[1][shift:steps + 1]
            each, first = compare((a[0], force[0]), (b[0][:steps + 1], force[1]))
            _, own = compare(a[:2], other[:2])
            agree = agree and (first is None or (agrees is not ALL and first >= agrees))
            print(f"{name:26s} {steps:5d} " + " ".join(f"{e:12.1e}" for e in each) + f" {first or '-':>12} {own or '-':>18} |"
                  + "|".join(f" {abs(f).max():9.5g} {abs(np.diff(f)).sum():12.6g}     " for f in (force[1], force[0]))
                  + ("   not the same scheme" if agrees == 0 else ""), flush=True)
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
