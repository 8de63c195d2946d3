"""Bodies that slide along each other without limit: closed forms, momenta, energy, resumed runs, refusals."""

import math

import numpy

from harness import History, TestCase, run, summary_of
from closed_forms_of_contacts import BlockInBowl

BOWL = 0.25  # height = BOWL x^2
HALF, THICK = 0.2, 0.15
BOWL_GEO = """N = 40;
For i In {{0:N}}
  x = -1.2 + 2.4*i/N;
  Point(i+1) = {{x, {bowl}*x^2, 0, {size}}};
EndFor
Point(101) = {{-1.2, -0.4, 0, 0.3}};
Point(102) = {{1.2, -0.4, 0, 0.3}};
Spline(1) = {{1:N+1}};
Line(2) = {{N+1, 102}};
Line(3) = {{102, 101}};
Line(4) = {{101, 1}};
Curve Loop(1) = {{1, 2, 3, 4}};
Plane Surface(1) = {{1}};
Physical Surface("bowl") = {{1}};
Physical Curve("top") = {{1}};
Physical Curve("foot") = {{3}};
"""
BLOCK_GEO = """Point(1) = {{{left}, 0, 0, {size}}};
Point(2) = {{{right}, 0, 0, {size}}};
Point(3) = {{{right}, {height}, 0, {size}}};
Point(4) = {{{left}, {height}, 0, {size}}};
Line(1) = {{1, 2}};
Line(2) = {{2, 3}};
Line(3) = {{3, 4}};
Line(4) = {{4, 1}};
Curve Loop(1) = {{1, 2, 3, 4}};
Plane Surface(1) = {{1}};
Physical Surface("block") = {{1}};
Physical Curve("skin") = {{1, 2, 3, 4}};
Physical Curve("base") = {{1}};
"""
BOX_GEO = """SetFactory("OpenCASCADE");
Box(1) = {{0, 0, 0, {lengths}}};
Mesh.MeshSizeMax = {size};
Mesh.MeshSizeMin = {size};
Physical Volume("body") = {{1}};
Physical Surface("base") = {{5}};
Physical Surface("top") = {{6}};
"""
HUB_GEO = """Point(1) = {20, 0, 0};
Point(2) = {30, 0, 0};
Point(3) = {30, 6, 0};
Point(4) = {20, 6, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 3;
Transfinite Curve{2, 4} = 7;
Transfinite Surface{1};
Recombine Surface{1};
Physical Curve("bottom") = {1};
Physical Curve("inside") = {4};
Physical Surface("hub") = {1};
"""
SHAFT_GEO = """Point(1) = {10, 0, 0};
Point(2) = {19.9525, 0, 0};
Point(3) = {20.0025, 6, 0};
Point(4) = {10, 6, 0};
Point(5) = {20.0025, 1, 0};
Point(6) = {10, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 5};
Line(3) = {5, 3};
Line(4) = {3, 4};
Line(5) = {4, 6};
Line(6) = {6, 1};
Line(7) = {6, 5};
Curve Loop(1) = {1, 2, -7, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {7, 3, 4, 5};
Plane Surface(2) = {2};
Transfinite Curve{1, 4, 7} = 3;
Transfinite Curve{2, 6} = 2;
Transfinite Curve{3, 5} = 6;
Transfinite Surface{1, 2};
Recombine Surface{1, 2};
Physical Curve("outside") = {2, 3};
Physical Curve("top") = {4};
Physical Surface("shaft") = {1, 2};
"""
PRESS_FIT = """[mesh]
plane = "axisymmetric"
[part.shaft]
file = "shaft.geo"
move = [0.0, 6.0]
[part.hub]
file = "hub.geo"
[[material]]
group = "all"
density = 1e-6
young = 2e5
poisson = 0.3
damping = { stiffness = 2e-5 }
[[contact]]
group = "shaft.outside"
against = "hub.inside"
friction = 0.1
sliding = "large"
multipliers_on = "group"
[[support]]
group = "hub.bottom"
components = ["y"]
[[support]]
group = "shaft.top"
components = ["y"]
value = "-4*(t<T ? (t/T)^3*(10 - 15*t/T + 6*(t/T)^2) : 1)"
parameters = { T = 0.03 }
[[probe]]
name = "fit"
contact = 0
[time]
step = 4e-5
end = 0.031
[output]
fields_every = 0
"""


def material(group, law="neo-hookean", young=1000.0):
    return f'[[material]]\ngroup = "{group}"\ndensity = 1.0\nyoung = {young}\npoisson = 0.3\nlaw = "{law}"\n'


class Sliding(TestCase):
    def history(self, text, name="case.toml"):
        """Runs to rounding: iterations leave unsettled gaps, and the work of changing facets, of the size of their tolerance."""
        return History(self.simulate(self.write(name, text), values={"solver.newton_tolerance": 1e-13}) / "history.csv")

    def closes(self, history):
        """Checks that the account closes, without energy from contact or from facets that change."""
        largest = history.largest_energy()
        self.assertGreater(max(history["active_contacts"]), 0)
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-10 * largest)
        self.assertLess(max(history["contact_work"]), 1e-12 * largest)
        self.assertLess(max(map(abs, history["re_pairing_work"])), 1e-11 * largest)
        self.assertLess(max(history["unsettled_gap"]), 1e-11)

    def keeps(self, history, angular=True):
        names = [name for name in history.names if name.startswith("momentum_")]
        names += [name for name in history.names if angular and name.startswith("angular_momentum")]
        size = max(abs(value) for name in names for value in history[name])
        for name in names:
            self.assertLess(numpy.ptp(history[name]), 1e-11 * size, name)


class Bowl(Sliding):
    """A stiff block slides from rest down an elastic bowl: one degree of freedom, in closed form."""

    START, BLOCK = -0.6, BlockInBowl(BOWL, HALF, THICK)

    def case(self, *, size=0.06, friction=0.0, law="neo-hookean", step=0.004, end=1.2, gravity=10.0, more=""):
        (self.folder / "bowl.geo").write_text(BOWL_GEO.format(bowl=BOWL, size=size))
        (self.folder / "block.geo").write_text(BLOCK_GEO.format(left=-HALF, right=HALF, height=THICK, size=0.1))
        place = self.BLOCK.place(self.START)
        turn = place[2]
        corner = (place[0] + 0.5 * THICK * math.sin(turn), place[1] - 0.5 * THICK * math.cos(turn) + 1e-4)
        return (f'[part.bowl]\nfile = "bowl.geo"\n[part.block]\nfile = "block.geo"\n'
                f'turn = {{ angle = {math.degrees(turn)} }}\nmove = [{corner[0]}, {corner[1]}]\n'
                + material("bowl.bowl", law, 2e4) + material("block.block", law, 2e4)
                + '[[support]]\ngroup = "bowl.foot"\ncomponents = ["x", "y"]\n'
                f'[[contact]]\ngroup = "block.base"\nagainst = "bowl.top"\nsliding = "large"\nfriction = {friction}\n'
                f'[load]\ngravity = [0.0, {-gravity}]\n[mass]\ntype = "equivalent"\n'
                f'[time]\nstep = {step}\nend = {end}\n' + more)

    def test_the_block_has_the_speed_of_a_rigid_one_at_the_bottom(self):
        history = self.history(self.case())
        self.closes(history)
        mass = 2.0 * HALF * THICK
        velocity = max(abs(p) / mass for p in history["momentum.block_x"])
        fall = self.BLOCK.place(self.START)[1] - self.BLOCK.place(0.0)[1]
        rate = self.BLOCK.rate(0.0)
        expected = math.sqrt(2.0 * 10.0 * fall / self.BLOCK.inertia(rate)) * abs(rate[0])
        self.assertAlmostEqual(velocity, expected, delta=0.01 * expected)

    def test_friction_stops_it(self):
        history = self.history(self.case(friction=0.6, end=0.6))
        self.closes(history)
        self.assertLess(max(history["friction_work"]), 1e-12)
        self.assertLess(max(abs(p) for p in history["momentum.block_x"][-20:]), 2e-3)

    def test_linear_bodies_have_an_account_too(self):
        self.closes(self.history(self.case(law="linear", end=0.5)))

    def test_a_run_that_is_resumed_goes_on_with_the_same_bits(self):
        text = self.case(friction=0.2, end=0.4)
        whole = self.simulate(self.write("whole.toml", text))
        part = self.write("part.toml", text)
        folder = self.folder / "part"
        self.expect_status(0, run("run", part, "-o", folder, "--quiet", "--set", "time.end=0.24", "--set", "output.checkpoint_every=7"))
        self.expect_status(0, run("run", part, "-o", folder, "--quiet", "--resume", "--set", "time.end=0.4",
                                  "--set", "output.checkpoint_every=7"))
        self.assertEqual((whole / "history.csv").read_text(), (folder / "history.csv").read_text())


class FreeBodies(Sliding):
    """Two free bodies."""

    def in_plane(self, law, **more):
        (self.folder / "bowl.geo").write_text(BOWL_GEO.format(bowl=-0.15, size=0.09))
        (self.folder / "block.geo").write_text(BLOCK_GEO.format(left=-0.25, right=0.25, height=0.3, size=0.08))
        return ('[part.hump]\nfile = "bowl.geo"\n[part.block]\nfile = "block.geo"\nmove = [-0.5, 0.04]\n'
                'velocity = [2.0, -1.0]\n' + material("all", law)
                + '[[contact]]\ngroup = "block.skin"\nagainst = "hump.top"\nsliding = "large"\nfriction = 0.2\n'
                '[mass]\ntype = "equivalent"\n[time]\nstep = 0.002\nend = 0.4\n')

    def test_momenta_in_the_plane(self):
        history = self.history(self.in_plane("neo-hookean"))
        self.closes(history)
        self.keeps(history)

    def test_momentum_of_linear_bodies(self):
        history = self.history(self.in_plane("linear"))
        self.closes(history)
        self.keeps(history, angular=False)

    def test_momenta_in_space(self):
        (self.folder / "slab.geo").write_text(BOX_GEO.format(lengths="1.2, 0.8, 0.3", size=0.2))
        (self.folder / "brick.geo").write_text(BOX_GEO.format(lengths="0.4, 0.3, 0.3", size=0.15))
        history = self.history(
            '[part.slab]\nfile = "slab.geo"\n[part.brick]\nfile = "brick.geo"\nmove = [0.1, 0.2, 0.34]\n'
            'turn = { angle = 5.0, axis = [1, 1, 0] }\nvelocity = [2.0, 0.4, -1.0]\n' + material("all")
            + '[[contact]]\ngroup = "brick.base"\nagainst = "slab.top"\nsliding = "large"\nfriction = 0.2\n'
            '[mass]\ntype = "equivalent"\n[time]\nstep = 0.002\nend = 0.1\n')
        self.closes(history)
        self.keeps(history)


class Ends(Sliding):
    """A block slides off a table, tips over its edge and falls."""

    def test_over_the_edge(self):
        (self.folder / "table.geo").write_text(BLOCK_GEO.format(left=-1.0, right=0.0, height=0.3, size=0.08)
                                               + 'Physical Curve("top") = {3};\n')
        text = (self.folder / "table.geo").read_text().replace('Physical Curve("skin") = {1, 2, 3, 4};\n', "")
        (self.folder / "table.geo").write_text(text.replace('"block"', '"table"'))
        (self.folder / "block.geo").write_text(BLOCK_GEO.format(left=-0.5, right=-0.1, height=0.2, size=0.07))
        case = self.write("edge.toml", '[part.table]\nfile = "table.geo"\n[part.block]\nfile = "block.geo"\nmove = [0.0, 0.3]\n'
                          'velocity = [0.9, 0.0]\n' + material("all", young=5000.0)
                          + '[[support]]\ngroup = "table.base"\ncomponents = ["x", "y"]\n'
                          '[[contact]]\ngroup = "block.skin"\nagainst = "table.top"\nsliding = "large"\n'
                          '[load]\ngravity = [0.0, -10.0]\n[mass]\ntype = "equivalent"\n[time]\nstep = 0.002\nend = 0.7\n')
        folder = self.simulate(case)
        history = History(folder / "history.csv")
        largest = history.largest_energy()
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-11 * largest)
        self.assertLess(max(history["contact_work"]), 1e-10 * largest)
        self.assertEqual(history["active_contacts"][-1], 0)
        self.assertLess(history["momentum.block_y"][-1], -0.08)  # it falls
        self.assertLess(history["angular_momentum_z"][-1], 0.0)  # and tips forwards


class Refusals(Sliding):
    def case(self, more="", against="slab.top"):
        (self.folder / "slab.geo").write_text(BLOCK_GEO.format(left=-1.0, right=1.0, height=0.3, size=0.2)
                                              + 'Physical Curve("top") = {3};\n')
        text = (self.folder / "slab.geo").read_text().replace('Physical Curve("skin") = {1, 2, 3, 4};\n', "")
        (self.folder / "slab.geo").write_text(text.replace('"block"', '"slab"'))
        (self.folder / "block.geo").write_text(BLOCK_GEO.format(left=-0.5, right=-0.1, height=0.2, size=0.1))
        return ('[part.slab]\nfile = "slab.geo"\n[part.other]\nfile = "slab.geo"\nmove = [3.0, 0.0]\n'
                '[part.block]\nfile = "block.geo"\nmove = [0.0, 0.31]\n' + material("all")
                + f'[[contact]]\ngroup = "block.base"\nagainst = {against}\nsliding = "large"\n{more}'
                '[mass]\ntype = "equivalent"\n[time]\nstep = 0.002\nend = 0.01\n')

    def refuses(self, text, *words):
        process = self.expect_status(2, run("run", self.write("refused.toml", text), "-o", self.folder / "refused", "--quiet"))
        for word in words:
            self.assertIn(word, process.stderr)

    def test_what_does_not_go_with_it(self):
        self.refuses(self.case('multipliers = "dual"\n', '"slab.top"'), "dual", "p1")
        self.refuses(self.case("pair_at = [0.0, -0.01]\n", '"slab.top"'), "pair_at")
        self.refuses(self.case(against='["slab.top", "other.top"]'), "2 bodies", "a separate contact for each")
        tied = self.case(against='"slab.top"') + '[[contact]]\ngroup = "slab.top"\nagainst = "other.top"\ntied = true\n'
        self.assertNotEqual(run("run", self.write("tied.toml", tied), "-o", self.folder / "tied", "--quiet").returncode, 0)

    def test_a_rim_leaves_no_overlap_at_any_step(self):
        """A shaft pressed into a hub: nodes pass the hub's rim one after the other, and friction moves the rim."""
        (self.folder / "hub.geo").write_text(HUB_GEO)
        (self.folder / "shaft.geo").write_text(SHAFT_GEO)
        case = self.write("fit.toml", PRESS_FIT)
        forces = []
        for step in (8e-5, 4e-5, 1e-5, 8e-6, 7e-6, 6e-6):
            folder = self.simulate(case, values={"time.step": step}, options=("--quiet", "--force"))
            history, found = History(folder / "history.csv"), summary_of(folder)
            forces.append(history["fit.force_y"][-1])
            self.assertEqual(found["unsettled_contacts"], [])
            self.assertLess(max(history["unsettled_gap"]), 1e-9)
            self.assertLess(max(history["contact_work"]), 1e-10 * history.largest_energy())
            self.assertFalse([text for text in found["warnings"] if "frozen" in text], found["warnings"])
        self.assertLess(numpy.ptp(forces), 0.01 * min(forces))
