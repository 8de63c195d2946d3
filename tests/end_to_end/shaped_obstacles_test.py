"""Obstacles of any shape that move as a case prescribes: the same surface in several ways, the account, and
refusals."""

import math
import re

import numpy

from harness import SOURCE, History, TestCase, body_case, gravity, initial_velocity, run, summary_of, with_more

BOWL = SOURCE / "cases" / "bowl" / "bowl.toml"
FLOOR = 'type = "plane"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]'


def box_stl(low, high, turned=()):
    """Returns the text of an STL of a block; triangles whose numbers are in `turned` are flipped."""
    text, number = "solid block\n", 0
    for axis in range(3):
        for at in (0, 1):
            corners = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                part = [0, 0, 0]
                part[axis], part[(axis + 1) % 3], part[(axis + 2) % 3] = at, u, v
                corners.append([a + p * (b - a) for a, b, p in zip(low, high, part)])
            if at == 0:
                corners.reverse()
            for triangle in (corners[:3], [corners[0], corners[2], corners[3]]):
                number += 1
                if number in turned:
                    triangle = triangle[::-1]
                text += "facet normal 0 0 0\nouter loop\n"
                text += "".join("vertex {:.17g} {:.17g} {:.17g}\n".format(*corner) for corner in triangle)
                text += "endloop\nendfacet\n"
    return text + "endsolid block\n"


def ball_stl(centre, radius, sectors):
    """Returns the text of an STL of a ball in `sectors` segments round and half as many from pole to pole; its corners
    are rounded to seven digits."""
    def corner(i, j):
        polar, round_ = math.pi * i / (sectors // 2), 2.0 * math.pi * j / sectors
        direction = (math.sin(polar) * math.cos(round_), math.sin(polar) * math.sin(round_), math.cos(polar))
        return [float(numpy.float32(c + radius * d)) for c, d in zip(centre, direction)]
    text = "solid ball\n"
    for i in range(sectors // 2):
        for j in range(sectors):
            square = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
            # At the poles two corners coincide.
            triangles = [square[:3]] * (i + 1 < sectors // 2) + [[square[0], square[2], square[3]]] * (i > 0)
            for triangle in triangles:
                text += "facet normal 0 0 0\nouter loop\n"
                text += "".join("vertex {:.9g} {:.9g} {:.9g}\n".format(*at) for at in triangle)
                text += "endloop\nendfacet\n"
    return text + "endsolid ball\n"


SQUARE = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1.0, 0.5};
Mesh.MeshSizeMax = 0.125;
Physical Surface("body") = {1};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3};
"""
CUBE = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1.0, 0.8, 0.6};
Mesh.MeshSizeMax = 0.22;
Physical Volume("body") = {1};
Physical Surface("bottom") = {5};
Physical Surface("top") = {6};
"""


def block_on(obstacle, folder, *, space, drive, friction=0.2, step=0.005, end=0.4, group="bottom"):
    """Returns a block of unit length, its base in the plane of zero height, and an obstacle, under the default
    scheme."""
    (folder / "block.geo").write_text(CUBE if space else SQUARE)
    up = [0.0, 0.0, 1.0] if space else [0.0, 1.0]
    text = body_case("block.geo", [0.0] * len(up), up, drive, scheme="reduced-kane", mass="equivalent", step=step, end=end,
                     bottom=group)
    text = text.replace(f'type = "plane"\npoint = {[0.0] * len(up)}\nnormal = {up}', obstacle)
    return text.replace('obstacle = "floor"', f'obstacle = "floor"\nfriction = {friction}')


class Blocks(TestCase):
    def in_space(self, obstacle):
        """Returns a block that falls obliquely."""
        return block_on(obstacle, self.folder, space=True,
                        drive=gravity(0.0, 0.0, -10.0) + initial_velocity(0.4, 0.1, -1.0))

    def in_plane(self, motion, **more):
        return block_on(f"{FLOOR}\n{motion}", self.folder, space=False, drive=gravity(0.0, -10.0), **more)


class SameSurface(Blocks):
    def histories(self, *texts):
        result = []
        for i, text in enumerate(texts):
            result.append(History(self.simulate(self.write(f"case{i}.toml", text), f"out{i}") / "history.csv"))
        return result

    def agree(self, one, other, names, relative):
        for name in names:
            a, b = numpy.array(one[name]), numpy.array(other[name])
            self.assertLess(abs(a - b).max(), relative * abs(a).max(), name)

    def test_a_plane(self):
        """A plane, an expression and a triangulated block agree to nine digits."""
        (self.folder / "floor.stl").write_text(box_stl([-5, -5, -2], [5, 5, -0.05]))
        plane, implicit, surface = self.histories(
            self.in_space('type = "plane"\npoint = [0.0, 0.0, -0.05]\nnormal = [0.0, 0.0, 1.0]'),
            self.in_space('type = "implicit"\nexpression = "3*(z + 0.05)"'),
            self.in_space('type = "surface"\nfile = "floor.stl"'))
        self.assertGreater(max(plane["contact_force_z"]), 1.0)
        for other in (implicit, surface):
            self.agree(plane, other, ("kinetic_energy", "momentum_x", "momentum_z", "friction_work"), 1e-9)

    def test_a_ball_of_triangles(self):
        """It approaches the sphere with the square of the triangles' size."""
        case = lambda obstacle: self.in_space(obstacle).replace("end = 0.4", "end = 0.15")
        texts = [case('type = "sphere"\ncentre = [0.5, 0.4, -1.05]\nradius = 1.0')]
        for sectors in (60, 120):
            (self.folder / f"ball{sectors}.stl").write_text(ball_stl((0.5, 0.4, -1.05), 1.0, sectors))
            texts.append(case(f'type = "surface"\nfile = "ball{sectors}.stl"'))
        exact, coarse, fine = self.histories(*texts)
        self.assertGreater(max(exact["contact_force_z"]), 1.0)
        off = [abs(numpy.array(exact["momentum_z"]) - other["momentum_z"]).max() / max(map(abs, exact["momentum_z"]))
               for other in (coarse, fine)]
        self.assertLess(off[1], 2e-3)
        self.assertGreater(off[0] / off[1], 2.5)

    def test_a_bowl(self):
        """A circle and an expression agree; polygons approach them with their number of sides."""
        text = with_more(BOWL, "").replace("end = 3.1", "end = 0.2")
        circle = 'type = "sphere"                     # a circle in two dimensions\ncentre = [0.0, 1.0]\nradius = 1.0\nside = "inside"'
        self.assertIn(circle, text)
        cases = [text, text.replace(circle, 'type = "implicit"\nexpression = "1 - x^2 - (y - 1)^2"')]
        for sides in (2000, 4000):
            name = f"polygon{sides}.txt"
            corners = [(math.sin(2 * math.pi * k / sides), 1 - math.cos(2 * math.pi * k / sides)) for k in range(sides)]
            (self.folder / name).write_text("".join(f"{x:.17g} {y:.17g}\n" for x, y in [*corners, corners[0]]))
            cases.append(text.replace(circle, f'type = "surface"\nfile = "{name}"\nside = "inside"'))
        exact, implicit, coarse, fine = self.histories(*cases)
        self.agree(exact, implicit, ("base.displacement_x", "kinetic_energy"), 1e-10)
        off = [abs(numpy.array(exact["base.displacement_x"]) - other["base.displacement_x"]).max()
               for other in (coarse, fine)]
        self.assertLess(off[1], 1e-5)
        self.assertGreater(off[0] / off[1], 2.0)

    def test_the_same_motion_in_three_ways(self):
        """A velocity, an expression and a table."""
        (self.folder / "motion.csv").write_text("t, x, y\n0, 0, 0\n1, 0.4, 0.25\n")
        texts = [self.in_plane(motion) for motion in ("velocity = [0.4, 0.25]", 'motion = ["0.4*t", "0.25*t"]', 'table = "motion.csv"')]
        one, two, three = self.histories(*texts)
        for other in (two, three):
            self.agree(one, other, ("kinetic_energy", "obstacle_work", "friction_work"), 1e-9)
        self.assertGreater(abs(one["obstacle_work"][-1]), 1e-3)


class Frames(Blocks):
    def test_edges_are_rounded_alike_in_every_frame(self):
        """A block and the triangulated floor below it, rotated together about the vertical axis: the default
        edge_radius is that of the facets, whose bounding boxes become smaller or larger."""
        radii = []
        for angle in (0.0, 17.0, 45.0):
            corners = "".join(
                "vertex {:.17g} {:.17g} {}\n".format(*(numpy.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
                                                      @ [float(x), float(y)]), z)
                if line.startswith("vertex") else line + "\n"
                for a in [math.radians(angle)]
                for line in box_stl([-5, -5, -2], [5, 5, -0.05]).splitlines()
                for word, x, y, z in [(line.split() + [0, 0, 0, 0])[:4]])
            (self.folder / "floor.stl").write_text(corners)
            text = self.in_space('type = "surface"\nfile = "floor.stl"').replace(
                "[[material]]", f"turn = {{ angle = {angle}, axis = [0.0, 0.0, 1.0] }}\n[[material]]", 1)
            text = text.replace("end = 0.4", "end = 0.005")
            process = self.expect_status(0, run("run", self.write("case.toml", text), "-o", self.folder / "out", "--force"))
            radii.append(re.search(r"its edges are rounded over a radius of (\S+)", process.stderr + process.stdout)[1])
        self.assertEqual(len(set(radii)), 1, radii)


class Motion(Blocks):
    def balanced(self, text, name="case"):
        results = self.simulate(self.write(f"{name}.toml", text), name)
        history = History(results / "history.csv")
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-11 * history.largest_energy())
        self.assertLess(max(history["max_penetration"]), 1e-12)
        return history

    def test_a_plane_that_tilts_throws_a_block(self):
        """Its work is the final energy of the block, with gravity and the losses of the method."""
        history = self.balanced(self.in_plane('rotation = "0.5*sin(6*t)"\nabout = [-1.0, 0.0]', friction=0.4))
        self.assertGreater(history["obstacle_work"][-1], 0.1)
        works = sum(history[name][-1] for name in ("obstacle_work", "friction_work", "contact_work"))
        self.assertAlmostEqual(history["total_energy"][-1] - history["total_energy"][0],
                               works - history["numerical_dissipation"][-1], delta=1e-11 * history.largest_energy())
        # A lasting frictionless contact does no work, only its onset does: it never gives energy.
        self.assertLess(history["contact_work"][-1], 1e-12)

    def test_rollers_carry_a_block(self):
        """Three circles that rotate under a block: friction on surfaces that stay in place."""
        rollers = "".join(f'[obstacle.roller{k}]\ntype = "sphere"\ncentre = [{0.1 + 0.4 * k}, -0.2]\nradius = 0.2\n'
                          f"rotation_rate = -4.0\n[[contact]]\ngroup = \"bottom\"\nobstacle = \"roller{k}\"\nfriction = 0.5\n"
                          for k in range(3))
        text = self.in_plane("").replace(f'[obstacle.floor]\n{FLOOR}\n', "")
        before, after = text.split('\n[[contact]]')[0], text.split("friction = 0.2\n")[1]
        history = self.balanced(f"{before}\n{rollers}{after}")
        self.assertGreater(history["momentum_x"][-1], 0.05)
        self.assertGreater(history["obstacle_work"][-1], 0.0)


class Passages(Blocks):
    """A thin plate through which a body would pass within a step: no end of a step shows it."""

    def outcome(self, step, top, group="bottom"):
        (self.folder / "plate.txt").write_text(f"-3 -0.4\n4 -0.4\n4 {top}\n-3 {top}\n-3 -0.4\n")
        text = block_on('type = "surface"\nfile = "plate.txt"\nedge_radius = 0.002', self.folder, space=False,
                        drive=initial_velocity(0.0, -2.0), step=step, end=0.5, group=group)
        output = self.folder / f"out{step}"
        process = run("run", self.write("case.toml", text), "-o", output, "--force")
        self.assertEqual(process.returncode, 0, process.stderr)
        return process, summary_of(output)["unwatched_penetration"]

    def test_a_long_step_is_taken_in_parts(self):
        process, found = self.outcome(0.07, -0.39)
        self.assertIn("is computed in parts, since a node went through an obstacle", process.stderr)
        self.assertNotIn("in parts as short as", process.stderr)
        self.assertNotIn("gone through", process.stderr)
        self.assertEqual(found["found"], [])
        history = History(self.folder / "out0.07" / "history.csv")
        self.assertGreater(max(history["contact_force_y"]), 0.0)
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-11 * history.largest_energy())

    def test_nodes_beside_the_contact_go_through_and_are_told(self):
        process, found = self.outcome(0.07, -0.39, group="top")
        self.assertIn('has gone through obstacle "floor" within one step', process.stderr)
        self.assertIn("PASSED THROUGH WITHIN ONE STEP", process.stdout)
        self.assertEqual([entry["passed_through"] for entry in found["found"]], [True])

    def test_short_ones_do_not(self):
        process, found = self.outcome(0.002, -0.39)
        self.assertNotIn("gone through", process.stderr)
        self.assertEqual(found["found"], [])


class Refusals(Blocks):
    def refuse(self, text, *fragments):
        process = run("run", self.write("case.toml", text), "-o", self.folder / "out", "--force")
        self.assertEqual(process.returncode, 2, process.stderr)
        for fragment in fragments:
            self.assertIn(fragment, process.stderr)

    def test_surfaces(self):
        surface = 'type = "surface"\nfile = "a.stl"'
        (self.folder / "a.stl").write_text(box_stl([0, 0, 0], [1, 1, 1], turned={7}))
        self.refuse(self.in_space(surface), "a.stl: triangle", "opposite orientations", "case.toml:")
        opened = box_stl([0, 0, 0], [1, 1, 1]).split("facet normal")
        (self.folder / "a.stl").write_text("facet normal".join(opened[:4] + opened[5:]))
        self.refuse(self.in_space(surface + '\nside = "inside"'), "it is not closed: 3 of its edges")
        process = run("run", self.write("case.toml", self.in_space(surface.replace("a.stl", "b.stl"))), "-o", self.folder / "out")
        self.assertEqual(process.returncode, 4, process.stderr)
        self.assertIn("cannot read the surface", process.stderr)
        (self.folder / "a.txt").write_text("0 0\n1 0\n")
        self.refuse(self.in_space(surface.replace("a.stl", "a.txt")), "has dimension 2, but the mesh has dimension 3")

    def test_expressions(self):
        self.refuse(self.in_space('type = "implicit"\nexpression = "z + q"'), 'unknown name "q"', "case.toml:10:")
        self.refuse(self.in_space('type = "implicit"\nexpression = "z + t"'), "depends on t")
        self.refuse(self.in_space('type = "implicit"\nexpression = "(z + 0.05)^2"'), "vanishes at (")

    def test_motions(self):
        with_motion = self.in_plane
        self.refuse(with_motion('velocity = [1, 0]\nmotion = ["t", "0"]'), 'the obstacle already has "velocity"')
        self.refuse(with_motion('rotation = ["0", "0", "t"]'), "case.toml:")
        self.refuse(with_motion("about = [0, 0]"), "set \"rotation\"")
        (self.folder / "m.csv").write_text("0 0 0\n0 1 1\n")
        self.refuse(with_motion('table = "m.csv"'), "m.csv:2: the time 0 is not after 0")
        for first in ("0.0 0.0m 0.0", "0 nan 0"):  # no header: letters would make one
            (self.folder / "m.csv").write_text(f"{first}\n1 1 1\n")
            self.refuse(with_motion('table = "m.csv"'), "m.csv:1:", f'"{first.split()[1]}" is not a finite number')
        (self.folder / "m.csv").write_text("t, ux, uy, uz\n0 0 0 0\n1 1 1 0.5\n")
        self.refuse(with_motion('table = "m.csv"'), 'm.csv:1: the fourth column is called "uz"')
        self.refuse(with_motion("spin = 1.0"), 'set its "mass" or "density", too')
