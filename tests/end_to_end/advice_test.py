"""`ricochet info` and `validate` on meshes and cases: sizes, positions, times, a suggested step, and items that were
not checked."""

import math
import os
import re

import meshio
import numpy

from harness import MESHES, TestCase, block_case, run


class Advice(TestCase):
    def said(self, *arguments):
        return self.expect_status(0, run("info", *arguments)).stdout

    def test_groups_have_a_size_and_a_place(self):
        """The parallelogram with the bottom from (0.1, 0.2) to (1.3, 0.1), whose length and normal are known."""
        line = re.search(r'group "bottom": .*', self.said(MESHES / "quadrilateral_o1_msh41_ascii.msh"))[0]
        length = math.hypot(1.2, 0.1)
        self.assertIn(f"length {length:.5g}, centre (0.7, 0.15), from (0.1, 0.1) to (1.3, 0.2)", line)
        self.assertIn(f"flat, normal ({-0.1 / length:.4g}, {-1.2 / length:.4g})", line)

    def test_the_built_in_groups_are_listed(self):
        """All cells have the area of the whole, and the boundary closes: it is the sum over its groups."""
        text = self.said(MESHES / "quadrilateral_o1_msh41_ascii.msh")
        def measure(name):
            return float(re.search(rf'group "{name}": .*?, (?:area|length) ([^,]+),', text)[1])
        self.assertEqual(measure("all"), measure("body"))
        line = re.search(r'group "boundary": .*', text)[0]
        self.assertTrue(line.endswith(", closed"), line)
        points = meshio.read(MESHES / "quadrilateral_o1_msh41_ascii.msh").points[:, :2]
        corners = [points[numpy.argmin(points @ direction)] for direction in ((1, 0.01), (-0.01, 1), (-1, -0.01), (0.01, -1))]
        around = sum(math.dist(a, b) for a, b in zip(corners, corners[1:] + corners[:1]))
        self.assertAlmostEqual(measure("boundary"), around, delta=1e-4 * around)
        # A case lists them as well.
        case = self.said(self.write("case.toml", block_case()))
        self.assertIn('group "all": ', case)
        self.assertIn('group "boundary": ', case)

    def test_settings_change_what_is_described(self):
        case = self.write("case.toml", block_case())
        text = self.said(case, "--set", "mesh.refine=2", "--set", "time.end=0.5")
        self.assertIn(", its cells refined 2 times (displacement of degree 1)", text)
        self.assertIn("to 0.5\n", text)
        self.assertIn('group "body": 96 cells', text)
        self.assertIn("--set changes a case file", self.expect_status(1, run("info", MESHES, "--set", "a=1")).stderr)
        self.assertIn("at most 8", self.expect_status(2, run("info", case, "--set", "mesh.refine=16")).stderr)

    def test_where_the_mesh_came_to_lie(self):
        placement = "turn = { angle = 30.0, about = [0.1, 0.2] }\nmove = [2.0, 0.5]\n[[material]]"
        case = self.write("case.toml", block_case().replace("[[material]]", placement, 1))
        points = meshio.read(MESHES / "quadrilateral_o1_msh41_ascii.msh").points[:, :2]
        angle = math.radians(30.0)
        turn = numpy.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
        placed = (points - [0.1, 0.2]) @ turn.T + [0.1, 0.2] + [2.0, 0.5]
        lowest, highest = placed.min(axis=0), placed.max(axis=0)
        nearest = placed[placed[:, 1].argmin()]
        wanted = [*lowest, *highest, nearest[1], *nearest]
        for command in ("info", "validate"):
            text = self.expect_status(0, run(command, case)).stdout
            number = r"(\S+?)"
            found = re.search(rf"the mesh extends from \({number}, {number}\) to \({number}, {number}\), rotated by 30°, moved\n"
                              rf'  at the start the mesh is {number} away from obstacle "floor", nearest at \({number}, {number}\)\n', text)
            self.assertIsNotNone(found, text)
            for value, exact in zip(map(float, found.groups()), wanted):
                self.assertAlmostEqual(value, exact, delta=1e-3 * abs(exact))
        for gap, said in ((0.0, "touches"), (-0.05, "is 0.05 inside")):
            low = self.write("low.toml", block_case().replace("[[material]]", f"move = [0.0, {gap - 0.1}]\n[[material]]", 1))
            self.assertIn(f'at the start the mesh {said} obstacle "floor"', self.said(low))

    def test_a_geometry_is_meshed_when_asked_for(self):
        """Until then, checks that need the mesh are reported as omitted; afterwards the mesh exists and is checked."""
        cache = self.folder / "cache"
        environment = dict(os.environ, RICOCHET_CACHE=str(cache))
        for name in ("quadrilateral.geo", "box.step"):
            with self.subTest(name):
                sized = block_case(name).replace("[[material]]", "size = 0.4\n[[material]]", 1)
                if name == "box.step":
                    sized = (sized.replace("point = [0.0, 0.0]", "point = [0.0, 0.0, -9.0]").replace("[0.0, 1.0]", "[0.0, 0.0, 1.0]")
                             .replace("[0.0, -10.0]", "[0.0, 0.0, -10.0]").replace("[1.3, 0.1]", "[0.0, 0.0, 0.0]")
                             .replace('"bottom"', '"boundary"'))
                case = self.write("case.toml", sized)
                wrong = self.write("wrong.toml", sized.replace('group = "body"', 'group = "bodi"'))

                def validate(*arguments, status=0):
                    return self.expect_status(status, run("validate", *arguments, environment=environment))

                before = validate(wrong).stdout
                self.assertIn(f"valid, as far as can be checked without a mesh of {MESHES / name}", before)
                self.assertIn("not checked, because it requires the mesh: names of groups", before)
                self.assertIn(f"`ricochet validate {wrong} --mesh`", before)
                self.assertEqual(list(cache.glob(f"{(MESHES / name).stem}-*.msh")), [])
                self.assertIn("bodi", validate(wrong, "--mesh", status=2).stderr)
                # From now on nothing must be meshed.
                self.assertIn("bodi", validate(wrong, status=2).stderr)
                after = validate(case).stdout
                self.assertRegex(after, r"valid: \d+ nodes")
                self.assertNotIn("not checked", after)
                self.assertIn('group "body": ', self.expect_status(0, run("info", case, environment=environment)).stdout)
                # A mesh of another size is a different mesh.
                self.assertIn("not checked", validate(case, "--set", "mesh.size=0.3").stdout)
        described = self.expect_status(0, run("info", MESHES / "quadrilateral.geo", environment=environment)).stdout
        self.assertIn("validate CASE.toml --mesh", described)

    def test_a_case_is_advised(self):
        text = self.said(self.write("case.toml", block_case()))
        fast, slow = math.sqrt(200.0), math.sqrt(50.0)
        self.assertIn(f"speed of compression waves {fast:.5g}, of shear waves {slow:.5g}", text)
        # A fall through 0.1 at 10.
        self.assertIn(f'"bottom" is 0.1 away from "floor" at its nearest node and would reach it at t = '
                      f"{math.sqrt(2 * 0.1 / 10):.4g}", text)
        smallest, median, largest = map(float, re.search(
            r"heights of cells: smallest ([^,]+), median ([^,]+), largest (\S+)", text).groups())
        self.assertLessEqual(smallest, median)
        self.assertLessEqual(median, largest)
        step = float(re.search(r"suggested step (\S+):", text)[1])
        self.assertLessEqual(step, median / fast * 1.001)
        self.assertGreater(step, 0.9 * median / fast)
        area = float(re.search(r"area ([^,]+), mass", text)[1])
        self.assertIn(f"the body: mass {area:.6g} per unit of thickness", text)

    def test_one_that_flies_away_meets_nothing(self):
        text = self.said(self.write("case.toml", block_case().replace("gravity = [0.0, -10.0]", "gravity = [0.0, 10.0]")))
        self.assertIn("and does not approach it", text)

    def test_an_obstacle_that_comes(self):
        """The body rests 0.1 above a plane that rises by 0.4 t² and meets it at t = 0.5; a sinking plane never meets
        it."""
        rests = block_case().replace("gravity = [0.0, -10.0]", "gravity = [0.0, 0.0]").replace("end = 0.3", "end = 1.0")
        for motion, said in (("0.4*t^2", "and would reach it at t = 0.5 (the run ends at 1)"),
                             ("-0.4*t^2", "and does not reach it by the end of the run"),
                             # It first moves away: its initial velocity implies nothing.
                             ("0.4*(2*t)^2-0.3*sin(pi*t)^2*(t<0.25)", "and would reach it at t = 0.25 (the run ends at 1)")):
            moving = rests.replace("normal = [0.0, 1.0]", f'normal = [0.0, 1.0]\nmotion = ["0", "{motion}"]')
            self.assertIn(said, self.said(self.write("moving.toml", moving)))
        for angle in (0.5, -0.5):
            # About a point far to the left, the surface under the block rises at the rate times that distance.
            turning = rests.replace("normal = [0.0, 1.0]", f'normal = [0.0, 1.0]\nrotation = "{angle}*t"\nabout = [-2.0, 0.0]')
            said = self.said(self.write("turning.toml", turning))
            if angle < 0:
                self.assertIn("and does not reach it by the end of the run", said)
                continue
            found = float(re.search(r"would reach it at t = (\S+) ", said)[1])
            meets = min(math.atan2(y, x + 2.0) / angle for x, y in ((0.1, 0.2), (1.3, 0.1)))
            self.assertAlmostEqual(found, meets, delta=1e-3 * meets)
