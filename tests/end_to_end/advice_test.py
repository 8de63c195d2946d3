"""`ricochet info` on meshes and cases: sizes, places, times, and a step to begin with."""

import math
import re
import unittest

from harness import MESHES, TestCase, block_case, run


class Advice(TestCase):
    def said(self, *arguments):
        return self.expect_status(0, run("info", *arguments)).stdout

    def test_groups_have_a_size_and_a_place(self):
        """The parallelogram with the bottom from (0.1, 0.2) to (1.3, 0.1), of which the length and the normal are known."""
        line = re.search(r'group "bottom": .*', self.said(MESHES / "quadrilateral_o1_msh41_ascii.msh"))[0]
        length = math.hypot(1.2, 0.1)
        self.assertIn(f"length {length:.5g}, centre (0.7, 0.15), from (0.1, 0.1) to (1.3, 0.2)", line)
        self.assertIn(f"flat, normal ({-0.1 / length:.4g}, {-1.2 / length:.4g})", line)

    def test_a_case_is_advised(self):
        text = self.said(self.write("case.toml", block_case()))
        fast, slow = math.sqrt(200.0), math.sqrt(50.0)
        self.assertIn(f"compression waves {fast:.5g}, shear waves {slow:.5g}", text)
        # A fall through 0.1 at 10.
        self.assertIn(f'"bottom" is 0.1 away from "floor" at its nearest node and meets it at t = '
                      f"{math.sqrt(2 * 0.1 / 10):.4g}", text)
        smallest, median, largest = map(float, re.search(
            r"heights of cells: smallest ([^,]+), median ([^,]+), largest (\S+)", text).groups())
        self.assertLessEqual(smallest, median)
        self.assertLessEqual(median, largest)
        step = float(re.search(r"suggested step (\S+):", text)[1])
        self.assertLessEqual(step, median / fast * 1.001)
        self.assertGreater(step, 0.9 * median / fast)
        area = float(re.search(r"area ([^,]+), mass", text)[1])
        self.assertIn(f"body 0: mass {area:.6g} per unit of thickness", text)

    def test_one_that_flies_away_meets_nothing(self):
        text = self.said(self.write("case.toml", block_case().replace("gravity = [0.0, -10.0]", "gravity = [0.0, 10.0]")))
        self.assertIn("and does not come nearer", text)


if __name__ == "__main__":
    unittest.main()
