"""Predictions for a run: the size of its files, its memory and its time, compared with the actual values."""

import re

from harness import TestCase, block_case, run, settings, summary_of

UNITS = {"MB": 1e6, "GB": 1e9}
REFINED = block_case().replace("[[material]]", "refine = 4\n[[material]]", 1)
FINITE = REFINED.replace('scheme = "newmark"\npreset = "trapezoidal"', 'scheme = "reduced-kane"').replace('"consistent"', '"equivalent"')


def bytes_in(text, pattern):
    found = re.search(pattern + r"(\S+) (MB|GB)", text)
    return float(found[1]) * UNITS[found[2]]


class Foretold(TestCase):
    def validate(self, case, **values):
        return self.expect_status(0, run("validate", case, *settings(values))).stdout

    def summary(self, folder):
        return summary_of(folder)

    def test_files(self):
        case = self.write("case.toml", REFINED)
        for more in ({}, {"output.fields": '["all"]', "output.fields_precision": "single"}, {"output.fields_interval": 0.07},
                     {"output.fields_every": 4, "output.history_every": 2}):
            with self.subTest(more):
                said = re.search(r"estimate, files: .*", self.validate(case, **more))[0]
                out = self.simulate(case, values=more, options=("--quiet", "--force"))
                self.assertEqual(int(re.search(r"(\d+) frames of fields", said)[1]), self.summary(out)["frames"])
                self.assertAlmostEqual(bytes_in(said, r"fields of \S+ \S+, ") / (out / "results.h5").stat().st_size, 1.0, delta=0.06)
                ratio = bytes_in(said, r"history.csv of about ") / (out / "history.csv").stat().st_size
                self.assertTrue(0.8 < ratio < 1.6, ratio)
        self.assertIn("estimate, files: history.csv of", self.validate(case, **{"output.fields_every": 0}))

    def test_a_large_body_has_fewer_frames(self):
        """A hundred of its frames would take more than 200 MB; `info` also states their number."""
        case = self.write("case.toml", block_case().replace("[[material]]", "refine = 6\n[[material]]", 1))
        values = {"time.step": 1e-3, "output.fields": '["all"]'}
        said = self.expect_status(0, run("info", case, *settings(values))).stdout
        frames, size = int(re.search(r"(\d+) frames of fields", said)[1]), bytes_in(said, r"fields of \S+ \S+, ")
        self.assertIn("as many as fit into 200 MB", said)
        self.assertLess(frames, 100)
        self.assertTrue(130e6 < size <= 200e6, size)
        asked = self.expect_status(0, run("info", case, *settings({**values, "output.fields_every": 2}))).stdout
        self.assertIn("151 frames of fields", asked)
        self.assertNotIn("200 MB", asked)

    def test_memory(self):
        case = self.write("case.toml", block_case().replace("[[material]]", "refine = 5\n[[material]]", 1))
        for method in ("direct", "iterative"):
            values = {"solver.method": method, "time.step": 1e-4, "time.end": 3e-4}
            said = re.search(r"estimate, memory: (.*)", self.validate(case, **values))[0]
            out = self.simulate(case, values=values, options=("--quiet", "--force"))
            peak = self.summary(out)["peak_memory_bytes"]
            self.assertLess(bytes_in(said, "memory: "), 1.5 * peak)
            self.assertGreater(bytes_in(said, "contact points closed, "), peak / 1.5)
            text = self.expect_status(0, run("info", out)).stdout
            self.assertAlmostEqual(bytes_in(text, r" in all, ") / peak, 1.0, delta=0.01)

    def test_time(self):
        """It is between the predictions without contact and with contact everywhere; Newton's method takes longer."""
        case = self.write("case.toml", FINITE)
        least = {}
        for law in ("linear", "neo-hookean"):
            values = {"material.0.law": law, "time.step": 2e-3, "initial.velocity": "[0.0, -1.0]"}
            text = self.validate(case, **values)
            self.assertEqual("iterations of Newton's method" in text, law == "neo-hookean")
            seconds = [float(number) for number in re.findall(r"(\S+) s with", re.search(r"estimate, a step.*", text)[0])]
            self.assertEqual(len(seconds), 3, text)
            self.assertEqual(seconds, sorted(seconds))
            least[law] = seconds[0]
            out = self.simulate(case, values=values, options=("--quiet", "--force"))
            # The machine may be busy, or of another kind.
            took = self.summary(out)["seconds_per_step"]
            self.assertGreater(took, seconds[0] / 10)
            self.assertLess(took, 20 * seconds[2])
        self.assertGreater(least["neo-hookean"], 5 * least["linear"])
