"""The energy account, recomputed from the stored fields by another program: linear triangles in plane strain, assembled
here, on the mesh in results.h5. history.csv only provides the values that are compared."""

import h5py
import numpy

from harness import DISC, History, TestCase

# From cases/disc/disc.toml.
DENSITY, LAMBDA, MU, GRAVITY = 6000.0, 1.0e4, 5.0e3, numpy.array([0.0, -9.81])
STEP, STEPS = 1.0e-4, 130


def assemble(nodes, cells):
    """Assembles dense mass and stiffness matrices; dofs are numbered 2 node + component."""
    dofs = 2 * len(nodes)
    mass, stiffness = numpy.zeros((dofs, dofs)), numpy.zeros((dofs, dofs))
    hooke = numpy.array([[LAMBDA + 2 * MU, LAMBDA, 0], [LAMBDA, LAMBDA + 2 * MU, 0], [0, 0, MU]])
    for cell in cells:
        edges = (nodes[cell[1:]] - nodes[cell[0]]).T
        area = 0.5 * numpy.linalg.det(edges)
        gradient = numpy.vstack([[-1.0, -1.0], numpy.eye(2)]) @ numpy.linalg.inv(edges)
        strain = numpy.zeros((3, 6))
        strain[0, 0::2] = strain[2, 1::2] = gradient[:, 0]
        strain[1, 1::2] = strain[2, 0::2] = gradient[:, 1]
        at = numpy.column_stack([2 * cell, 2 * cell + 1]).ravel()
        stiffness[numpy.ix_(at, at)] += area * strain.T @ hooke @ strain
        scalar = DENSITY * area / 12.0 * (numpy.ones((3, 3)) + numpy.eye(3))
        mass[numpy.ix_(at, at)] += numpy.kron(scalar, numpy.eye(2))
    return mass, stiffness


class Account:
    """Matrices, loads and stored motion of one run."""

    def __init__(self, results):
        with h5py.File(results / "results.h5", "r") as file:
            self.nodes = file["/mesh/nodes"][()][:, :2]
            self.mass, self.stiffness = assemble(self.nodes, file["/mesh/cells"][()])
            frames = [file["/frames"][name] for name in sorted(file["/frames"])]
            self.displacement = [frame["displacement"][()][:, :2].ravel() for frame in frames]
            self.velocity = [frame["velocity"][()][:, :2].ravel() for frame in frames]
        self.load = self.mass @ numpy.tile(GRAVITY, len(self.nodes))

    def energies(self, displacement, velocity):
        return {"kinetic_energy": 0.5 * velocity @ self.mass @ velocity,
                "elastic_energy": 0.5 * displacement @ self.stiffness @ displacement,
                "load_potential": -self.load @ displacement}


def midpoint(account, h):
    """Returns, per row, the energies, the contact force per dof, and the displacement on which it does work in the step
    that ends there."""
    u, v = account.displacement, account.velocity
    yield account.energies(u[0], v[0]), 0 * account.load, 0 * account.load
    for n in range(1, len(u)):
        force = account.mass @ (v[n] - v[n - 1]) / h + account.stiffness @ (u[n] + u[n - 1]) / 2 - account.load
        yield account.energies(u[n], v[n]), force, u[n] - u[n - 1]


def klr_conserving(account, h):
    """Returns the same quantities; energies are those half a step after the row's time, so that the last row has
    none."""
    u = account.displacement
    for n in range(len(u) - 1):
        energies = account.energies((u[n] + u[n + 1]) / 2, (u[n + 1] - u[n]) / h)
        if n == 0:
            yield energies, 0 * account.load, 0 * account.load
            continue
        second = (u[n + 1] - 2 * u[n] + u[n - 1]) / h**2
        force = account.mass @ second + account.stiffness @ (u[n + 1] + 2 * u[n] + u[n - 1]) / 4 - account.load
        yield energies, force, (u[n + 1] - u[n - 1]) / 2


class EnergyAccount(TestCase):
    def check(self, scheme, recompute, friction=0.0):
        """Checks the works of normal and of tangential contact forces, as fractions of the largest energy."""
        values = {"time.scheme": scheme, "mass.type": "consistent", "time.step": STEP, "time.end": STEP * STEPS,
                  "output.fields_every": 1, "contact.0.friction": friction}
        if friction > 0.0:
            values["initial.velocity"] = "[0.05,-0.1]"
        results = self.simulate(DISC, name=scheme, values=values)
        history = History(results / "history.csv")
        account = Account(results)
        self.assertEqual(len(account.displacement), STEPS + 1)
        scale = history.largest_energy()
        largest_force = max(history["contact_force_y"])
        self.assertGreater(largest_force, 0.0)
        works, worst = numpy.zeros(2), 0.0  # along the floor and across it
        # The contact boundary is the lower half of the circle: all other dofs are free of contact forces, as is the
        # sideways direction without friction.
        free = numpy.ones(2 * len(account.nodes), dtype=bool)
        free[1::2] = account.nodes[:, 1] > 0.021 + 1e-9
        if friction > 0.0:
            free[0::2] = free[1::2]
        lowest = 2 * int(numpy.argmin(numpy.linalg.norm(account.nodes - [0.0, 0.001], axis=1))) + 1
        for row, (energies, force, increment) in enumerate(recompute(account, STEP)):
            works += (force * increment).reshape(-1, 2).sum(axis=0)
            found = dict(energies, friction_work=works[0], contact_work=works[1], total_energy=sum(energies.values()))
            for name, value in found.items():
                difference = abs(value - history[name][row])
                worst = max(worst, difference / scale)
                self.assertLessEqual(difference, 1e-10 * scale, f"{name} in row {row}")
            self.assertLessEqual(numpy.abs(force[free]).max(), 1e-9 * largest_force, f"row {row}: no equilibrium")
            across, along = force[1::2], force[0::2]
            self.assertGreaterEqual(across[~free[1::2]].min(), -1e-9 * largest_force, f"row {row}: contact pulls")
            self.assertLessEqual((numpy.abs(along) - friction * across)[~free[1::2]].max(), 1e-9 * largest_force,
                                 f"row {row}: more friction than Coulomb's law allows")
            for name, value in (("contact_force_x", along.sum()), ("contact_force_y", across.sum()),
                                ("lowest.reaction_normal", force[lowest]),
                                ("lowest.reaction_tangential_x", force[lowest - 1])):
                self.assertAlmostEqual(value, history[name][row], delta=1e-9 * largest_force, msg=f"{name}, row {row}")
        print(f"{scheme}: largest difference {worst:.1e} of the largest energy {scale:.3g}, works {works}")
        return works[::-1] / scale

    def test_midpoint(self):
        contact, friction = self.check("midpoint", midpoint)
        self.assertGreater(abs(contact), 0.1, "contact does work in this scheme")
        self.assertLess(abs(friction), 1e-12)

    def test_klr_conserving(self):
        contact, friction = self.check("klr-conserving", klr_conserving)
        self.assertLess(abs(contact), 1e-10, "and none in this one")
        self.assertLess(abs(friction), 1e-12)

    def test_friction_in_both(self):
        for scheme, recompute in (("midpoint", midpoint), ("klr-conserving", klr_conserving)):
            with self.subTest(scheme):
                contact, friction = self.check(scheme, recompute, friction=0.3)
                self.assertLess(friction, -1e-5, "friction takes energy away")
