#!/usr/bin/python3
"""The bouncing disc of cases/disc under the schemes of GetFEM's authors: GetFEM's matrices and contact solver, and Ricochet's runs.

  getfem_disc.py [--only TEXT] [--tolerance 1e-8] [--end 0.15]

The steps are those of GetFEM's tests/dynamic_friction.cc (until 2015), which is the program of the source, and of its
demo_dynamic_contact_1D.py. Prints two tables; returns 0 if every row agrees as far as it should. docs/peers.md
explains it. RICOCHET=PROGRAM names a program elsewhere.
"""

import argparse
import os
import pathlib
import sys
import tempfile

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import getfem
import meshio
import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import ours
from body import Body

CASE = ours.ROOT / "cases" / "disc" / "disc.toml"
STEP, GRAVITY, VELOCITY = 1e-4, [0.0, -9.81], [0.0, -0.1]
FAR = 1e3  # a gap that never closes


class Disc:
    """GetFEM's matrices, with nodes in the order of the mesh file."""

    def __init__(self, body, directory):
        path = pathlib.Path(directory) / "disc22.msh"
        meshio.write(path, meshio.read(body.mesh_file), file_format="gmsh22", binary=False)
        mesh = getfem.Mesh("import", "gmsh", str(path))
        self.space = getfem.MeshFem(mesh, 2)
        self.space.set_classical_fem(1)
        integration, data = getfem.MeshIm(mesh, 2), getfem.MeshFem(mesh, 1)
        data.set_classical_fem(0)
        material, one = body.case["material"][0], np.ones(data.nbdof())
        mass = getfem.asm_mass_matrix(integration, self.space)
        mass.scale(material["density"])
        stiffness = getfem.asm_linear_elasticity(integration, self.space, data, material["lambda"] * one, material["mu"] * one)
        # Their dof of each of the file's nodes; the components of a node are adjacent in both.
        places = self.space.basic_dof_nodes()[:, ::2].T
        order = [int(np.argmin(((places - point) ** 2).sum(axis=1))) for point in body.points]
        self.numbers = (2 * np.array(order)[:, None] + np.arange(2)).ravel()
        self.mass, self.stiffness = self.reordered(mass), self.reordered(stiffness)
        self.lumped = scipy.sparse.diags(np.asarray(self.mass.sum(axis=1)).ravel()).tocsr()
        self.body, self.contact = body, 2 * body.nodes("lower") + 1
        self.gap = body.points[body.nodes("lower"), 1]
        self.consistent_load = self.mass @ body.field(GRAVITY)

    def reordered(self, matrix):
        starts, rows = matrix.csc_ind()
        scipy_matrix = scipy.sparse.csc_matrix((matrix.csc_val(), rows, starts), shape=(matrix.size()[0],) * 2)
        return scipy_matrix[self.numbers][:, self.numbers].tocsr()

    def singular_mass(self, symmetric_conditions):
        """The nearest matrix to M on its pattern without contact nodes that keeps mass, centre and moments of inertia.

        The authors' program states its conditions for one of the two indices, and symmetrizes afterwards.
        """
        points, full = self.body.points, self.mass[::2, ::2].tocoo()
        contact = np.zeros(len(points), dtype=bool)
        contact[self.contact // 2] = True
        monomials = [np.ones(len(points)), points[:, 0], points[:, 1]]

        def conditions(rows, columns):
            result = []
            for a in range(3):
                for b in range(a, 3):
                    pair = monomials[a][columns] * monomials[b][rows], monomials[b][columns] * monomials[a][rows]
                    result.append(0.5 * (pair[0] + pair[1]) if symmetric_conditions else pair[1])
            return np.array(result)

        free = ~(contact[full.row] | contact[full.col])
        rows, columns = full.row[free], full.col[free]
        kept = conditions(rows, columns)
        defect = conditions(full.row, full.col) @ full.data - kept @ full.data[free]
        scale = 1 / np.linalg.norm(kept, axis=1)
        kept, defect = scale[:, None] * kept, scale * defect
        values = full.data[free] + kept.T @ np.linalg.solve(kept @ kept.T, defect)
        scalar = scipy.sparse.coo_matrix((values, (rows, columns)), shape=full.shape).tocsr()
        return scipy.sparse.kron(0.5 * (scalar + scalar.T), scipy.sparse.identity(2)).tocsr()

    def moments(self, mass):
        """Returns the products of 1, x, y with each other, for the first component."""
        monomials = np.vstack([np.ones(len(self.body.points)), self.body.points.T])
        return monomials @ mass[::2, ::2] @ monomials.T


class Stage:
    """A d = b + B^T r, 0 <= r, q + (d_y) >= 0 complementary: GetFEM's nodal contact brick, Newton's method and MUMPS."""

    def __init__(self, disc, matrix):
        self.disc = disc
        self.model = getfem.Model("real")
        self.model.add_fem_variable("u", disc.space)
        self.model.add_explicit_matrix("u", "u", self.to_getfem(matrix), 1, 1)
        self.right = self.model.add_explicit_rhs("u", np.zeros(disc.body.dofs))
        trace = getfem.Spmat("empty", len(disc.contact), disc.body.dofs)
        for row, dof in enumerate(disc.contact):
            trace.add(row, int(disc.numbers[dof]), -1.0)
        self.model.add_variable("lambda_n", len(disc.contact))
        self.model.add_initialized_data("r", [float(matrix.diagonal().mean())])
        self.model.add_initialized_data("gap", disc.gap)
        self.model.add_basic_contact_brick("u", "lambda_n", "r", trace, "gap")

    def to_getfem(self, matrix):
        theirs = getfem.Spmat("empty", *matrix.shape)
        entries = matrix.tocoo()
        numbers = self.disc.numbers
        for row, column, value in zip(numbers[entries.row], numbers[entries.col], entries.data):
            theirs.add(int(row), int(column), float(value))
        return theirs

    def solve(self, force, gap):
        numbers = self.disc.numbers
        right = np.empty_like(force)
        right[numbers] = force
        self.model.set_private_rhs(self.right, right)
        self.model.set_variable("gap", gap)
        self.model.solve("max_res", 1e-13 * max(1.0, abs(force).max()), "max_iter", 100, "lsolver", "mumps")
        return self.model.variable("u")[numbers], -self.model.variable("lambda_n")


class Theirs:
    """Displacement and force of the contact nodes at every step, and the energies."""

    def __init__(self, disc, mass, load):
        self.disc, self.mass, self.load = disc, mass, load
        self.displacement, self.force, self.energy = [], [], []

    def take(self, displacement, force, energy_displacement, energy_velocity):
        self.displacement.append(displacement[self.disc.contact])
        self.force.append(force)
        self.energy.append(0.5 * energy_velocity @ (self.mass @ energy_velocity)
                           + 0.5 * energy_displacement @ (self.disc.stiffness @ energy_displacement)
                           - self.load @ energy_displacement)

    def arrays(self):
        return np.array(self.displacement), np.array(self.force), np.array(self.energy)


def start(disc, mass, load):
    result = Theirs(disc, mass, load)
    return result, np.zeros(disc.body.dofs), disc.body.field(VELOCITY)


def midpoint(disc, mass, load, steps, persistent=False, states=None):
    """SCHEME 2; persistent: SCHEME 8, Laursen and Chawla's condition. Each step starts from the end of the previous
    one, or from one of `states`."""
    h, (result, U, V) = STEP, start(disc, mass, load)
    stage = Stage(disc, 4 / h**2 * mass + disc.stiffness)
    for n in range(steps):
        if states:
            U, V, _ = states[n]
        base = U + h / 2 * V
        gap = disc.gap + base[disc.contact]
        if persistent:
            gap = np.where(disc.gap + U[disc.contact] > 1e-13, FAR, base[disc.contact] - U[disc.contact])
        d, force = stage.solve(load - disc.stiffness @ base, gap)
        U, V = U + h * V + 2 * d, V + 4 / h * d
        result.take(U, force, U, V)
    return result.arrays()


def newmark(disc, mass, load, steps, states=None, as_theirs=False):
    """SCHEME 1 with BETA = GAMMA = 1/2 of its notation: the trapezoidal rule.

    as_theirs: with a singular mass their program starts with A = 0 in the velocities, but with M A = L - K U in the forces.
    """
    h, (result, U, V) = STEP, start(disc, mass, load)
    stage = Stage(disc, 4 / h**2 * mass + disc.stiffness)
    MA, MV = load - disc.stiffness @ U, mass @ V
    before = 0.0 * MA if as_theirs else MA
    massive = mass.diagonal() > 0
    inverse = scipy.sparse.linalg.splu(mass[massive][:, massive].tocsc())

    def velocity():
        values = np.zeros_like(U)
        values[massive] = inverse.solve(MV[massive])
        return values

    V = velocity()
    for n in range(steps):
        if states:
            U, V, A = states[n]
            MV, MA = mass @ V, mass @ A
            before = MA
        # On nodes without mass the base is arbitrary, because V is zero there.
        d, force = stage.solve(load - disc.stiffness @ (U + h * V) + MA, disc.gap + (U + h * V)[disc.contact])
        U = U + h * V + d
        MA = 4 / h**2 * (mass @ d) - before
        MV, before = MV + h / 2 * (before + MA), MA
        V = velocity()
        result.take(U, force, U, V)
    return result.arrays()


def conserving(disc, mass, load, steps, positions=False):
    """SCHEME 6; positions: SCHEME 5, Paoli and Schatzman's condition with e = 0. A row has U^n, r^n, the energy at n + 1/2."""
    h, (result, before, V) = STEP, start(disc, mass, load)
    now = before + h * V
    stage = Stage(disc, mass / h**2 + disc.stiffness / 4)
    for _ in range(steps):
        ahead = now - before
        if positions:
            gap = disc.gap + (now + ahead)[disc.contact]
        else:
            gap = np.where(disc.gap + now[disc.contact] > 1e-13, FAR, 2 * ahead[disc.contact])
        d, force = stage.solve(load - disc.stiffness @ now, gap)
        after = now + ahead + d
        result.take(now, force, 0.5 * (now + after), (after - now) / h)
        before, now = now, after
    return result.arrays()


def explicit(disc, mass, load, steps, restitution=0.0):
    """SCHEME 4, Paoli and Schatzman's, with their projection: that of each node, which is the one of M where M is diagonal."""
    h, (result, before, V) = STEP, start(disc, mass, load)
    now = before + h * V
    factor = scipy.sparse.linalg.splu(mass.tocsc())
    for _ in range(steps):
        force = load - disc.stiffness @ now
        after = 2 * now - before + h**2 * factor.solve(force)
        mean = (after + restitution * before)[disc.contact] / (1 + restitution)
        after[disc.contact] += (1 + restitution) * np.maximum(0.0, -disc.gap - mean)
        reaction = mass @ (after - 2 * now + before) / h**2 - force
        result.take(now, reaction[disc.contact], 0.5 * (now + after), (after - now) / h)
        before, now = now, after
    return result.arrays()


def velocity_form(disc, mass, load, steps):
    """Version 4 of the one-dimensional demo, "Taylor-Flanagan": a node that would penetrate is stopped where it is."""
    h, (result, before, V) = STEP, start(disc, mass, load)
    now = before + h * V
    factor = scipy.sparse.linalg.splu(mass.tocsc())
    for _ in range(steps):
        force = load - disc.stiffness @ now
        after = 2 * now - before + h**2 * factor.solve(force)
        closed = disc.contact[disc.gap + after[disc.contact] < 0.0]
        after[closed] = now[closed]
        reaction = mass @ (after - 2 * now + before) / h**2 - force
        result.take(now, reaction[disc.contact], 0.5 * (now + after), (after - now) / h)
        before, now = now, after
    return result.arrays()


# U^1 = U^0 + h V^0 in their program, U^0 + h V^0 + h^2/2 A^0 in ours, which therefore starts slightly slower.
SLOWER = {"initial.velocity": [0.0, VELOCITY[1] - 0.5 * STEP * GRAVITY[1]]}
TRAPEZOIDAL = {"time.scheme": "newmark", "time.preset": "trapezoidal"}
CENTRAL = {"time.scheme": "paoli-schatzman", **SLOWER}


ALL = None


class Row:
    """`agrees`: minimum number of steps that agree; 0 if the schemes differ. from_ours: each step starts from our
    state."""

    def __init__(self, name, mass, theirs, settings, agrees=ALL, load="mass", from_ours=False):
        self.name, self.mass, self.theirs, self.settings = name, mass, theirs, settings
        self.agrees, self.load, self.from_ours = agrees, load, from_ours

    def holds(self, first, steps):
        return first is None or (self.agrees is not ALL and first > min(self.agrees, steps))


ROWS = [
    Row("midpoint (2)", "consistent", midpoint, {"time.scheme": "midpoint"}, agrees=100),
    Row("midpoint (2), from ours", "consistent", midpoint, {"time.scheme": "midpoint"}, from_ours=True),
    Row("laursen-chawla (8)", "consistent", lambda *a: midpoint(*a, persistent=True), {"time.scheme": "laursen-chawla"}),
    Row("conserving (6)", "consistent", conserving, {"time.scheme": "klr-conserving", **SLOWER}),
    Row("newmark (1)", "consistent", newmark, TRAPEZOIDAL, agrees=100),
    Row("newmark (1), from ours", "consistent", newmark, TRAPEZOIDAL, from_ours=True),
    Row("newmark (1)", "nearest", newmark, TRAPEZOIDAL),
    Row("newmark (1)", "theirs", newmark, TRAPEZOIDAL, agrees=0),
    Row("newmark (1), their load", "theirs", lambda *a: newmark(*a, as_theirs=True), TRAPEZOIDAL, agrees=0, load="consistent"),
    Row("paoli-schatzman, implicit (5)", "consistent", lambda *a: conserving(*a, positions=True), CENTRAL),
    Row("paoli-schatzman, explicit (4)", "lumped", explicit, {**CENTRAL, "time.stiffness": "explicit"}),
    Row("paoli-schatzman, e=0.5 (4)", "lumped", lambda *a: explicit(*a, restitution=0.5),
        {**CENTRAL, "time.stiffness": "explicit", "time.restitution": 0.5}),
    Row("paoli-schatzman, explicit (4)", "consistent", explicit, None, agrees=0),
    Row("taylor-flanagan, as (4)", "lumped", explicit, {"time.scheme": "taylor-flanagan", **SLOWER}),
    Row("taylor-flanagan, 1D demo", "lumped", velocity_form, {"time.scheme": "taylor-flanagan", **SLOWER}, agrees=0),
]
OUR_MASS = {"consistent": "consistent", "lumped": "lumped", "nearest": "equivalent-nearest", "theirs": "equivalent-nearest"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--only", default="", help="only the rows whose name contains this text")
    parser.add_argument("--tolerance", type=float, default=1e-8)
    parser.add_argument("--end", type=float, default=0.15)
    arguments = parser.parse_args()
    getfem.util_trace_level(0)
    steps, results, agree = round(arguments.end / STEP), [], True
    with tempfile.TemporaryDirectory() as scratch:
        body = Body(CASE, "consistent")
        disc = Disc(body, scratch)
        for name, a, b in (("M", disc.mass, body.mass), ("K", disc.stiffness, body.stiffness)):
            print(f"{name}: GetFEM's matrix and the one assembled here differ by {abs(a - b).max() / abs(b).max():.1e} of the largest entry")
        masses = {"consistent": disc.mass, "lumped": disc.lumped, "nearest": disc.singular_mass(True),
                  "theirs": disc.singular_mass(False)}
        moments = disc.moments(disc.mass)
        for name in ("nearest", "theirs"):
            change = abs(disc.moments(masses[name]) - moments) / np.sqrt(np.outer(moments.diagonal(), moments.diagonal()))
            values = np.linalg.eigvalsh(masses[name][::2, ::2].toarray())
            print(f"mass {name}: its total, centre and moments of inertia deviate by {change.max():.1e}, "
                  f"its eigenvalues are between {values.min() / values.max():.1e} and 1")
        lowest = int(np.argmin(disc.gap))
        print("\nlargest difference / largest value; the first step beyond the tolerance\n"
              f"{'scheme':30s} {'mass':10s} steps  displacement        force       energy    from step")
        for row in ROWS:
            if arguments.only not in f"{row.name} {row.mass}":
                continue
            mass = masses[row.mass]
            load = disc.consistent_load if row.load == "consistent" else mass @ body.field(GRAVITY)
            if row.settings is None:  # Ricochet has no such scheme
                theirs, mine = row.theirs(disc, mass, load, steps), None
                results.append((row, theirs, mine))
                continue
            ours.run(CASE, scratch + "/run", {**row.settings, "mass.type": OUR_MASS[row.mass], "time.step": repr(STEP),
                                              "time.end": repr(STEP * steps)})
            taken = ours.Steps(scratch + "/run", body, "lower")
            mine = taken.displacement[1:, :, 1], taken.normal_force[1:], ours.history(scratch + "/run")["total_energy"][1:]
            states = {"states": ours.states(scratch + "/run")} if row.from_ours else {}
            theirs = row.theirs(disc, mass, load, steps, **states)
            differences = [abs(a - b).reshape(steps, -1).max(axis=1) / max(abs(a).max(), 1e-300) for a, b in zip(mine, theirs)]
            beyond = np.flatnonzero(np.max(differences, axis=0) > arguments.tolerance)
            first = beyond[0] + 1 if len(beyond) else None
            agree = agree and row.holds(first, steps)
            print(f"{row.name:30s} {row.mass:10s} {steps:5d}  " + " ".join(f"{each.max():12.1e}" for each in differences)
                  + f" {first or '-':>12}" + ("" if row.agrees != 0 else "   not the same scheme"), flush=True)
            results.append((row, theirs, mine))
    print(f"\n{'':41s}| theirs: energy at                 force at lowest node | ours: energy at                   force at lowest node\n"
          f"{'scheme':30s} {'mass':10s}|    start        end    largest   largest variation |    start        end    largest"
          "   largest variation")
    for row, theirs, mine in results:
        print(f"{row.name:30s} {row.mass:10s}", end="")
        for each in (theirs, mine):
            if each is None:
                print("| -", end="")
                continue
            force, energy = each[1][:, lowest], each[2]
            print(f"| {energy[0]:9.6f} {energy[-1]:10.5g} {energy.max():10.5g} {abs(force).max():9.4g} {abs(np.diff(force)).sum():9.4g} ",
                  end="")
        print()
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
