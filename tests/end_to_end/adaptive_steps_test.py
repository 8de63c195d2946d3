"""Runs with `time.step = "adaptive"` through every command: properties of fixed steps also hold for steps of varying
lengths."""

import csv
import math
import pathlib
import signal
import subprocess
import tempfile

from harness import PROGRAM, SOURCE, History, TestCase, run, settings, summary_of, wait_for

BAR = SOURCE / "cases" / "bar" / "impact.toml"
LARGEST, END = 0.01, 2.0
ADAPTIVE = {"time.step": "adaptive", "time.largest": LARGEST, "time.end": END}
RUN = ADAPTIVE | {"time.tolerance": 1e-3, "output.checkpoint_every": 100}


class AdaptiveSteps(TestCase):
    @classmethod
    def setUpClass(cls):
        """One uninterrupted run for all tests."""
        folder = tempfile.TemporaryDirectory(prefix="ricochet-test-")
        cls.addClassCleanup(folder.cleanup)
        cls.whole = pathlib.Path(folder.name) / "whole"
        process = run("run", BAR, "-o", cls.whole, "--quiet", *settings(RUN))
        if process.returncode != 0:
            raise RuntimeError(process.stderr)

    def interrupted(self, name, number):
        """Makes a run that a signal has ended before its end."""
        output = self.folder / name
        command = [str(PROGRAM), "run", str(BAR), "-o", str(output), "--quiet", *settings(RUN)]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait_for(lambda: list(output.glob("checkpoint-*.ckpt")))
        process.send_signal(number)
        process.wait()
        self.assertIn(summary_of(output)["status"], ("running", "interrupted"), "the run was too fast for this test")
        return output

    def test_the_run_says_which_steps_it_took(self):
        """Each is the longest step times a power of 1/2, and their sum is the end."""
        said = summary_of(self.whole)
        history = History(self.whole / "history.csv")
        lengths = [after - before for before, after in zip(history["time"], history["time"][1:])]
        self.assertEqual(said["steps"], len(lengths))
        self.assertEqual(history["time"][-1], END)
        for length in lengths:
            halvings = math.log2(LARGEST / length)
            self.assertAlmostEqual(halvings, round(halvings), delta=1e-9)
        steps = said["adaptive_steps"]
        self.assertAlmostEqual(min(lengths), steps["shortest"], delta=1e-9 * LARGEST)
        self.assertAlmostEqual(max(lengths), steps["longest"], delta=1e-9 * LARGEST)
        self.assertLess(steps["shortest"], LARGEST / 8, "the impact has shortened none")
        self.assertEqual(steps["above_tolerance"], 0)
        self.assertLessEqual(steps["largest_error"], 1.0)
        # Before contact the bar flies, and steps are long.
        self.assertAlmostEqual(max(lengths), LARGEST, delta=1e-9 * LARGEST)
        text = self.expect_status(0, run("info", self.whole)).stdout
        self.assertIn(f'{len(lengths)} steps of {steps["shortest"]:.4g} to {LARGEST} ({steps["refused"]} refused)', text)

    def test_an_interruption_leaves_no_trace(self):
        expected = (self.whole / "history.csv").read_bytes()
        for number in (signal.SIGKILL, signal.SIGTERM):
            output = self.interrupted(f"interrupted-{number}", number)
            self.assertNotEqual((output / "history.csv").read_bytes(), expected)
            self.expect_status(0, run("run", "--resume", output, "--quiet"))
            self.assertEqual((output / "history.csv").read_bytes(), expected)
            self.assertTrue(summary_of(output)["resumed_at"])
            for entry in ("adaptive_steps", "extrema", "impacts", "energy_budget"):
                self.assertEqual(summary_of(output)[entry], summary_of(self.whole)[entry], entry)
        # A complete run has nothing to do, and one to a later end resumes before the steps that its end has shortened.
        self.expect_status(0, run("run", "--resume", output, "--quiet"))
        self.assertEqual((output / "history.csv").read_bytes(), expected)
        later = self.simulate(BAR, "later", RUN | {"time.end": 0.3})
        self.expect_status(0, run("run", BAR, "-o", later, "--resume", "--quiet", *settings(RUN)))
        self.assertEqual((later / "history.csv").read_bytes(), expected)
        # To an end between two long steps, also with checkpoints after each step, and resumed twice from there.
        for name, options in (("often", {"output.checkpoint_every": 1}), ("seldom", {"output.checkpoint_every": 1000})):
            later = self.simulate(BAR, name, RUN | {"time.end": 0.2341} | options)
            self.assertFalse(History(later / "history.csv")["time"][-1] in History(self.whole / "history.csv")["time"])
            for end in (0.3, 1.2341, END):
                self.expect_status(0, run("run", "--resume", later, "--quiet", "--set", f"time.end={end}"))
            self.assertEqual((later / "history.csv").read_bytes(), expected)

    def test_it_is_compared_and_drawn_with_fixed_steps(self):
        fixed = self.simulate(BAR, "fixed", {"time.end": END})
        table = self.expect_status(0, run("info", self.whole, fixed)).stdout
        for output in (self.whole, fixed):
            self.assertRegex(table, rf'{output} +1 +{summary_of(output)["impacts"][0]["restitution"]:.4g} ')
        figure = self.folder / "figure.svg"
        self.expect_status(0, run("plot", self.whole, fixed, "--what", "energy", "--what", "force", "--what",
                                  "probe:top.displacement_y", "-o", figure))
        self.assertIn("<svg", figure.read_text())
        page = self.folder / "report.html"
        self.expect_status(0, run("report", self.whole, fixed, "-o", page))
        self.assertIn(summary_of(self.whole)["title"], page.read_text())

    def test_a_study_of_tolerances(self):
        """A smaller tolerance takes more steps and comes closer to a run with a much smaller one."""
        reference = self.simulate(BAR, "reference", ADAPTIVE | {"time.tolerance": 1e-4})
        output = self.folder / "study"
        self.expect_status(0, run("study", BAR, "--vary", "time.tolerance=3e-2,1e-2,3e-3", *settings(ADAPTIVE), "--reference",
                                  reference, "--compare", "top.displacement", "-o", output, "--quiet"))
        with open(output / "study.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        steps = [int(row["steps"]) for row in rows]
        errors = [float(row["error:top.displacement"]) for row in rows]
        self.assertEqual(steps, sorted(set(steps)))
        self.assertEqual(errors, sorted(errors, reverse=True))
        self.assertLess(errors[-1], 0.01)
        self.assertEqual({row["time"] for row in rows}, {str(END).rstrip("0").rstrip(".")})
        self.expect_status(0, run("plot", output, "--what", "work-precision", "--what", "order", "-o",
                                  self.folder / "figure.svg"))
        self.expect_status(0, run("report", output))
        self.assertTrue((output / "runs.html").exists())
        # With nothing left to do, the table is the same except for times.
        self.expect_status(0, run("study", "--resume", output, "--quiet"))
