#!/usr/bin/python3
"""A small elastic disc strikes a larger one at rest: GetFEM's contact of two bodies as its users run it, and Ricochet.

  getfem_two_bodies.py [--only TEXT] [--runs 3] [--steps 75] [--figure FILE]

Both have the same meshes (linear triangles that do not match where they touch), material, mass, step and scheme (textbook Newmark
with beta = gamma = 1/2). GetFEM has its own bricks for mass, elasticity, contact and time, and Model.solve with Newton's method
and MUMPS in every step. Prints a table; returns 0 if the forces agree as far as they should. docs/peers.md explains it.
RICOCHET=PROGRAM names a program elsewhere.
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import getfem
import numpy as np

import ours

YOUNG, POISSON, DENSITY, SPEED = 2e3, 0.3, 1e-9, 5e3  # mm, N, s, t: a plastic, at 5 m/s
LAMBDA, MU = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), YOUNG / (2 * (1 + POISSON))
STEP = 2e-6
RADII, CELLS = (20.0, 30.0), (0.1, 0.17)  # of each disc; the size of its cells near the contact
CONTACT = 2  # region of GetFEM's meshes that is the curve "contact"
FORCE, IMPULSE = 0.02, 0.002  # required agreement, relative to the largest force and the whole impulse

GEOMETRY = """// A disc of radius R that touches y = 0 at the origin from above (S = 1) or from below (S = -1), with cells of H there.
SetFactory("OpenCASCADE");
Point(1) = {0, S * R, 0};
Point(2) = {0, 0, 0};
Point(3) = {-S * R * Sin(0.25), S * R * (1 - Cos(0.25)), 0};
Point(4) = {S * R * Sin(0.25), S * R * (1 - Cos(0.25)), 0};
Point(5) = {0, 2 * S * R, 0};
Circle(1) = {3, 1, 2};
Circle(2) = {2, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 3};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("Min(%g, %g + 0.05 * Sqrt(y * y + Max(0, Abs(x) - 2)^2))", R / 30, H);
Background Field = 1;
Physical Surface("body") = {1};
Physical Curve("contact") = {1, 2};
"""

CASE = f"""[mesh]
degree = 1
[part.small]
file = "disc-0.msh"
velocity = [0.0, {-SPEED}]
[part.large]
file = "disc-1.msh"
[[material]]
group = "all"
density = {DENSITY}
young = {YOUNG}
poisson = {POISSON}
[[contact]]
group = "small.contact"
against = "large.contact"
multipliers_on = "group"
[mass]
type = "consistent"
[time]
scheme = "newmark"
preset = "textbook-half"
step = {STEP}
end = 1.0
[[probe]]
name = "contact"
contact = 0
"""


def write_case(directory, size=1.0):
    """Writes the case and its meshes, whose cells are scaled by `size`; for GetFEM also in Gmsh's older format."""
    for k, (radius, cell) in enumerate(zip(RADII, CELLS)):
        path = directory / f"disc-{k}.geo"
        # The cells far from the contact are R/30 at size 1.
        path.write_text(GEOMETRY.replace("R / 30, H", f"R / 30 * {size}, H * {size}"))
        for form, suffix in (("msh41", ".msh"), ("msh22", ".msh22")):
            subprocess.run(["gmsh", path, "-2", "-format", form, "-o", path.with_suffix(suffix), "-v", "1", "-setnumber", "R", str(radius),
                            "-setnumber", "S", str(1 - 2 * k), "-setnumber", "H", str(cell)], check=True)
    (directory / "pair.toml").write_text(CASE)


def processor_seconds(case, steps, settings):
    return ours.processor_seconds(ours.run, case, case.parent / "run", {**settings, "time.end": repr(STEP * steps)}, fields=False)


def times(case, steps, settings):
    """Returns the processor time of a run of one step, and of a step: the difference of that run and a longer one."""
    set_up = processor_seconds(case, 1, settings)
    return set_up, (processor_seconds(case, steps + 1, settings) - set_up) / steps


def ricochet(case, steps, settings=None):
    """Returns the force after every step."""
    processor_seconds(case, steps + 1, settings or {})
    return ours.history(case.parent / "run")["contact.force_y"][1:steps + 1]


def nodal(model, integration, space):
    """Nodes of the small disc against the large one's boundary; matrices of the gaps are assembled once."""
    model.add_initialized_data("r", [YOUNG])
    model.add_nodal_contact_between_nonmatching_meshes_brick(*integration, "u0", "u1", "lambda", "r", CONTACT, CONTACT)


def integral(model, integration, space):
    """Mean gap, by projection of the undeformed boundaries on each other, only for points closer than 0.05 of a
    cell."""
    space(1)
    model.add_initialized_data("r", [YOUNG / CELLS[0]])
    model.add_integral_contact_between_nonmatching_meshes_brick(integration[0], "u0", "u1", "lambda", "r", CONTACT, CONTACT)


def raytracing(model, integration, space):
    """Large sliding: rays along the deformed normals."""
    space(2)
    model.add_initialized_data("r", [YOUNG / CELLS[0]])
    model.add_initialized_data("friction", [0.0])
    brick = model.add_integral_large_sliding_contact_brick_raytracing("r", 1.0, "friction")
    model.add_slave_contact_boundary_to_large_sliding_contact_brick(brick, integration[0], CONTACT, "u0", "lambda")
    model.add_master_contact_boundary_to_large_sliding_contact_brick(brick, integration[1], CONTACT, "u1")


BRICKS = {"nodal": (nodal, True), "large sliding, raytracing": (raytracing, True), "integral": (integral, False)}  # agrees?


def getfem_run(directory, brick, steps):
    """Returns the processor time before the first step and of a step, the force after every step, and the Newton
    iterations."""
    begin = time.process_time()
    model = getfem.Model("real")
    for name, value in (("lame", LAMBDA), ("mu", MU), ("rho", DENSITY)):
        model.add_initialized_data(name, [value])
    meshes = [getfem.Mesh("import", "gmsh", str(directory / f"disc-{k}.msh22")) for k in (0, 1)]
    spaces, integration = [], []
    for k, mesh in enumerate(meshes):
        spaces.append(getfem.MeshFem(mesh, 2))
        spaces[k].set_classical_fem(1)
        integration.append(getfem.MeshIm(mesh, 2))
        model.add_fem_variable(f"u{k}", spaces[k])
        model.add_Newmark_scheme(f"u{k}", 0.5, 0.5)
        model.add_isotropic_linearized_elasticity_brick(integration[k], f"u{k}", "lame", "mu")
        model.add_mass_brick(integration[k], f"Dot2_u{k}", "rho")

    def multipliers(components):
        space = getfem.MeshFem(meshes[0], components)
        space.set_classical_fem(1)
        model.add_filtered_fem_variable("lambda", space, CONTACT)

    BRICKS[brick][0](model, integration, multipliers)
    velocity = np.zeros(spaces[0].nbdof())
    velocity[1::2] = -SPEED
    model.set_variable("Previous_Dot_u0", velocity)  # no forces act at the start: accelerations are zero
    model.set_time_step(STEP)
    mass = getfem.asm_mass_matrix(integration[0], spaces[0])
    upwards = DENSITY * mass.mult(np.tile([0.0, 1.0], spaces[0].nbdof() // 2))
    set_up, seconds, force, iterations = time.process_time() - begin, 0.0, [], 0
    for _ in range(steps):
        begin = time.process_time()
        iterations += int(model.solve("max_res", 1e-8, "max_iter", 60, "lsolver", "mumps")[0])
        model.shift_variables_for_time_integration()
        seconds += time.process_time() - begin
        force.append(upwards @ model.variable("Previous_Dot2_u0"))  # the inertia of the small disc is the force on it
    return set_up, seconds / steps, np.array(force), iterations / steps


def medians(runs):
    return statistics.median(run[0] for run in runs), 1e3 * statistics.median(run[1] for run in runs)


def draw(path, forces, peak):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(7, 5.4), height_ratios=(3, 2))
    reference = forces["Ricochet"]
    for (name, force), style in zip(forces.items(), ("k-", "C0--", "C1-.", "C3:", "C2-", "0.6")):
        times = 1e6 * STEP * np.arange(1, len(force) + 1)
        above.plot(times, force, style, label=name, linewidth=1.3)
        if name != "Ricochet":
            below.plot(times, 100 * (force - reference) / peak, style, linewidth=1)
    above.set_ylabel("contact force, N/mm")
    above.legend(fontsize=8, frameon=False)
    below.set_ylabel("difference from Ricochet,\n% of the largest")
    below.set_xlabel("time, µs")
    for axes in (above, below):
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--only", default="", help="only the bricks whose name contains this text")
    parser.add_argument("--runs", type=int, default=3, help="number of runs; times are their medians")
    parser.add_argument("--steps", type=int, default=75)
    parser.add_argument("--figure", help="draw the forces into this file")
    arguments = parser.parse_args()
    getfem.util_trace_level(0)
    steps, agree = arguments.steps, True
    with tempfile.TemporaryDirectory() as scratch:
        (directory := pathlib.Path(scratch) / "same").mkdir()
        (fine := pathlib.Path(scratch) / "fine").mkdir()
        write_case(directory)
        write_case(fine, 0.5)
        case, coarse = directory / "pair.toml", {"output.history_every": 1000000}
        force = ricochet(case, steps)
        peak, impulse = force.max(), force.sum()
        forces = {"Ricochet": force}
        # A run takes a second: five times as many, as their differences are small.
        set_up, step_with_row = medians([times(case, steps, {}) for _ in range(5 * arguments.runs)])
        step = medians([times(case, steps, coarse) for _ in range(5 * arguments.runs)])[1]
        print(f"Ricochet: largest force {peak:.5g} N/mm, impulse {STEP * impulse:.5g} Ns/mm; set-up {set_up:.2f} s, a step {step:.2f} ms, "
              f"with its row of the history {step_with_row:.2f} ms\n\n"
              f"{'GetFEM':26s} iterations   set-up, s    step, ms  ratio  with rows  largest difference   of the impulse", flush=True)

        def compare(name, other):
            difference = abs(other - force).max() / peak, (other.sum() - impulse) / impulse
            forces[name] = other
            return f"{100 * difference[0]:18.2f} % {100 * difference[1]:14.3f} %", difference

        for brick, (_, agrees) in BRICKS.items():
            if arguments.only not in brick:
                continue
            runs = [getfem_run(directory, brick, steps) for _ in range(arguments.runs)]
            their_set_up, their_step = medians(runs)
            text, difference = compare(f"GetFEM, {brick}", runs[0][2])
            agree = agree and (not agrees or difference[0] < FORCE and abs(difference[1]) < IMPULSE)
            print(f"{brick:26s} {runs[0][3]:10.2f} {their_set_up:11.2f} {their_step:11.1f} {their_step / step:6.0f} {their_step / step_with_row:10.0f} {text}"
                  + ("" if agrees else "   not the same contact"), flush=True)
        print(f"\n{steps} steps of {STEP} s; medians of {arguments.runs} runs, processor time, one thread. Ricochet itself:")
        default = {"time.scheme": "reduced-kane", "mass.type": "equivalent"}
        print(f"{'cells of half the size':64s} " + compare("Ricochet, cells of half the size", ricochet(fine / "pair.toml", steps))[0])
        print(f"{'its default scheme and mass':64s} " + compare("Ricochet, default scheme", ricochet(case, steps, default))[0])
        if arguments.figure:
            draw(arguments.figure, forces, peak)
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
