#!/usr/bin/python3
"""Steps of elastodynamics without contact in dolfinx (Debian package python3-dolfinx-real), on several processes.

  mpirun -n N dolfinx_steps.py MESH --step H --steps N --solver gamg|jacobi --tolerance T

MESH is a Gmsh file of tetrahedra. Linear functions, consistent mass, Newmark's rule with beta 1/4 and gamma 1/2, the
matrix assembled once, PETSc's conjugate gradients starting from the increment of the last step. `gamg` is given the
rigid motions; `jacobi` consists of the diagonal blocks (PBJACOBI on BAIJ), Ricochet's default. The first process prints
one JSON object.
"""

import argparse
import json
import os
import resource
import time

os.environ["OMP_NUM_THREADS"] = "1"

import gmsh
import numpy as np
import ufl
from dolfinx import fem, la
from dolfinx.io import gmshio
from mpi4py import MPI
from petsc4py import PETSc

DENSITY, LAMBDA, MU = 1.0, 1e4, 5e3
GRAVITY = (0.0, 0.0, -9.81)


def start_velocity(x):
    """Smooth velocity with all wave lengths of the body."""
    return np.vstack([np.sin(9 * x[0]), 0 * x[0], np.cos(7 * x[1])])


def rigid_motions(space):
    """Rigid motions as a null space for multigrid."""
    index_map, size = space.dofmap.index_map, space.dofmap.index_map_bs
    vectors = [la.create_petsc_vector(index_map, size) for _ in range(6)]
    x = space.tabulate_dof_coordinates()[:index_map.size_local]
    for k, vector in enumerate(vectors):
        values = np.zeros_like(x)
        if k < 3:
            values[:, k] = 1.0
        else:
            values[:] = np.cross(np.eye(3)[k - 3], x)
        vector.array[:] = values.ravel()
    dense = []
    for vector in vectors:
        for other in dense:
            vector.axpy(-vector.dot(other), other)
        vector.normalize()
        dense.append(vector)
    return PETSc.NullSpace().create(vectors=dense)


def linear_solver(matrix, space, kind, tolerance):
    solver = PETSc.KSP().create(matrix.comm)
    solver.setType("cg")
    solver.setInitialGuessNonzero(True)
    solver.setTolerances(rtol=tolerance)
    solver.setNormType(PETSc.KSP.NormType.NATURAL)
    if kind == "gamg":
        matrix.setNearNullSpace(rigid_motions(space))
        solver.getPC().setType("gamg")
    else:
        matrix = matrix.convert("baij")
        solver.getPC().setType("pbjacobi")
    solver.setOperators(matrix)
    solver.setUp()
    return solver, matrix


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("mesh")
    parser.add_argument("--step", type=float, required=True)
    parser.add_argument("--steps", type=int, required=True)
    parser.add_argument("--solver", choices=("gamg", "jacobi"), required=True)
    parser.add_argument("--tolerance", type=float, required=True)
    arguments = parser.parse_args()
    world, begin = MPI.COMM_WORLD, time.perf_counter()
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    if world.rank == 0:
        gmsh.open(arguments.mesh)
    domain = gmshio.model_to_mesh(gmsh.model, world, 0, gdim=3)[0]
    gmsh.finalize()
    space = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    strain = ufl.sym(ufl.grad(u))
    stress = LAMBDA * ufl.tr(strain) * ufl.Identity(3) + 2 * MU * strain
    one_point = {"quadrature_degree": 0}
    stiffness = fem.petsc.assemble_matrix(fem.form(ufl.inner(stress, ufl.sym(ufl.grad(v))) * ufl.dx(metadata=one_point)))
    stiffness.assemble()
    mass = fem.petsc.assemble_matrix(fem.form(DENSITY * ufl.inner(u, v) * ufl.dx))
    mass.assemble()
    h = arguments.step
    operator = stiffness.copy()
    operator.axpy(4 / h**2, mass, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
    solver, operator = linear_solver(operator, space, arguments.solver, arguments.tolerance)
    velocity = fem.Function(space)
    velocity.interpolate(start_velocity)
    velocity = velocity.vector.copy()
    gravity = fem.Function(space)
    gravity.interpolate(lambda x: np.repeat(np.array(GRAVITY)[:, None], x.shape[1], axis=1))
    load = mass * gravity.vector
    displacement, increment = velocity.duplicate(), velocity.duplicate()
    displacement.set(0.0)
    acceleration = gravity.vector.copy()
    increment.set(0.0)
    world.barrier()
    ready, iterations, times = time.perf_counter(), 0, []
    for _ in range(arguments.steps):
        # A δ = L − K u + M (4/h v + a), from which follow velocity and acceleration.
        step_begin = time.perf_counter()
        right = load - stiffness * displacement + mass * (4 / h * velocity + acceleration)
        solver.solve(right, increment)
        iterations += solver.getIterationNumber()
        displacement += increment
        new = 4 / h**2 * increment - 4 / h * velocity - acceleration
        velocity = velocity + h / 2 * (acceleration + new)
        acceleration = new
        world.barrier()
        times.append(time.perf_counter() - step_begin)
    memory = world.allreduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, MPI.MAX)
    energy = 0.5 * velocity.dot(mass * velocity) + 0.5 * displacement.dot(stiffness * displacement) - load.dot(displacement)
    if world.rank == 0:
        print(json.dumps({"processes": world.size, "dofs": displacement.getSize(), "setup": ready - begin,
                          "ms_per_step": 1e3 * float(np.median(times[1:])), "iterations": iterations / arguments.steps,
                          "memory_mb": memory, "energy": energy}))


main()
