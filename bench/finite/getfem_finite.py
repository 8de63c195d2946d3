#!/usr/bin/python3
"""Bodies of neo-Hookean material on a rigid plane, in GetFEM (Debian package python3-getfem).

  getfem_finite.py static MESH DIMENSION --press P [--friction F] --arrays FILE
  getfem_finite.py SCHEME MESH DIMENSION --speed V [--friction F] --steps N --step H --arrays FILE

MESH is a Gmsh 2.2 file with the groups body, lower and top; SCHEME is newmark (beta = gamma = 1/2), trapezoidal or midpoint. Linear triangles or
tetrahedra, consistent mass. The energy is written in GetFEM's language for weak forms (its own bricks have laws with another part for
the volume): GetFEM differentiates it twice by itself. Contact is GetFEM's brick of nodes with Alart and Curnier's augmented Lagrangian; Newton's method is
Model.solve, with MUMPS. Prints one JSON object; FILE (npz) has displacements and forces.
"""

import argparse
import json
import os
import sys
import time

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import getfem
import numpy as np

from measurement import loaded_kernels
from problems import DENSITY, LAMBDA, MU, gap

LOWER, TOP = 2, 3  # groups of the meshes, as numbered by Gmsh
RESIDUAL, MOST_ITERATIONS = 1e-8, 30  # of forces of 10 to 10^4
# When contact begins, GetFEM's default line search takes 74 iterations for a solution that full steps find in 4.
FULL_STEPS = ("lsearch", "simplest", "alpha max ratio", 1e6, "alpha min", 0.5)


class NotConverged(Exception):
    pass


class Body:
    """A model whose unknown u is the displacement at which forces are evaluated, with contact conditions at it."""

    def __init__(self, path, dimension, friction, lift):
        self.dimension, self.up, self.friction = dimension, dimension - 1, friction
        self.mesh = getfem.Mesh("import", "gmsh", path)
        self.space = getfem.MeshFem(self.mesh, dimension)
        self.space.set_classical_fem(1)
        self.dofs = self.space.nbdof()
        self.once = getfem.MeshIm(self.mesh, 1)   # one point per cell: the gradient is constant
        self.twice = getfem.MeshIm(self.mesh, 2)  # exact for the mass
        self.points = self.space.basic_dof_nodes()[:, ::dimension]
        model = self.model = getfem.Model("real")
        model.add_fem_variable("u", self.space)
        model.add_initialized_data("la", [LAMBDA])
        model.add_initialized_data("mu", [MU])
        # With friction, u is measured from the displacement `before`, so that the contact brick sees the slip from
        # there on.
        if friction > 0.0:
            model.add_fem_data("before", self.space)
        model.add_macro("F", "(Id(meshdim)+Grad_u)" if friction == 0.0 else "(Id(meshdim)+Grad_before+Grad_u)")
        # In plane strain tr C contains an additional constant 1.
        model.add_nonlinear_term(self.once, "mu/2*(Norm_sqr(F)-2*log(Det(F)))+la/4*(sqr(Det(F))-2*log(Det(F)))")
        self.add_contact(lift)

    def add_contact(self, lift):
        model, d = self.model, self.dimension
        self.normal = np.array([dof for dof in self.space.basic_dof_on_region(LOWER) if dof % d == self.up])
        count = len(self.normal)
        normal = self.rows([self.up], -1.0)  # B_N u <= gap
        model.add_variable("lambda_n", count)
        model.add_initialized_data("r", [1e3])
        self.gap = self.points[self.up, self.normal // d] + lift
        model.add_initialized_data("gap", self.gap)
        if self.friction > 0.0:
            model.add_variable("lambda_t", count * self.up)
            model.add_initialized_data("friction", [self.friction])
            model.add_basic_contact_brick("u", "lambda_n", "lambda_t", "r", normal, self.rows(range(self.up), 1.0), "friction", "gap")
        else:
            model.add_basic_contact_brick("u", "lambda_n", "r", normal, "gap")

    def rows(self, components, factor):
        matrix = getfem.Spmat("empty", len(self.normal) * len(components), self.dofs)
        for row, dof in enumerate(dof - self.up + k for dof in self.normal for k in components):
            matrix.add(row, int(dof), factor)
        return matrix

    def solve(self):
        """Performs Newton iterations."""
        iterations, converged = self.model.solve("max_res", RESIDUAL, "max_iter", MOST_ITERATIONS, "lsolver", "mumps", *FULL_STEPS)
        if not converged:
            raise NotConverged
        return int(iterations)

    def forces(self):
        """Returns the normal forces on the contact nodes and, with friction, the tangential ones."""
        forces = -self.model.variable("lambda_n")[:, None]
        if self.friction > 0.0:
            forces = np.hstack([forces, self.model.variable("lambda_t").reshape(-1, self.up)])
        return forces


def static(arguments):
    """Displaces the top as a whole, with slips measured from the start. If Newton's method fails, it starts from the
    solutions of halves, quarters, … of the displacement, which only provide initial values."""
    body = Body(arguments.mesh, arguments.dimension, arguments.friction, 0.0)
    model, d, up = body.model, body.dimension, body.up
    value = np.zeros(d)
    model.add_initialized_data("pressed", value)
    model.add_Dirichlet_condition_with_simplification("u", TOP, "pressed")
    squeezed = np.zeros(body.dofs)  # uniformly, as moving only the top would turn cells inside out
    squeezed[up::d] = -arguments.press * body.points[up] / body.points[up].max()
    begin, iterations, parts = time.process_time(), [], 1
    while True:
        try:
            for part in range(1, parts + 1):
                value[up] = -arguments.press * part / parts
                model.set_variable("pressed", value)
                model.set_variable("u", squeezed / parts if part == 1 else model.variable("u") * part / (part - 1))
                iterations.append(body.solve())
            break
        except NotConverged:
            parts *= 2
            if parts > 64:
                raise
            for name in ("lambda_n", "lambda_t")[:1 + (arguments.friction > 0.0)]:
                model.set_variable(name, np.zeros(len(model.variable(name))))
    return body, {"iterations": iterations, "parts": parts, "seconds": [time.process_time() - begin]}, [model.variable("u")], [body.forces()]


def dynamic(arguments):
    h = arguments.step
    beta = {"newmark": 0.5, "trapezoidal": 0.25, "midpoint": None}[arguments.action]
    body = Body(arguments.mesh, arguments.dimension, arguments.friction, gap(arguments.speed) - 0.1)
    model, d, up = body.model, body.dimension, body.up
    mass = getfem.asm_mass_matrix(body.twice, body.space)
    mass.scale(DENSITY * (4.0 / h**2 if beta is None else 1.0 / (beta * h**2)))
    factor = 4.0 / h**2 if beta is None else 1.0 / (beta * h**2)
    model.add_explicit_matrix("u", "u", mass, 1, 1)
    right = model.add_explicit_rhs("u", np.zeros(body.dofs))
    # u is measured from the initial position of the falling body.
    displacement, velocity, acceleration = (np.zeros(body.dofs) for _ in range(3))
    velocity[up::d] = -arguments.speed
    if arguments.friction > 0.0:
        velocity[0::d] = 0.5 * arguments.speed
    record = {"iterations": [], "seconds": []}
    displacements, forces = [], []
    for _ in range(arguments.steps):
        begin = time.process_time()
        base = displacement + (0.5 * h * velocity if beta is None else h * velocity + h**2 * (0.5 - beta) * acceleration)
        before = displacement if arguments.friction > 0.0 else 0.0
        model.set_private_rhs(right, mass.mult(base - before))
        model.set_variable("u", base - before)
        if arguments.friction > 0.0:
            model.set_variable("before", displacement)
            model.set_variable("gap", body.gap + displacement[body.normal])
        try:
            record["iterations"].append(body.solve())
        except NotConverged:
            record["stopped"] = len(displacements) + 1
            break
        u = before + model.variable("u")
        if beta is None:
            displacement, velocity = 2.0 * u - displacement, velocity + 4.0 / h * (u - base)
        else:
            now = factor * (u - base)
            displacement, velocity, acceleration = u, velocity + 0.5 * h * (acceleration + now), now
        record["seconds"].append(time.process_time() - begin)
        displacements.append(displacement)
        forces.append(body.forces())
    return body, record, displacements, forces


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("action", choices=("static", "newmark", "trapezoidal", "midpoint"))
    parser.add_argument("mesh")
    parser.add_argument("dimension", type=int)
    parser.add_argument("--press", type=float)
    parser.add_argument("--speed", type=float)
    parser.add_argument("--friction", type=float, default=0.0)
    parser.add_argument("--steps", type=int)
    parser.add_argument("--step", type=float)
    parser.add_argument("--arrays", required=True)
    arguments = parser.parse_args()
    getfem.util_trace_level(0)
    body, record, displacements, forces = (static if arguments.action == "static" else dynamic)(arguments)
    nodes = body.points.shape[1]
    one = getfem.MeshFem(body.mesh, 1)
    one.set_classical_fem(1)
    weights = getfem.asm_boundary_source(LOWER, body.twice, one, one, np.ones((1, one.nbdof())))  # force over pressure
    np.savez(arguments.arrays, points=body.points.T, weights=weights[body.normal // body.dimension], displacement=np.array(displacements).reshape(-1, nodes, body.dimension),
             contact_points=body.points.T[body.normal // body.dimension], force=np.array(forces))
    json.dump(record | {"dofs": body.dofs, "contact_points": len(body.normal), "kernels": loaded_kernels()}, sys.stdout)


if __name__ == "__main__":
    main()
