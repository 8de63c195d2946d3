"""Rigid and elastic bodies that strike one another, compared with closed forms: Hertz, a cradle, bounces in a bowl, a
peg in a hole."""

import numpy

from harness import History, TestCase
from hertz import CONTACT_TIME, PointImpact, contact_modulus

QUARTER = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, -3, 3, 3, 3};
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = Ball;
Field[1].Radius = 0.1;
Field[1].Thickness = 3;
Field[1].VIn = 0.018;
Field[1].VOut = 0.7;
Background Field = 1;
Physical Volume("plate") = {1};
Physical Surface("x0") = {1};
Physical Surface("y0") = {3};
Physical Surface("foot") = {5};
Physical Surface("top") = {6};
"""
DISC = """SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 0.2};
Mesh.MeshSizeMax = 0.06;
Physical Surface("ball") = {1};
Physical Curve("skin") = {1};
"""
BLOCK = """SetFactory("OpenCASCADE");
Rectangle(1) = {-0.2, -0.15, 0, 0.4, 0.3};
Mesh.MeshSizeMax = 0.05;
Physical Surface("block") = {1};
Physical Curve("guides") = {1, 3};
Physical Curve("ends") = {2, 4};
"""
PEG = """SetFactory("OpenCASCADE");
Rectangle(1) = {-0.199, 0.0, 0, 0.398, 0.6};
Mesh.MeshSizeMax = 0.08;
Physical Surface("peg") = {1};
Physical Curve("base") = {1};
Physical Curve("right") = {2};
Physical Curve("head") = {3};
Physical Curve("left") = {4};
"""


class Impacts(TestCase):
    def history(self, text, name="out"):
        return History(self.simulate(self.write("case.toml", text), name) / "history.csv")

    def closes(self, history, part=1e-11):
        self.assertGreater(max(history["active_contacts"]), 0)
        self.assertLess(max(map(abs, history["energy_residual"])), part * history.largest_energy())


class Hertz(Impacts):
    """A rigid ball bounces on an elastic block as large as 40 contact radii; a quarter of both. Depth, force and
    duration of Hertz' impact on a half-space: the block is stiffer by some 2 %."""

    def test_a_ball_that_bounces(self):
        (self.folder / "plate.geo").write_text(QUARTER)
        young, poisson, depth, duration = 1000.0, 0.3, 0.005, 1.0
        velocity, modulus = CONTACT_TIME * depth / duration, contact_modulus((young, poisson))
        mass = 16.0 * modulus * depth**2.5 / (15.0 * velocity**2)
        force = PointImpact(modulus, 1.0, mass, velocity).force
        history = self.history(
            f'[mesh]\nfile = "plate.geo"\n[[material]]\ngroup = "plate"\ndensity = 0.01\nyoung = {young}\npoisson = {poisson}\n'
            + "".join(f'[[support]]\ngroup = "{group}"\ncomponents = ["{axis}"]\n'
                      for group, axis in (("x0", "x"), ("y0", "y"), ("foot", "z")))
            + f'[obstacle.ball]\ntype = "sphere"\ncentre = [0.0, 0.0, 1.00005]\nradius = 1.0\nmass = {mass / 4.0}\n'
            f'velocity = [0.0, 0.0, {-velocity}]\nhold = ["x", "y", "rotation"]\n'
            '[[contact]]\ngroup = "top"\nobstacle = "ball"\n[mass]\ntype = "equivalent"\n[time]\nstep = 0.01\nend = 1.2\n')
        self.closes(history)
        self.assertAlmostEqual(-min(history["ball.displacement_z"]) - 5e-5, depth, delta=0.05 * depth)
        self.assertAlmostEqual(4.0 * max(history["ball.contact_force_z"]), force, delta=0.05 * force)
        pressed = [t for t, n in zip(history["time"], history["active_contacts"]) if n > 0]
        self.assertAlmostEqual(pressed[-1] - pressed[0], duration, delta=0.06 * duration)
        # It returns with its initial speed, by the impulse of the force.
        self.assertAlmostEqual(history["ball.velocity_z"][-1], velocity, delta=0.01 * velocity)
        impulse = numpy.sum(history["ball.contact_force_z"]) * 0.01
        self.assertAlmostEqual(impulse, mass / 4.0 * (history["ball.velocity_z"][-1] + velocity), delta=1e-9 * impulse)


class Cradle(Impacts):
    """A light elastic block between guides and two rigid discs of equal mass: a spring between them, and the first one
    stops."""

    def test_the_last_ball_goes_on_with_the_velocity(self):
        (self.folder / "block.geo").write_text(BLOCK)
        history = self.history(
            '[mesh]\nfile = "block.geo"\n[[material]]\ngroup = "block"\ndensity = 0.01\nyoung = 100.0\npoisson = 0.3\n'
            '[[support]]\ngroup = "guides"\ncomponents = ["y"]\n'
            + "".join(f'[obstacle.{name}]\ntype = "sphere"\ncentre = [{x}, 0.0]\nradius = 0.2\nmass = 1.0\n'
                      f'velocity = [{velocity}, 0.0]\n[[contact]]\ngroup = "ends"\nobstacle = "{name}"\n'
                      for name, x, velocity in (("first", -0.405, 0.1), ("last", 0.405, 0.0)))
            + '[mass]\ntype = "equivalent"\n[time]\nstep = 0.002\nend = 2.0\n')
        self.closes(history)
        self.assertAlmostEqual(history["last.velocity_x"][-1], 0.1, delta=0.003)
        self.assertAlmostEqual(history["first.velocity_x"][-1], 0.0, delta=0.003)
        self.assertLess(numpy.ptp(history["momentum_x"]), 1e-12)


class Bounces(Impacts):
    """An elastic ball in a bowl, without friction."""

    def case(self, scheme, mass, law="linear"):
        (self.folder / "ball.geo").write_text(DISC)
        return ('[mesh]\nfile = "ball.geo"\n[[material]]\ngroup = "ball"\ndensity = 1.0\nyoung = 200.0\npoisson = 0.3\n'
                f'law = "{law}"\n[obstacle.bowl]\ntype = "sphere"\ncentre = [0.0, 0.5]\nradius = 1.0\nside = "inside"\n'
                '[[contact]]\ngroup = "skin"\nobstacle = "bowl"\n[initial]\nvelocity = [0.5, 0.0]\n'
                f'[load]\ngravity = [0.0, -2.0]\n[mass]\ntype = "{mass}"\n[time]\nscheme = "{scheme}"\nstep = 0.002\nend = 10.0\n')

    def bounces(self, history):
        pressed = [count > 0 for count in history["active_contacts"]]
        return sum(after and not before for before, after in zip(pressed, pressed[1:]))

    def test_a_conserving_scheme_keeps_the_energy(self):
        history = self.history(self.case("laursen-chawla", "consistent"))
        self.closes(history)
        self.assertGreater(self.bounces(history), 10)
        self.assertLess(numpy.ptp(history["total_energy"]), 1e-10 * max(history["kinetic_energy"]))

    def test_the_default_never_gives_any(self):
        """On curved surfaces nodes penetrate by the last correction: to rounding with the least tolerance."""
        for tolerance, deepest in (("", 1e-11), ("[solver]\nnewton_tolerance = 1e-13\n", 1e-13)):
            history = self.history(self.case("reduced-kane", "equivalent", "neo-hookean") + tolerance, f"to{deepest:g}")
            self.closes(history)
            self.assertGreater(self.bounces(history), 10)
            self.assertLess(max(numpy.diff(history["total_energy"])), 1e-12 * max(history["kinetic_energy"]))
            self.assertLess(max(history["max_penetration"]), deepest)


class PegInHole(Impacts):
    """A peg that arrives beside the hole slides in over the chamfers, with 1 mm of play in 400: two obstacles at
    once."""

    def test_it_goes_in(self):
        (self.folder / "peg.geo").write_text(PEG)
        (self.folder / "left.txt").write_text("-2 0\n-0.28 0\n-0.2 -0.08\n-0.2 -1\n-2 -1\n-2 0\n")
        (self.folder / "right.txt").write_text("2 0\n2 -1\n0.2 -1\n0.2 -0.08\n0.28 0\n2 0\n")
        history = self.history(
            '[mesh]\nfile = "peg.geo"\nmove = [0.04, 0.001]\n[[material]]\ngroup = "peg"\ndensity = 1.0\nyoung = 1e4\npoisson = 0.3\n'
            'damping = { stiffness = 2e-4 }\n[[support]]\ngroup = "head"\ncomponents = ["y"]\nvalue = "-0.5*t"\n'
            + "".join(f'[obstacle.{name}]\ntype = "surface"\nfile = "{name}.txt"\nedge_radius = 0.01\n'
                      f'[[contact]]\ngroup = ["base", "left", "right"]\nobstacle = "{name}"\nfriction = 0.1\n'
                      for name in ("left", "right"))
            + '[mass]\ntype = "equivalent"\n[time]\nstep = 0.001\nend = 0.8\n[[probe]]\nname = "middle"\nat = [0.04, 0.3]\n')
        self.closes(history)
        # In the hole: displaced by its initial offset, up to the play.
        self.assertAlmostEqual(history["middle.displacement_x"][-1], -0.04, delta=0.003)
        self.assertLess(max(history["friction_work"]), 1e-12)
        self.assertLess(max(history["contact_work"]), 1e-12)
        self.assertLess(max(history["max_penetration"]), 1e-10)
