"""What the program says of motions that the scheme, and of strains that small strain, cannot follow."""

import json
import unittest

from harness import TestCase, block_case, run

SUPPORT = '[[support]]\ngroup = "sides"\ncomponents = ["x"]\nvalue = "{}"\n'


class Warnings(TestCase):
    def warnings_of(self, text, **values):
        output = self.simulate(self.write("case.toml", text), values=values, options=("--quiet", "--force"))
        return json.loads((output / "summary.json").read_text(encoding="utf-8"))["warnings"]

    def test_supports_whose_velocity_jumps(self):
        ramp, smooth = "-0.01*min(t/0.1, 1)", "-0.005*(1-cos(pi*min(t/0.1, 1)))"
        for motion, scheme, jumps in ((ramp, "newmark", True), (smooth, "newmark", False), (ramp, "klr-conserving", False)):
            text = block_case() + SUPPORT.format(motion)
            if scheme != "newmark":
                text = text.replace('scheme = "newmark"\npreset = "trapezoidal"', f'scheme = "{scheme}"')
            text = text.replace("step = 0.01", "step = 0.002")
            told = [line for line in self.warnings_of(text) if "velocity of this support jumps" in line]
            self.assertEqual(len(told), 1 if jumps else 0, (motion, scheme, told))
            if jumps:
                line = text[:text.index("value = \"-0.01")].count("\n") + 1
                self.assertIn(f"case.toml:{line}:9", told[0])
                self.assertIn("jumps at t = 0.1.", told[0])
                self.assertIn("velocity of this support jumps", run("validate", self.folder / "case.toml").stderr)

    def test_strains_that_are_not_small(self):
        # A uniform strain e along y has the equivalent strain sqrt(2/3 e:e) = 2/3 e, the largest of the motion that it starts.
        for strain, told in ((0.30, "equivalent strain of 20 %"), (0.05, None)):
            text = block_case().replace("gravity = [0.0, -10.0]", "gravity = [0.0, 0.0]") + (
                f'[initial]\ndisplacement = ["0", "{strain}*y"]\n')
            found = [line for line in self.warnings_of(text, **{"time.end": 0.02}) if "equivalent strain" in line]
            self.assertEqual(len(found), 1 if told else 0, found)
            if told:
                self.assertIn(told, found[0])


if __name__ == "__main__":
    unittest.main()
