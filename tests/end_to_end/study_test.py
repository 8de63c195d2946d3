"""`ricochet study`: its table agrees with its runs, whatever happened in between; orders of a known problem."""

import csv
import json
import math
import os
import pathlib
import signal
import subprocess

from harness import PROGRAM, SOURCE, History, TestCase, run, settings, summary_of, wait_for

BAR = SOURCE / "cases" / "bar" / "impact.toml"
ROD = SOURCE / "cases" / "rod" / "rod.toml"
# The rod's first mode, without contact: every step is that of a linear oscillator.
FREE = {"initial.displacement": '["1e-3*cos(1.5707963267948966*x)", "0"]', "obstacle.stop.point": "[-10, 0]",
        "mass.type": "consistent", "time.end": 2}
# Steps that take long enough to be interrupted.
SLOW = {"time.end": 4, "output.fields_every": 0, "output.checkpoint_every": 500}


def table(directory, without=("processor_seconds",)):
    with open(directory / "study.csv", newline="", encoding="utf-8") as file:
        return [{key: value for key, value in row.items() if key not in without} for row in csv.DictReader(file)]


class Study(TestCase):
    def study(self, name, *arguments, status=0, case=BAR, values=None, options=("--quiet",)):
        self.output = self.folder / name
        process = run("study", *([case] if case else []), *arguments, *settings(values or {}), "-o", self.output, *options)
        self.expect_status(status, process)
        return process

    def start(self, name, *arguments, values):
        self.output = self.folder / name
        command = [str(PROGRAM), "study", str(BAR), *arguments, *settings(values), "-o", str(self.output), "--jobs", "2"]
        return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def summary(self, row):
        return summary_of(self.output / "runs" / row["run"])

    def test_table_says_what_the_runs_say(self):
        self.study("a", "--vary", "time.scheme,mass.type=reduced-kane/equivalent,midpoint/consistent", "--vary",
                   "initial.velocity=[0,-10],[0, -5]", "--quantity", "max(history.bottom.pressure)", "--quantity",
                   "history.time[-1]", "--exact", "summary.impacts.0.restitution=1", values={"time.end": 1.8})
        rows = table(self.output, without=())
        self.assertEqual([(row["time.scheme"], row["mass.type"], row["initial.velocity"]) for row in rows],
                         [("reduced-kane", "equivalent", "[0,-10]"), ("reduced-kane", "equivalent", "[0, -5]"),
                          ("midpoint", "consistent", "[0,-10]"), ("midpoint", "consistent", "[0, -5]")])
        self.assertEqual(list(rows[0])[:5], ["time.scheme", "mass.type", "initial.velocity", "run", "status"])
        for row in rows:
            summary = self.summary(row)
            history = History(self.output / "runs" / row["run"] / "history.csv")
            self.assertEqual(summary["parameters"]["time.scheme"], row["time.scheme"])
            impact = summary["impacts"][0]
            for column, value in (
                    ("steps", summary["steps"]), ("time", history["time"][-1]), ("restitution", impact["restitution"]),
                    ("processor_seconds", summary["processor_seconds"]), ("impacts", len(summary["impacts"])),
                    ("created_by_method", summary["energy_budget"]["created_by_method"]),
                    ("lost_by_method", summary["energy_budget"]["lost_by_method"]),
                    ("largest_force", max(one["largest_force"] for one in summary["impacts"])),
                    ("peak_von_mises", summary["peak_stress"]["von_mises"]),
                    ("peak_von_mises_time", summary["peak_stress"]["time"]),
                    ("peak_von_mises_y", summary["peak_stress"]["place"][1]), ("warnings", len(summary["warnings"])),
                    ("max(history.bottom.pressure)", max(history["bottom.pressure"])), ("history.time[-1]", 1.8),
                    ("error:summary.impacts.0.restitution", abs(impact["restitution"] - 1)),
                    ("exit_status", 0)):
                self.assertAlmostEqual(float(row[column]), value, delta=1e-14 * abs(value) + 1e-300, msg=column)
            self.assertGreater(float(row["processor_seconds"]), 0)
            self.assertIn("warning", row["doubts"])  # strains of 30 %
            # Also a column for each quantity of the case's [[expect]] entries.
            self.assertEqual(float(row["history.bottom.pressure(t=0.7)"]), history["bottom.pressure"][350])
        alone = self.simulate(BAR, "alone", {"time.end": 1.8, "initial.velocity": "[0,-5]"})
        self.assertEqual((alone / "history.csv").read_bytes(),
                         (self.output / "runs" / rows[1]["run"] / "history.csv").read_bytes())

    def test_any_number_of_jobs_gives_the_same_table(self):
        tables = []
        for jobs in (1, 2):
            self.study(f"jobs{jobs}", "--vary", "time.step=0.004,0.002,0.001", "--reference", "finest", "--jobs", jobs)
            tables.append(table(self.output))
        self.assertEqual(tables[0], tables[1])
        # No error relative to itself, and an order needs two errors.
        errors = [row["error:top.displacement"] for row in tables[0]]
        self.assertTrue(float(errors[0]) > float(errors[1]) > 0)
        self.assertEqual(errors[2], "")
        self.assertEqual([row["order:top.displacement"] != "" for row in tables[0]], [False, True, False])

    def test_orders_of_a_linear_oscillator(self):
        """Midpoint and trapezoidal rule are of second order; the reference is a hundred times as fine."""
        reference = self.simulate(ROD, "reference", {**FREE, "time.scheme": "midpoint", "time.step": 5e-4})
        process = self.study("orders", "--vary", "time.scheme,time.preset=newmark/trapezoidal,midpoint/-", "--vary",
                   "time.step=0.1,0.05,0.025", "--reference", reference, "--compare", "tip.displacement", "--compare",
                   "kinetic_energy", case=ROD, values=FREE)
        rows = table(self.output)
        for row in rows:
            for name in ("tip.displacement", "kinetic_energy"):
                order = row[f"order:{name}"]
                if row["time.step"] == "0.1":
                    self.assertEqual(order, "")
                else:
                    self.assertAlmostEqual(float(order), 2.0, delta=0.02)
        self.assertIn("order:tip.displacement", (self.output / "study.md").read_text())
        for absent in ("are meaningless", "too large"):
            self.assertNotIn(absent, process.stdout)
        for what in ("order", "work-precision", "order:tip.displacement", "peak_von_mises-against-time.step",
                     "processor_seconds-against-time.scheme"):
            self.expect_status(0, run("plot", self.output, "--what", what, "-o", self.folder / "figure.svg"))
            self.assertIn("newmark", (self.folder / "figure.svg").read_text())
        process = self.expect_status(1, run("plot", self.output, "--what", "restitutoin-against-time.step", "-o", "a.svg"))
        self.assertIn('did you mean "restitution"?', process.stderr)
        self.expect_status(0, run("report", self.output))
        page = (self.output / "report.html").read_text()
        self.assertIn("<svg", page)
        self.assertIn(f'href="runs/{rows[0]["run"]}"', page)
        self.assertTrue((self.output / "runs.html").exists())
        self.assertIn("tip.displacement", self.expect_status(0, run("info", self.output)).stdout)

    def test_orders_in_cells_that_are_halved(self):
        """The energy of an interpolated displacement is of second order; mesh.refine counts halvings."""
        exact = 1e-6 * math.pi**2 * 0.1 / 16
        self.study("halved", "--vary", "mesh.refine=0,1,2", "--exact", f"history.elastic_energy[0]={exact!r}", "--order", "mesh.refine",
                   "--reference", "finest", "--compare", "tip.displacement", case=ROD, values={**FREE, "time.scheme": "midpoint", "time.end": 0.02})
        rows = table(self.output)
        orders = [row["order:history.elastic_energy[0]"] for row in rows]
        self.assertEqual(orders[0], "")
        for order in orders[1:]:
            self.assertAlmostEqual(float(order), 2.0, delta=0.05)
        cells = [self.summary(row)["cells"] for row in rows]
        self.assertEqual(cells[1:], [4 * cells[0], 16 * cells[0]])
        # The finest run has the most halvings.
        self.assertEqual([row["error:tip.displacement"] == "" for row in rows], [False, False, True])
        self.expect_status(0, run("plot", self.output, "--what", "order:history.elastic_energy[0]", "-o", self.folder / "order.svg"))
        self.assertIn("2^-mesh.refine", (self.folder / "order.svg").read_text())

    def test_orders_that_mean_nothing_are_told(self):
        """Relative to a wrong value the error does not fall; relative to the finest run orders are too large."""
        process = self.study("floor", "--vary", "time.step=0.1,0.05,0.025", "--exact", "history.time[-1]=3", "--reference", "finest",
                             case=ROD, values={**FREE, "time.scheme": "midpoint"})
        for text in (process.stdout, (self.output / "study.md").read_text()):
            self.assertIn("are meaningless (2 of 2 for history.time", text)
            self.assertIn("The last orders are too large", text)
        self.expect_status(0, run("plot", self.output, "--what", "order:history.time[-1]", "-o", self.folder / "figure.svg"))
        text = (self.folder / "figure.svg").read_text()
        self.assertIn("<!-- last order: floor -->", text)
        self.assertNotIn("<!-- order ", text)

    def test_a_quantity_that_some_runs_lack_is_told_once(self):
        process = self.study("some", "--vary", "time.step,time.largest=4e-3/-,2e-3/-,adaptive/4e-3", "--quantity",
                             "summary.adaptive_steps.refused", values={"time.end": 0.1})
        self.assertEqual(process.stderr.count("adaptive_steps"), 1)
        self.assertIn("--quantity summary.adaptive_steps.refused: 2 of 3 runs lack it", process.stderr)

    def test_progress_says_what_is_left(self):
        process = self.study("left", "--vary", "time.step=4e-3,3e-3,2e-3", "--jobs", 1, options=())
        lines = [line for line in process.stderr.splitlines() if "/3  " in line]
        self.assertEqual(len(lines), 3, process.stderr)
        for line in lines[:2]:
            self.assertRegex(line, r": done, .+ left$")
        self.assertRegex(lines[2], ": done$")

    def test_fixed_and_adaptive_steps_are_lines_of_their_own(self):
        self.study("lines", "--vary", "time.step,time.largest,time.tolerance=4e-3/-/-,2e-3/-/-,adaptive/4e-3/1e-2,adaptive/4e-3/1e-3",
                   "--exact", "history.time[-1]=0.25", values={"time.end": 0.2, "output.fields_every": 0})
        self.expect_status(0, run("plot", self.output, "--what", "work-precision", "-o", self.folder / "figure.svg"))
        text = (self.folder / "figure.svg").read_text()
        self.assertIn("<!-- numeric step -->", text)
        self.assertIn("<!-- adaptive -->", text)
        # Words that are all different, as meshes are, make one line.
        self.study("one", "--vary", "title,time.step=coarse/4e-3,fine/2e-3", "--exact", "history.time[-1]=0.25",
                   values={"time.end": 0.2, "output.fields_every": 0})
        self.expect_status(0, run("plot", self.output, "--what", "work-precision", "-o", self.folder / "figure.svg"))
        self.assertNotIn("coarse", (self.folder / "figure.svg").read_text())

    def test_a_run_that_fails_is_a_row(self):
        """An account that cannot close so well stops a run, and a limit below 0 is invalid."""
        process = self.study("failing", "--vary", "check.energy_residual=1e-8,1e-17,-1,1e-9", status=3,
                             values={"check.on_failure": "stop"})
        rows = table(self.output)
        self.assertEqual([row["status"] for row in rows], ["done", "failed", "refused", "done"])
        self.assertEqual([row["exit_status"] for row in rows], ["0", "3", "2", "0"])
        self.assertIn("must be a number of at least 0", rows[2]["message"])
        self.assertIn("must be a number of at least 0", process.stdout)
        self.assertIn("is violated", rows[1]["message"])
        self.assertGreater(int(rows[1]["steps"]), 0)
        # They would fail again: nothing is run, and the table is the same.
        before = (self.output / "study.csv").read_bytes()
        process = self.expect_status(3, run("study", "--resume", self.output))
        self.assertEqual((self.output / "study.csv").read_bytes(), before)
        self.assertIn("2 runs skipped (refused or failed earlier)", process.stderr)
        process = self.study("nothing", "--vary", "time.step=-1,-2", status=2)
        self.assertFalse((self.output / "study.json").exists())

    def test_an_expectation_that_does_not_hold(self):
        case = self.write("case.toml", BAR.read_text().replace('file = "', f'file = "{BAR.parent}/') +
                          '[[expect]]\nquantity = "summary.steps"\nmaximum = 400\n'
                          'when = { "time.step" = 0.004 }\n')
        self.study("expect", "--vary", "time.step=0.004,0.002", status=5, case=case)
        first, second = table(self.output)
        self.assertEqual((first["status"], first["exit_status"], second["exit_status"]), ("done", "5", "0"))
        self.assertEqual(first["message"], "summary.steps is not ≤ 400")
        self.assertEqual((first["summary.steps"], second["summary.steps"]), ("500", "1000"))

    def test_interrupted_and_resumed(self):
        """kill -9 or a signal that it can handle ends it; the tables are those of an uninterrupted study."""
        vary = ("--vary", "time.step=0.002,0.0005,0.00025")
        self.study("whole", *vary, values=SLOW)
        expected = table(self.output)
        for number, name in ((signal.SIGKILL, "killed"), (signal.SIGTERM, "stopped")):
            process = self.start(name, *vary, values=SLOW)
            wait_for(lambda: list((self.output / "runs" / "002-step=0.0005").glob("*.ckpt")))
            process.send_signal(number)
            text, errors = process.communicate()
            interrupted = [path for path in (self.output / "runs").glob("*/summary.json")
                           if json.loads(path.read_text())["status"] in ("running", "interrupted")]
            self.assertTrue(interrupted, "the study was too fast for this test")
            if number == signal.SIGTERM:
                self.assertEqual(process.returncode, 143, errors)
                self.assertIn(f"`ricochet study --resume {self.output}` continues", text)
                self.assertIn("interrupted", [row["status"] for row in table(self.output)])
            else:
                self.assertFalse((self.output / "study.csv").exists())
                # A new start is refused, and the message states how to resume.
                self.assertIn("--resume", self.study(name, *vary, values=SLOW, status=4).stderr)
            self.expect_status(0, run("study", "--resume", self.output, "--quiet"))
            self.assertEqual(table(self.output), expected)
            # A run with a checkpoint resumed from there.
            self.assertTrue(any(json.loads(path.read_text())["resumed_at"] for path in interrupted))

    def test_a_run_whose_process_is_killed(self):
        vary = ("--vary", "time.step=0.00025,0.002")
        process = self.start("one", *vary, values=SLOW)
        first = self.output / "runs" / "001-step=0.00025"
        wait_for(lambda: list(first.glob("*.ckpt")))
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        os.kill(next(int(child) for child in children
                     if first.name in pathlib.Path(f"/proc/{child}/cmdline").read_text()), signal.SIGKILL)
        process.communicate()
        self.assertEqual(process.returncode, 128 + signal.SIGKILL)
        rows = table(self.output)
        self.assertEqual([(row["status"], row["exit_status"]) for row in rows], [("failed", "137"), ("done", "0")])
        self.assertEqual(rows[0]["message"], "its process was killed by signal 9")
        self.expect_status(0, run("study", "--resume", self.output, "--quiet"))
        self.assertEqual([row["status"] for row in table(self.output)], ["done", "done"])

    def test_a_plan_may_grow_but_not_change(self):
        self.study("grows", "--vary", "time.step=0.004,0.001")
        before = {path: path.stat().st_mtime_ns for path in (self.output / "runs").glob("*/summary.json")}
        process = self.study("grows", "--vary", "time.step=0.004,0.002,0.001", options=("--resume",))
        self.assertIn("3/3", process.stderr)
        self.assertEqual({path: path.stat().st_mtime_ns for path in before}, before)
        self.assertEqual([row["run"] for row in table(self.output)],
                         ["001-step=0.004", "003-step=0.002", "002-step=0.001"])
        for arguments, values, said in (
                (("--vary", "time.step=0.004,0.002"), {}, "this plan has no run with time.step=0.001"),
                (("--vary", "time.step=0.004,0.002,0.001"), {"time.end": 1}, "this plan has no run with time.step")):
            process = self.study("grows", *arguments, values=values, options=("--resume",), status=4)
            self.assertIn(said, process.stderr)
        self.study("grows", "--vary", "time.step=0.004", options=("--force",))
        self.assertEqual([path.name for path in (self.output / "runs").iterdir()], ["001-step=0.004"])

    def test_a_case_that_has_changed_is_refused(self):
        text = BAR.read_text().replace('file = "', f'file = "{BAR.parent}/')
        case = self.write("case.toml", text)
        self.study("changed", "--vary", "time.step=0.004", case=case)
        self.write("case.toml", text.replace("density = 1.0", "density = 1.1"))
        process = self.study("changed", "--vary", "time.step=0.004,0.002", case=case, options=("--resume",), status=2)
        self.assertIn("density", process.stderr)
        self.assertIn("--force", process.stderr)

    def test_wrong_use(self):
        for arguments, said in (
                ((), "nothing varies"), (("--vary", "time.stp=1"), 'did you mean "step"?'),
                (("--vary", "time.step=1e-3", "--set", "time.step=1"), "is in both --vary and --set"),
                (("--vary", "time.step=1e-3", "--exact", "summary.steps"), "QUANTITY=VALUE"),
                (("--vary", "time.step=1e-3", "--reference", "nowhere"), "neither the directory of a run"),
                (("--vary", "time.scheme=newmark,midpoint", "--reference", "finest"), "at least two values, all of them numbers"),
                (("--vary", "time.step=1e-3", "--order", "time.end"), '"time.end" does not vary'),
                (("--vary", "time.step=1e-3", "--compare", "a"), "name it with --reference")):
            process = self.study("wrong", *arguments, status=1)
            self.assertIn(said, process.stderr)
            self.assertFalse(self.output.exists())
        self.simulate(BAR, "run", {"time.end": 0.1})
        self.assertIn("holds a run", self.study("run", "--vary", "time.step=1e-3", status=4).stderr)
