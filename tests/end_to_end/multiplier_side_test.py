"""The side of two sliding bodies that carries the multipliers: a round stamp is pressed on the flat and smaller top of
a block and slides without friction. No force then acts along the flat side, for any meshes."""

import re

from harness import History, TestCase, run

BLOCK = """SetFactory("OpenCASCADE");
Rectangle(1) = {{-1.3, -2, 0, 1.9, 2}};
MeshSize{{1, 2}} = 0.5;
MeshSize{{3, 4}} = {size};
Physical Surface("block") = {{1}};
Physical Curve("foot") = {{1}};
Physical Curve("top") = {{3}};
"""
STAMP = """SetFactory("OpenCASCADE");
Point(1) = {{-1.5, 1, 0}}; Point(2) = {{-0.5, 0, 0}}; Point(3) = {{0.5, 1, 0}}; Point(4) = {{-0.5, 1, 0}};
Point(5) = {{0.5, 1.5, 0}}; Point(6) = {{-1.5, 1.5, 0}};
Circle(1) = {{1, 4, 2}}; Circle(2) = {{2, 4, 3}}; Line(3) = {{3, 5}}; Line(4) = {{5, 6}}; Line(5) = {{6, 1}};
Curve Loop(1) = {{1, 2, 3, 4, 5}}; Plane Surface(1) = {{1}};
MeshSize{{1, 2, 3}} = {size};
MeshSize{{5, 6}} = 0.5;
Physical Surface("stamp") = {{1}};
Physical Curve("tip") = {{1, 2}};
Physical Curve("back") = {{4}};
"""
PRESS = 10


def case(more=""):
    """Quasi-static: damping is large and inertia almost zero."""
    body = 'density = 1e-9\nyoung = 1000.0\npoisson = 0.3\ndamping = { mass = 1e4 }\n'
    return f"""[part.block]
file = "block.geo"
[part.stamp]
file = "stamp.geo"
[[material]]
group = "all"
{body}[[support]]
group = "block.foot"
components = ["x", "y"]
[[support]]
group = "stamp.back"
components = ["y"]
value = "-0.004*min(t, {PRESS})"
[[support]]
group = "stamp.back"
components = ["x"]
value = "0.05*max(t - {PRESS}, 0)"
[[contact]]
group = "stamp.tip"
against = "block.top"
sliding = "large"
{more}
[time]
step = 1.0
end = {PRESS + 8}
[[probe]]
name = "push"
boundary = "stamp.back"
"""


class Sides(TestCase):
    def slide(self, flat, round_, more="", degree=1):
        """Returns the messages of the run, the mean normal force and the largest force along the flat side, relative to
        it."""
        (self.folder / "block.geo").write_text(BLOCK.format(size=flat))
        (self.folder / "stamp.geo").write_text(STAMP.format(size=round_))
        output = self.folder / "out"
        process = self.expect_status(0, run("run", self.write("case.toml", f"[mesh]\ndegree = {degree}\n" + case(more)), "-o", output, "--force"))
        history = History(output / "history.csv")
        along, across = history["push.force_x"][PRESS:], history["push.force_y"][PRESS:]
        force = -sum(across) / len(across)
        return process.stdout + process.stderr, force, max(map(abs, along)) / force

    def test_the_round_side_carries_the_multipliers(self):
        text, force, along = self.slide(0.16, 0.2)
        self.assertIn('group "stamp.tip" carries the multipliers: normals vary less within its facets', text)
        self.assertNotIn("normals vary by", text)
        self.assertLess(along, 0.01)
        # The other side has forces along the mean normals of the round one, and the run warns of it. Its advice is to
        # leave the choice to the program, as in the run above.
        text, _, along_of_other = self.slide(0.16, 0.2, 'multipliers_on = "against"')
        self.assertGreater(along_of_other, 3.0 * along)
        self.assertGreater(along_of_other, 0.03)
        self.assertRegex(text, 'may have a relative error of up to this size; leave multipliers_on out: with the multipliers on "stamp.tip" they vary by')

    def test_a_side_that_is_much_finer_carries_them(self):
        text, _, _ = self.slide(0.05, 0.2, degree=2)
        self.assertIn('group "block.top" carries the multipliers: normals vary less within its facets', text)

    def test_facets_as_fine_as_advised_are_fine_enough(self):
        """The force is compared with that on a mesh of size 0.03."""
        refined = 10.4
        text, coarse, _ = self.slide(0.2, 0.4)
        self.assertGreater(abs(coarse / refined - 1.0), 0.2)
        advised = re.search(r'normals vary by (\S+) rad .*; use facets of "stamp.tip" (\S+) times as large', text)
        self.assertIsNotNone(advised, text)
        self.assertAlmostEqual(float(advised[1]), 0.4, delta=0.04)
        self.assertIn('a run with multipliers_on = "against" shows by how much forces differ', text)
        size = 0.4 * float(advised[2])
        text, force, along = self.slide(0.2, size)
        self.assertNotIn("normals vary by", text)
        self.assertLess(abs(force / refined - 1.0), 0.06)
        self.assertLess(along, 0.01)
        # Both sides agree within the accuracy that the advice states.
        _, other, _ = self.slide(0.2, size, 'multipliers_on = "against"')
        self.assertLess(abs(force / other - 1.0), 0.1)
