#!/usr/bin/python3
"""The same body, mesh, time step and physics in GetFEM (Debian package python3-getfem), as its users run it or as an expert
would script it.

  getfem_steps.py MESH DIMENSION STEP STEPS [--friction F] [--expert]

MESH is a Gmsh 2.2 file of bench/step's disc or ball. P1, consistent mass, textbook Newmark beta = gamma = 1/2 with contact at
the end of the step: what `ricochet` does with [mass] type = "consistent". As its users run it: one model with GetFEM's nodal
contact brick and MUMPS, Model.solve in every step. As an expert would: the matrix is factored once by hand (SciPy's
SuperLU: GetFEM has no factor that can be kept but a "superlu" preconditioner, which crashes in Debian 12), contact is condensed on the contact nodes once and solved in each step by an active set. Prints one JSON object.
"""

import argparse
import json
import os
import pathlib
import sys
import time

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import getfem
import numpy as np
import scipy.sparse
import scipy.sparse.linalg

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from measurement import loaded_kernels

LAMBDA, MU, DENSITY, GRAVITY, VELOCITY, SLIDING, GAP, RADIUS = 1e4, 5e3, 1.0, 9.81, -1.0, 0.5, 0.1, 1.0


class Body:
    def __init__(self, path, dimension, step):
        self.dimension, self.up, self.step = dimension, dimension - 1, step
        mesh = getfem.Mesh("import", "gmsh", path)
        self.space = getfem.MeshFem(mesh, dimension)
        self.space.set_classical_fem(1)
        integration = getfem.MeshIm(mesh, 2)
        data = getfem.MeshFem(mesh, 1)
        data.set_classical_fem(0)
        one = np.ones(data.nbdof())
        self.stiffness = getfem.asm_linear_elasticity(integration, self.space, data, LAMBDA * one, MU * one)
        self.mass = getfem.asm_mass_matrix(integration, self.space)
        self.mass.scale(DENSITY)
        self.dofs = self.space.nbdof()
        gravity = np.zeros(self.dofs)
        gravity[self.up::dimension] = -GRAVITY
        self.gravity, self.load = gravity, self.mass.mult(gravity)
        self.inertia = getfem.Spmat("copy", self.mass)  # 2 M / h^2
        self.inertia.scale(2 / step**2)
        self.operator = getfem.Spmat("add", self.inertia, self.stiffness)
        # The lower half of the surface, as "lower" of the .geo file: nodes on the sphere not above its centre.
        points = self.space.basic_dof_nodes()
        outside = mesh.outer_faces()
        mesh.set_region(1, outside)
        centre = np.zeros(dimension)
        centre[self.up] = GAP + RADIUS
        on_surface = set(self.space.dof_on_region(1))
        self.normal = np.array([dof for dof in range(self.up, self.dofs, dimension)
                                if dof in on_surface and points[self.up, dof] <= centre[self.up] + 1e-9])
        self.gap = points[self.up, self.normal]

    def trace(self, components):
        rows = [dof - self.up + k for dof in self.normal for k in components]
        matrix = getfem.Spmat("empty", len(rows), self.dofs)
        for row, dof in enumerate(rows):
            matrix.add(row, int(dof), 1.0)
        return matrix

    def normal_trace(self):
        matrix = self.trace([self.up])
        matrix.scale(-1.0)  # B_N U <= gap
        return matrix


class Model:
    """As its users run it. The unknown is the increment of displacement, so that friction sees the slip of the step."""

    def __init__(self, body, friction):
        self.body = body
        model = self.model = getfem.Model("real")
        model.add_fem_variable("u", body.space)
        model.add_explicit_matrix("u", "u", body.operator, 1, 1)
        self.right = model.add_explicit_rhs("u", np.zeros(body.dofs))
        model.add_variable("lambda_n", len(body.normal))
        model.add_initialized_data("r", [1e3])
        model.add_initialized_data("gap", body.gap)
        if friction > 0.0:
            tangents = body.trace(range(body.up))
            model.add_variable("lambda_t", len(body.normal) * body.up)
            model.add_initialized_data("friction", [friction])
            model.add_basic_contact_brick("u", "lambda_n", "lambda_t", "r", body.normal_trace(), tangents, "friction", "gap")
        else:
            model.add_basic_contact_brick("u", "lambda_n", "r", body.normal_trace(), "gap")

    def step(self, displacement, predicted):
        body, model = self.body, self.model
        model.set_private_rhs(self.right, body.load + body.inertia.mult(predicted) - body.operator.mult(displacement))
        model.set_variable("u", predicted - displacement)
        model.set_variable("gap", body.gap + displacement[body.normal])
        iterations = int(model.solve("max_res", 1e-8, "max_iter", 100, "lsolver", "mumps")[0])
        return displacement + model.variable("u"), float(-model.variable("lambda_n").sum()), iterations


class Expert:
    """Keeps the factor; computes the Delassus operator W = B A^-1 B^T once; solves it by an active set."""

    def __init__(self, body):
        self.body = body
        starts, rows = body.operator.csc_ind()
        matrix = scipy.sparse.csc_matrix((body.operator.csc_val(), rows, starts), shape=(body.dofs, body.dofs))
        self.factor = scipy.sparse.linalg.splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                                               options={"SymmetricMode": True})
        count = len(body.normal)
        self.columns = np.empty((body.dofs, count))
        for k, dof in enumerate(body.normal):
            unit = np.zeros(body.dofs)
            unit[dof] = 1.0
            self.columns[:, k] = self.factor.solve(unit)
        self.condensed = self.columns[body.normal]
        self.active = np.zeros(count, dtype=bool)

    def step(self, displacement, predicted):
        body = self.body
        free = self.factor.solve(body.load + body.inertia.mult(predicted))
        gap = body.gap + free[body.normal]
        for iteration in range(1, 100):
            reaction = np.zeros(len(gap))
            if self.active.any():
                reaction[self.active] = np.linalg.solve(self.condensed[np.ix_(self.active, self.active)], -gap[self.active])
            motion = gap + self.condensed @ reaction
            active = np.where(self.active, reaction > 0.0, motion < 0.0)
            if (active == self.active).all():
                break
            self.active = active
        if reaction.any():
            free = free + self.columns[:, self.active] @ reaction[self.active]
        return free, float(reaction.sum()), iteration


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("mesh")
    parser.add_argument("dimension", type=int)
    parser.add_argument("step", type=float)
    parser.add_argument("steps", type=int)
    parser.add_argument("--friction", type=float, default=0.0)
    parser.add_argument("--expert", action="store_true")
    arguments = parser.parse_args()
    begin = time.process_time()
    body = Body(arguments.mesh, arguments.dimension, arguments.step)
    solver = Expert(body) if arguments.expert else Model(body, arguments.friction)
    set_up = time.process_time() - begin
    h, up, dimension = arguments.step, body.up, arguments.dimension
    displacement, velocity, acceleration = np.zeros(body.dofs), np.zeros(body.dofs), body.gravity.copy()
    velocity[up::dimension] = VELOCITY
    if arguments.friction > 0.0:
        velocity[0::dimension] = SLIDING
    seconds, forces, iterations = [], [], []
    for _ in range(arguments.steps):
        begin = time.process_time()
        predicted = displacement + h * velocity
        after, force, count = solver.step(displacement, predicted)
        now = 2 * (after - predicted) / h**2
        velocity = velocity + h / 2 * (acceleration + now)
        displacement, acceleration = after, now
        seconds.append(time.process_time() - begin)
        forces.append(force)
        iterations.append(count)
    json.dump({"dofs": body.dofs, "contact_points": len(body.normal), "set_up_s": set_up, "step_ms": [1e3 * s for s in seconds],
               "force": forces, "iterations": iterations,
               "end": [float(displacement[k::dimension].mean()) for k in range(dimension)], "kernels": loaded_kernels()}, sys.stdout)


if __name__ == "__main__":
    main()
