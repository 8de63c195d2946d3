"""A case of benchmarks/ holds: it is valid, its run succeeds with all its [[expect]] entries and without a warning, and
its energy account closes. The case file is the first argument."""

import pathlib
import sys
import unittest

from harness import OTHER_ROW, History, TestCase, run, summary_of

CASE = pathlib.Path(sys.argv.pop(1))


class BenchmarkTest(TestCase):
    def test_holds(self):
        self.expect_status(0, run("validate", CASE))
        results = self.simulate(CASE)
        summary = summary_of(results)
        self.assertEqual((summary["status"], summary["warnings"]), ("done", []))
        self.assertEqual((summary["scheme"], summary["mass"]), ("reduced-kane", "equivalent"), "no scheme is chosen for a case")
        self.assertGreater(len(summary["expectations"]), 4)
        for expectation in summary["expectations"]:
            self.assertTrue(expectation["holds"], expectation)
            self.assertTrue(expectation["name"], expectation)
            self.assertNotRegex(expectation["quantity"], OTHER_ROW)
        history = History(results / "history.csv")
        scale = history.largest_energy()
        for step, residual in zip(history["step"], history["energy_residual"]):
            self.assertLessEqual(abs(residual), 1e-10 * scale, f"energy_residual in step {step:g}")


if __name__ == "__main__":
    unittest.main()
