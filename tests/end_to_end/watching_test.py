"""Runs that are observed while in progress, and the results of those that fail."""

import json
import re
import signal
import subprocess
import time

from harness import DISC, PROGRAM, SCHEMES, SOURCE, History, TestCase, block_case, method, run, settings, summary_of


class Watching(TestCase):
    def start(self, *arguments):
        process = subprocess.Popen([PROGRAM, "run", DISC, "-o", self.folder / "out", "--quiet", *arguments],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_for(self, condition):
        deadline = time.monotonic() + 60
        while not condition():
            self.assertLess(time.monotonic(), deadline, "nothing has happened")
            time.sleep(0.05)

    def test_a_run_that_goes_on(self):
        """info: progress, rate, time left, energy, warnings, checkpoint; and a growing history, as tail -f shows."""
        output = self.folder / "out"
        process = self.start("--set", "time.end=1000", "--set", "output.checkpoint_every=2000")
        history = output / "history.csv"
        self.wait_for(lambda: history.exists() and len(list(output.glob("*.ckpt"))) == 2)
        sizes = set()
        self.wait_for(lambda: sizes.add(history.stat().st_size) or len(sizes) > 3)
        summary = output / "summary.json"
        self.wait_for(lambda: json.loads(summary.read_text())["steps"] > 4000)
        text = self.expect_status(0, run("info", output)).stdout
        self.assertIn("(running)", text)
        found = re.search(r"step (\d+) of 10000000 \(([\d.e-]+) %\), t = ([\d.e-]+), ([\d.e+]+) steps per second, (.*) left",
                          text)
        self.assertIsNotNone(found, text)
        step = int(found[1])
        self.assertAlmostEqual(float(found[3]), step * 1e-4, delta=1e-5 * step)
        self.assertGreater(float(found[4]), 10.0)
        for words in ("energy account closes to", "checkpoint of step", "warning: at t =", "energy 0.0376"):
            self.assertIn(words, text)
        process.send_signal(signal.SIGKILL)
        process.wait()
        text = self.expect_status(0, run("info", output)).stdout
        self.assertIn("(interrupted)", text)
        self.assertIn("--resume", text)
        self.assertNotIn(" left", text.split("\n")[1])
        # As far as its history states, which is newer than its summary.
        last = history.read_text().rsplit("\n", 2)[1].split(",")[0]
        self.assertIn(f"step {last} of 10000000", text)
        newest = sorted(output.glob("*.ckpt"))[-1]
        self.assertLessEqual(int(newest.stem.split("-")[1]), int(last))
        text = self.expect_status(0, run("info", newest)).stdout
        self.assertIn(f"checkpoint of step {int(newest.stem.split('-')[1])}, t = ", text)
        summary.write_text("{}")
        text = self.expect_status(0, run("info", output)).stdout
        self.assertIn("summary.json is missing or damaged", text)
        self.assertIn(f"checkpoint of step {int(newest.stem.split('-')[1])}, t = ", text)
        newest.write_bytes(newest.read_bytes()[:-3])
        self.assertIn("truncated", self.expect_status(2, run("info", newest)).stderr)

    def test_a_directory_without_a_run(self):
        self.assertIn("this directory holds no run", self.expect_status(4, run("info", self.folder)).stderr)

    def test_debug_reports_every_contact_iteration(self):
        for friction in (0.0, 0.3):
            values = {"contact.0.friction": friction, "initial.velocity": "[0.05,-0.1]", "time.end": 0.014}
            output = self.folder / f"out-{friction}"
            process = self.expect_status(0, run("run", DISC, "-o", output, "--log-level", "debug", *settings(values)))
            told, step = {}, 0
            changes = 0
            for line in process.stderr.splitlines():
                if found := re.match(r"debug: step (\d+), t = ", line):
                    step = int(found[1])
                if found := re.match(r"debug: contact: \d+ points, iteration (\d+) \(([\w -]+)\): residual (\S+), (\d+) "
                                     r"closed(?: \((\d+) stick, (\d+) slip\))?, (\d+) changed", line):
                    told[step] = told.get(step, 0) + 1
                    float(found[3])
                    changes += int(found[7])
                    if friction:
                        self.assertEqual(int(found[5]) + int(found[6]), int(found[4]))
            history = History(output / "history.csv")
            iterations = {int(s): int(n) for s, n in zip(history["step"], history["iterations"]) if n > 0}
            self.assertGreater(len(iterations), 20)
            self.assertEqual(told, iterations)
            self.assertGreater(changes, 0)
            # Reporting it changes nothing.
            again = self.simulate(DISC, f"quiet-{friction}", values)
            self.assertEqual((again / "history.csv").read_bytes(), (output / "history.csv").read_bytes())

    def test_accounts_that_do_not_close(self):
        for check in ("energy_residual", "momentum", "angular_momentum"):
            limit = {"check.energy_residual": 1e-6, f"check.{check}": 1e-17}
            output = self.folder / f"warn-{check}"
            process = self.expect_status(0, run("run", DISC, "-o", output, "--quiet", "--set", "time.end=0.02",
                                                *settings(limit)))
            name = {"energy_residual": "energy"}.get(check, check.replace("_", " "))
            self.assertEqual(process.stderr.count("is violated"), 1, process.stderr)
            self.assertIn(f"the balance of {name} is violated", process.stderr)
            self.assertIn(f"check.{check} = 1e-17", process.stderr)
            result = summary_of(output)["checks"][check]
            self.assertEqual(result["limit"], 1e-17)
            self.assertGreater(result["largest"], 1e-17)
            self.assertIn(f"CHECK FAILED: {check}", run("info", output).stdout)
            stopped = self.folder / f"stop-{check}"
            process = self.expect_status(3, run("run", DISC, "-o", stopped, "--quiet", "--set", "time.end=0.02",
                                                "--set", 'check.on_failure="stop"', *settings(limit)))
            self.assertIn("is violated", process.stderr)
            self.assertLess(len(History(stopped / "history.csv").rows), 201)

    def test_accounts_close_by_default(self):
        """Errors are far below the limits in every scheme."""
        for scheme in SCHEMES:
            values = method(scheme) | {"contact.0.friction": 0.3, "time.end": 0.05}
            output = self.simulate(DISC, f"closes-{scheme}", values)
            for name, check in summary_of(output)["checks"].items():
                self.assertEqual(check["limit"], 1e-8)
                self.assertLess(check["largest"], 1e-11, f"{scheme}: {name}")

    def test_works_that_cancel(self):
        """A block held on a belt: friction and the belt do the same work, thousands of times all energies."""
        block = SOURCE / "cases" / "incline" / "block.msh"
        text = block_case(block).replace('"body"\ndensity = 1.0\nlambda = 100.0\nmu = 50.0',
                                         '"block"\ndensity = 7800.0\nyoung = 2e11\npoisson = 0.3')
        text = text.replace("normal = [0.0, 1.0]", "normal = [0.0, 1.0]\nvelocity = [5e6, 0.0]")
        text = text.replace('"bottom"\nobstacle = "floor"', '"base"\nobstacle = "floor"\nfriction = 0.3')
        text += '[[support]]\ngroup = "top"\ncomponents = ["x"]\n[initial]\ndisplacement = "static"\n'
        output = self.folder / "out"
        process = self.expect_status(0, run("run", self.write("belt.toml", text), "-o", output, "--quiet", "--set",
                                            "time.step=1e-4", "--set", "time.end=0.05", "--set",
                                            'mass.type="equivalent"', "--set", 'check.on_failure="stop"'))
        history = History(output / "history.csv")
        energy = max(map(abs, history["total_energy"] + history["elastic_energy"]))
        self.assertGreater(max(map(abs, history["friction_work"])), 1e4 * energy)
        self.assertGreater(max(map(abs, history["energy_residual"])), 1e-8 * energy)
        self.assertIn("of the largest work", process.stdout)
        self.assertLess(summary_of(output)["checks"]["energy_residual"]["largest"], 1e-8)

    def test_a_step_in_very_short_parts_is_reported_once(self):
        """A block far faster than its waves: no part of its first step has a solution."""
        case = self.write("case.toml", block_case().replace('scheme = "newmark"\npreset = "trapezoidal"', 'scheme = "reduced-kane"'))
        process = self.expect_status(3, run("run", case, "-o", self.folder / "out", "--quiet", *settings(
            {"mass.type": "equivalent", "material.0.law": "neo-hookean", "initial.velocity": "[0.0, -100.0]", "time.end": 0.1})))
        told = "step 1 is computed in parts as short as 1/32 of it, and possibly shorter ones, since Newton's method found no solution"
        self.assertEqual(process.stderr.count(told), 1, process.stderr)
        warnings = summary_of(self.folder / "out")["warnings"]
        self.assertEqual(len([warning for warning in warnings if "as short as" in warning]), 1, warnings)

    def test_a_failed_step_leaves_its_state(self):
        case = self.write("case.toml", block_case().replace('preset = "trapezoidal"', "beta = 0.25\ngamma = 0.5"))
        output = self.folder / "out"
        process = self.expect_status(3, run("run", case, "-o", output, "--quiet", *settings(
            {"time.beta": 0.25, "time.gamma": 0, "time.end": 1000, "output.fields_every": 0})))
        left = list(output.glob("failure-*.ckpt"))
        self.assertEqual(len(left), 1)
        self.assertIn(str(left[0]), process.stderr)
        self.assertIn("use a stable scheme", process.stderr)
        summary = summary_of(output)
        text = self.expect_status(0, run("info", left[0])).stdout
        self.assertIn(f"the state of step {summary['steps']}", text)
        # The step whose row is missing in the history.
        self.assertIn(f"step {int(left[0].stem.split('-')[1])} ", summary["message"])
        self.assertEqual(int(left[0].stem.split("-")[1]), len(History(output / "history.csv").rows))
        self.assertIn("no longer finite", text)
        text = self.expect_status(0, run("info", output)).stdout
        self.assertIn("(FAILED)", text)
        self.assertIn(str(left[0]), text)
        # It is not a checkpoint, but protects the directory from being overwritten.
        self.assertEqual(list(output.glob("checkpoint-*")), [])
        self.expect_status(0, run("run", case, "-o", output, "--force", "--quiet"))
        self.assertEqual(list(output.glob("failure-*")), [])
