"""A surface that touches itself: compared with the same surfaces as a pair; energy, momenta, resumed runs, refusals."""

import numpy

from harness import History, TestCase, run

# Two arms, joined at the left: the gap between them is 0.3.
CLAMP_GEO = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2.0, 1.0};
Rectangle(2) = {0.3, 0.35, 0, 1.7, 0.3};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
Mesh.MeshSizeMax = 0.12;
Mesh.MeshSizeMin = 0.12;
Physical Surface("body") = {3};
Physical Curve("skin") = Boundary{ Surface{3}; };
Physical Curve("lower") = Curve In BoundingBox{0.29, 0.34, -1, 2.01, 0.36, 1};
Physical Curve("upper") = Curve In BoundingBox{0.29, 0.64, -1, 2.01, 0.66, 1};
Physical Curve("inside") = {Curve In BoundingBox{0.29, 0.34, -1, 2.01, 0.36, 1}, Curve In BoundingBox{0.29, 0.64, -1, 2.01, 0.66, 1}};
"""
CLAMP_IN_SPACE_GEO = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 2.0, 1.0, 0.4};
Box(2) = {0.3, 0.35, 0, 1.7, 0.3, 0.4};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.MeshSizeMax = 0.2;
Mesh.MeshSizeMin = 0.2;
Physical Volume("body") = {3};
Physical Surface("inside") = {Surface In BoundingBox{0.29, 0.34, -1, 2.01, 0.36, 1}, Surface In BoundingBox{0.29, 0.64, -1, 2.01, 0.66, 1}};
"""
RING_GEO = """SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 1.0, 1.0};
Disk(2) = {0, 0, 0, 0.8, 0.8};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
Mesh.MeshSizeMax = 0.12;
Mesh.MeshSizeMin = 0.12;
Physical Surface("body") = {3};
Physical Curve("outside") = {1};
Physical Curve("inside") = {2};
"""


class SelfContact(TestCase):
    def history(self, text, name="case.toml"):
        return History(self.simulate(self.write(name, text), name.replace(".toml", "")) / "history.csv")

    def clamp(self, group="inside", against="inside", friction=0.2, end=0.24, more="", geo=CLAMP_GEO, law="neo-hookean"):
        """Returns a clamp whose arms swing together, touch, and part again."""
        (self.folder / "clamp.geo").write_text(geo)
        velocity = '"0", "4*(x-0.3)*(0.5-y)"' + (', "0"' if geo is CLAMP_IN_SPACE_GEO else "")
        return (f'[mesh]\nfile = "clamp.geo"\n[[material]]\ngroup = "body"\nlaw = "{law}"\ndensity = 1.0\nyoung = 300.0\n'
                f'poisson = 0.3\n[initial]\nvelocity = [{velocity}]\n'
                f'[[contact]]\ngroup = "{group}"\nagainst = "{against}"\nsliding = "large"\nfriction = {friction}\n'
                f'[[probe]]\nname = "tip"\nat = [2.0, 0.65{", 0.2" if geo is CLAMP_IN_SPACE_GEO else ""}]\n'
                f'[mass]\ntype = "equivalent"\n[time]\nstep = 2e-3\nend = {end}\n{more}')

    def closes(self, history):
        largest = history.largest_energy()
        self.assertGreater(max(history["active_contacts"]), 0)
        self.assertGreater(max(history["left_out_points"]), 0)
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-10 * largest)
        self.assertLess(max(history["contact_work"]), 1e-12 * largest)

    def keeps_momenta(self, history, angular=True):
        names = [name for name in history.names if name.startswith("momentum_")]
        names += [name for name in history.names if angular and name.startswith("angular_momentum")]
        size = sum(max(map(abs, history[name])) for name in names) + history.largest_energy()
        for name in names:
            self.assertLess(numpy.ptp(history[name]), 1e-11 * size, name)

    def test_arms_that_close_move_as_two_surfaces_do(self):
        itself, pair = self.history(self.clamp()), self.history(self.clamp("lower", "upper"), "pair.toml")
        self.closes(itself)
        self.keeps_momenta(itself)
        tip, other = numpy.array(itself["tip.displacement_y"]), numpy.array(pair["tip.displacement_y"])
        self.assertLess(max(abs(tip - other)), 0.03 * numpy.ptp(other))
        touches = [[time for time, count in zip(history["time"], history["active_contacts"]) if count > 0]
                   for history in (itself, pair)]
        for one, two in ((touches[0][0], touches[1][0]), (touches[0][-1], touches[1][-1])):
            self.assertAlmostEqual(one, two, delta=0.012)

    def test_in_space(self):
        history = self.history(self.clamp(geo=CLAMP_IN_SPACE_GEO, end=0.2))
        self.closes(history)
        self.keeps_momenta(history)

    def test_of_degree_two_and_of_facets(self):
        for multipliers in ("p1", "p0"):
            with self.subTest(multipliers):
                text = self.clamp(end=0.2).replace('friction = 0.2', f'friction = 0.2\nmultipliers = "{multipliers}"')
                text = text.replace('file = "clamp.geo"', 'file = "clamp.geo"\ndegree = 2').replace("2e-3", "4e-3")
                history = self.history(text, f"{multipliers}.toml")
                self.closes(history)
                # Facets as multipliers come and go as a whole: a step is frozen, whose forces have a moment.
                self.keeps_momenta(history, angular=multipliers == "p1")

    def test_a_ring_that_is_crushed(self):
        """Its inside meets itself while tools press and rub on its outside."""
        (self.folder / "ring.geo").write_text(RING_GEO)
        tool = lambda name, side, motion: (f'[obstacle.{name}]\ntype = "plane"\npoint = [0.0, {side}.0]\n'
                                           f'normal = [0.0, {-side}.0]\n{motion}'
                                           f'[[contact]]\ngroup = "outside"\nobstacle = "{name}"\nfriction = 0.5\n')
        history = self.history(
            '[mesh]\nfile = "ring.geo"\n[[material]]\ngroup = "body"\nlaw = "neo-hookean"\ndensity = 1.0\nyoung = 300.0\n'
            'poisson = 0.3\n' + tool("bottom", -1, "") + tool("top", 1, 'motion = ["0", "-1.57*sin(1.5*t)^2"]\n')
            + '[[contact]]\ngroup = "inside"\nagainst = "inside"\nsliding = "large"\nfriction = 0.2\n'
            '[mass]\ntype = "equivalent"\n[time]\nstep = 4e-3\nend = 1.2\n')
        self.closes(history)
        self.assertLess(max(history["max_penetration"]), 0.02)
        self.assertGreater(max(history["obstacle_work"]), 1.0)

    def test_a_run_that_is_resumed_goes_on_with_the_same_bits(self):
        text = self.clamp(end=0.16)
        whole = self.simulate(self.write("whole.toml", text))
        part, folder = self.write("part.toml", text), self.folder / "part"
        more = ("--quiet", "--set", "output.checkpoint_every=7")
        self.expect_status(0, run("run", part, "-o", folder, "--set", "time.end=0.1", *more))
        self.expect_status(0, run("run", part, "-o", folder, "--resume", "--set", "time.end=0.16", *more))
        history = History(whole / "history.csv")
        before = [count for time, count in zip(history["time"], history["active_contacts"]) if time <= 0.1]
        self.assertGreater(max(before), 0, "it is resumed after the first contact")
        self.assertEqual((whole / "history.csv").read_text(), (folder / "history.csv").read_text())

    def test_no_flight_closes_it(self):
        """The surface faces itself: no velocity of the whole body closes the gap."""
        (self.folder / "ring.geo").write_text(RING_GEO)
        case = self.write("ring.toml", '[mesh]\nfile = "ring.geo"\n[[material]]\ngroup = "body"\ndensity = 1.0\nyoung = 300.0\n'
                          'poisson = 0.3\n[[contact]]\ngroup = "inside"\nagainst = "inside"\nsliding = "large"\n'
                          "[initial]\nvelocity = [0.0, -20.0]\n[time]\nstep = 1e-3\nend = 10.0\n")
        said = self.expect_status(0, run("validate", case, "--mesh")).stdout
        line = next(line for line in said.splitlines() if line.startswith('  "inside" against "inside"'))
        self.assertNotRegex(line, r"\binf\b|meet|nearer")

    def test_it_needs_sliding_without_limit(self):
        text = self.clamp()
        result = self.expect_status(2, run("validate", self.write("small.toml", text.replace('sliding = "large"\n', ""))))
        self.assertIn('a surface can touch itself only with sliding = "large"', result.stderr)
        text = text.replace('sliding = "large"', 'sliding = "large"\nmultipliers_on = "group"')
        result = self.expect_status(2, run("validate", self.write("sides.toml", text)))
        self.assertIn("a surface that touches itself has no sides", result.stderr)
