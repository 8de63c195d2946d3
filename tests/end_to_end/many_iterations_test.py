"""If Newton's method takes hundreds of iterations per step, the run suggests a cheaper method, which is indeed
cheaper."""

import re

from harness import History, TestCase, between_plates, run, settings

RING_GEO = """SetFactory("OpenCASCADE");
Disk(1) = {0, 2.5, 0, 2.5, 2.5};
Mesh.MeshSizeMax = 0.8;
Mesh.MeshSizeMin = 0.8;
Physical Surface("ring") = {1};
Physical Curve("skin") = {1};
"""
# Rubber that is squeezed between two plates, by sixteen thousandths of its height in a step.
RING = """[mesh]
file = "ring.geo"
degree = 2
[[material]]
group = "ring"
density = 1.1e-9
law = "mooney-rivlin"
c10 = 0.4
c01 = 0.1
bulk_modulus = 1000.0
""" + between_plates("-20*t") + """[time]
step = 4e-3
end = 0.04
[solver]
newton_tolerance = 1e-13
[output]
fields_every = 0
"""
# This scheme has no exact tangent to fall back on.
NEWMARK = {"time.scheme": "newmark", "time.preset": "trapezoidal"}
WARNING = r"Newton's method has needed more than 200 iterations in each of [3-9] steps"
EXPLICIT = {"time.scheme": "semi-explicit", "mass.type": "equivalent-lumped"}


class ManyIterations(TestCase):
    def squeeze(self, text=RING, **values):
        (self.folder / "ring.geo").write_text(RING_GEO)
        out = self.folder / "out"
        process = run("run", self.write("ring.toml", text), "-o", out, "--force", "--quiet", *settings(values))
        return self.expect_status(0, process).stderr, History(out / "history.csv")

    def test_the_scheme_without_systems_is_named_once_and_supports_the_case(self):
        said, history = self.squeeze(**NEWMARK)
        self.assertGreater(sorted(history["newton_rounds"])[-3], 200, "this case no longer needs many iterations: use another one")
        self.assertEqual(len(re.findall(WARNING, said)), 1, said)
        found = re.search(r'Scheme "semi-explicit" with mass.type = "equivalent-lumped" .* with time.step = (\S+), ', said)
        self.assertIsNotNone(found, said)
        step = float(found[1])
        after, history = self.squeeze(**EXPLICIT, **{"time.step": step, "time.end": 200 * step})
        self.assertNotRegex(after, "Newton's method has needed")
        self.assertLess(max(history["newton_rounds"]), 100)

    def test_a_case_that_it_does_not_support(self):
        inflated = RING.replace("[time]", '[[pressure]]\ngroup = "skin"\nvalue = 1e-9\n[time]')
        said, _ = self.squeeze(inflated, **NEWMARK)
        self.assertRegex(said, WARNING + r".* does not support this case: .*pressure")

    def test_few_iterations_are_not_reported(self):
        said, history = self.squeeze(**{"time.step": 5e-4, "time.end": 3e-3})
        self.assertLess(max(history["newton_rounds"]), 200)
        self.assertNotRegex(said, "Newton's method has needed")
