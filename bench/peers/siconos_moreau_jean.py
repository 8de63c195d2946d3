#!/usr/bin/python3
"""Moreau and Jean's scheme in Siconos and in Ricochet, step by step, on a mass and a stiffness that are assembled here.

  siconos_moreau_jean.py [--only TEXT] [--steps N] [--tolerance 1e-8] [--keep DIRECTORY]

Prints a table (in half an hour: Siconos takes 0.1 s per step); returns 0 if all rows agree. docs/peers.md explains it. RICOCHET=PROGRAM names a program elsewhere.
"""

import argparse
import os
import pathlib
import sys
import tempfile
import time

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
import siconos.kernel as sk
import siconos.numerics as sn

import ours
from body import Body


class Problem:
    """A case of Ricochet with some of its keys changed; all others are as in the file."""

    def __init__(self, case, group, obstacle, point, normal, velocity, gravity, friction, step, steps,
                 damping=(0.0, 0.0)):
        self.case, self.group, self.obstacle = ours.ROOT / "cases" / case, group, obstacle
        self.point, self.normal = np.array(point), np.array(normal)
        self.velocity, self.gravity = velocity, gravity
        self.friction, self.step, self.steps, self.damping = friction, step, steps, damping  # C = damping[0] M + damping[1] K

    def settings(self):
        result = {f"obstacle.{self.obstacle}.point": list(self.point), f"obstacle.{self.obstacle}.normal": list(self.normal),
                  "initial.velocity": self.velocity, "time.step": repr(self.step), "time.end": repr(self.step * self.steps)}
        if self.friction > 0.0:
            result["contact.0.friction"] = self.friction
        for name, factor in zip(("mass", "stiffness"), self.damping):
            if factor > 0.0:
                result[f"material.0.damping.{name}"] = repr(factor)
        return result


# The bar of cases/bar falls 0.01 at the speed 2 and bounces: contact in the steps 3 to 569, flight, contact from 713 on.
BAR = Problem("bar/bounce.toml", "bottom", "floor", [0.0, 4.99], [0.0, 1.0], [0.0, -2.0], [0.0, -10.0], 0.0, 0.002, 1000)
# The disc of cases/oblique, 0.02 mm above a plane inclined by 16 degrees: it slips, sticks, slips back and leaves.
THROWN = ("oblique/oblique.toml", "lower", "foundation", [0.28 * 0.02002, 0.0205 - 0.96 * 0.02002], [-0.28, 0.96],
          [0.1, -0.1], [0.0, 0.0], 0.3, 2e-5, 700)
DISC, DAMPED = Problem(*THROWN), Problem(*THROWN, damping=(10.0, 1e-5))


def siconos(problem, body, theta, restitution, slip, tolerance=1e-14):
    """Returns displacements, velocities and impulses (normal; along the tangent) of the contact nodes after every
    step."""
    free, h = body.free_dofs(), problem.step
    nodes, interactions = body.nodes(problem.group), []
    # Siconos 4.4.0 ends with an assertion if e_T > 0 in two dimensions, but not in three: each contact node then has a
    # third component, with a mass of its own and no load.
    space = slip == "theta" and problem.friction > 0.0
    beside = len(nodes) if space else 0
    mass, stiffness = (matrix[free][:, free].toarray() for matrix in (body.mass, body.stiffness))
    mass, stiffness = np.pad(mass, (0, beside)), np.pad(stiffness, (0, beside))
    for k in range(len(free), len(mass)):
        mass[k, k] = body.mass.diagonal().mean()
    rest = np.zeros(beside)
    system = sk.LagrangianLinearTIDS(np.zeros(len(mass)), np.append(body.field(problem.velocity)[free], rest), mass, stiffness,
                                     problem.damping[0] * mass + problem.damping[1] * stiffness)
    system.setFExtPtr(np.append((body.mass @ body.field(problem.gravity))[free], rest))
    model = sk.NonSmoothDynamicalSystem(0.0, h * (problem.steps + 1))
    model.insertDynamicalSystem(system)
    # Its slip rate is the one at the end plus e_T times the one at the start: with this e_T, 1/theta times the one at
    # theta.
    tangential = (1.0 - theta) / theta if slip == "theta" else 0.0
    tangent = np.array([problem.normal[1], -problem.normal[0]])
    for k, node in enumerate(nodes):
        rows = np.zeros((2, body.dofs))
        rows[:, 2 * node:2 * node + 2] = problem.normal, tangent
        rows = np.pad(rows[:, free], ((0, 1 if space else 0), (0, beside)))
        if space:
            rows[2, len(free) + k] = 1.0
        gap = (body.points[node] - problem.point) @ problem.normal
        if problem.friction > 0.0:
            law = sk.NewtonImpactFrictionNSL(restitution, tangential, problem.friction, len(rows))
            relation = sk.LagrangianLinearTIR(rows, np.append(gap, np.zeros(len(rows) - 1)))
        else:
            law, relation = sk.NewtonImpactNSL(restitution), sk.LagrangianLinearTIR(rows[:1], np.array([gap]))
        interactions.append(sk.Interaction(law, relation))
        model.link(interactions[-1], system)
    if problem.friction > 0.0:
        contact = sk.FrictionContact(3, sn.SICONOS_FRICTION_3D_NSGS) if space else sk.FrictionContact(2, sn.SICONOS_FRICTION_2D_NSGS)
        options = contact.numericsSolverOptions()
        options.dparam[0], options.iparam[0] = tolerance, 100000
    else:
        contact = sk.LCP(sn.SICONOS_LCP_LEMKE)
    simulation = sk.TimeStepping(model, sk.TimeDiscretisation(0.0, h), sk.MoreauJeanOSI(theta), contact)
    place = {dof: k for k, dof in enumerate(free)}
    columns = np.array([[place.get(2 * node + k, -1) for k in range(2)] for node in nodes])
    zero = columns < 0  # supported dofs
    motion, velocity, impulse = [], [], []
    for _ in range(problem.steps):
        simulation.computeOneStep()
        motion.append(np.where(zero, 0.0, np.asarray(system.q())[columns]))
        velocity.append(np.where(zero, 0.0, np.asarray(system.velocity())[columns]))
        impulse.append([np.array(each.lambda_(1))[:2] for each in interactions])
        simulation.nextStep()
    return np.array(motion), np.array(velocity), np.array(impulse)


def ricochet(problem, body, mass, theta, restitution, slip, directory):
    settings = {**problem.settings(), "mass.type": mass, "time.scheme": "moreau-jean", "time.theta": theta,
                "time.restitution": float(restitution), "time.slip": slip}
    ours.run(problem.case, directory, settings)
    steps, h = ours.Steps(directory, body, problem.group), problem.step
    impulse = h * steps.normal_force[1:, :, None]
    if problem.friction > 0.0:
        tangent = np.array([problem.normal[1], -problem.normal[0]])
        impulse = np.concatenate([impulse, h * (steps.friction[1:] @ tangent)[:, :, None]], axis=2)
    return steps.displacement[1:], steps.velocity[1:], impulse


def events(impulse, velocity, friction):
    """Counts touches and releases of nodes, and steps of nodes that slip and that stick."""
    pressed = impulse[:, :, 0] > 0.0
    touches, releases = (~pressed[:-1] & pressed[1:]).sum(), (pressed[:-1] & ~pressed[1:]).sum()
    if friction == 0.0:
        return f"{touches:5d} {releases:5d}     -     -"
    slips = pressed & (abs(impulse[:, :, 1]) > friction * impulse[:, :, 0] * (1 - 1e-9))
    return f"{touches:5d} {releases:5d} {slips.sum():5d} {(pressed & ~slips).sum():5d}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--only", default="", help="only the rows whose name contains this text")
    parser.add_argument("--steps", type=int, help="largest number of steps")
    parser.add_argument("--tolerance", type=float, default=1e-8)
    parser.add_argument("--keep", type=pathlib.Path, help="directory in which runs and arrays are kept")
    arguments = parser.parse_args()
    rows = [(name, problem, mass, theta, restitution, "end") for name, problem in (("bar", BAR), ("disc", DISC))
            for mass in ("consistent", "lumped") for restitution in (0.0, 0.5) for theta in (0.5, 0.75)]
    rows += [("disc", DISC, mass, theta, 0.5, "theta") for mass, theta in (("consistent", 0.5), ("lumped", 0.75))]
    rows += [("disc, damped", DAMPED, "lumped", 0.75, 0.0, "end")]
    for problem in (BAR, DISC, DAMPED):
        problem.steps = min(problem.steps, arguments.steps or problem.steps)
    sn.numerics_set_verbose(0)
    print("                                                                                    largest difference of all steps"
          " / largest value")
    print(f"{'case':48s} steps touch leave  slip stick  displacement     velocity      impulse    from step")
    agree = True
    for name, problem, mass, theta, restitution, slip in rows:
        label = f"{name} {mass} e={restitution} theta={theta} slip={slip}"
        if arguments.only not in label:
            continue
        with tempfile.TemporaryDirectory() as scratch:
            directory = (arguments.keep or pathlib.Path(scratch)) / label.replace(" ", "-")
            body = Body(problem.case, mass)
            mine = ricochet(problem, body, mass, theta, restitution, slip, directory)
            begin = time.time()
            theirs = siconos(problem, body, theta, restitution, slip)
            if arguments.keep:
                np.savez(directory / "both.npz", ours=mine[0], theirs=theirs[0], ours_v=mine[1], theirs_v=theirs[1],
                         ours_p=mine[2], theirs_p=theirs[2])
        differences, first = [], None
        for a, b in zip(mine, theirs):
            each = abs(a - b).reshape(len(a), -1).max(axis=1) / abs(b).max()
            differences.append(each.max())
            beyond = np.flatnonzero(each > arguments.tolerance)
            if len(beyond):
                first = min(first or problem.steps, beyond[0] + 1)
        agree = agree and first is None
        print(f"{label:48s} {problem.steps:5d} {events(theirs[2], theirs[1], problem.friction)} "
              + " ".join(f"{each:12.1e}" for each in differences) + f" {first or '-':>12}   ({time.time() - begin:.0f} s)", flush=True)
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
