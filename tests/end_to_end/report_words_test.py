"""`ricochet report` of runs of every state: judgements, missing data and refusals, in words."""

import json
import os
import re
import shutil
import subprocess

import h5py

from harness import DISC, PROGRAM, block_case, summary_of
from report_page import SHORT, VIEWER, Page, ReportTestCase


class ReportWords(ReportTestCase):
    def test_a_run_that_goes_on(self):
        """The report is repeated while frames are written."""
        command = [str(PROGRAM), "run", str(DISC), "-o", str(self.folder / "disc"), "--quiet", "--log-level", "error",
                   "--set", "time.end=4", "--set", "output.fields_every=10"]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            frames, reports = 0, 0
            while process.poll() is None and reports < 6:
                results = self.folder / "disc" / "results.xdmf"
                if not results.exists() or results.stat().st_size < 20_000:
                    continue
                self.report("disc")
                (data,) = (page := Page(self.folder / "disc" / "report.html")).runs
                self.assertGreaterEqual(len(data["body"]["times"]), frames)
                frames = len(data["body"]["times"])
                page.levels(data["body"]["deviations"][0])
                reports += 1
            self.assertGreater(reports, 2)
        finally:
            process.terminate()
            process.wait()

    def test_runs_that_are_not_complete(self):
        results = self.simulate(DISC, "disc", SHORT)
        history = results / "history.csv"
        text = history.read_text()
        summary = summary_of(results)
        summary["status"] = "interrupted"
        (results / "summary.json").write_text(json.dumps(summary))
        history.write_text(text[:-9])  # the last row is being written
        self.report(results)
        (data,) = Page(results / "report.html").runs
        self.assertEqual(data["history"]["columns"], text.count("\n") - 2)
        summary["status"] = "done"
        (results / "summary.json").write_text(json.dumps(summary))
        self.assertIn("history.csv:", self.report(results, status=2).stderr)

    def test_a_report_of_other_runs_is_not_replaced_unasked(self):
        for name in ("a", "a/b"):
            self.simulate(DISC, name, SHORT)
        self.report("a")
        self.report("a/")  # the same run again
        shutil.copy(self.folder / "a" / "report.html", self.folder / "a" / "b")
        process = self.report("a/b", status=4)
        self.assertIn("a/b/report.html: exists and shows other runs", process.stderr)
        self.report("a/b", "-o", "a/b/report.html")
        self.report("a/b")

    def test_a_viewer_of_another_version(self):
        results = self.simulate(DISC, "disc", SHORT)
        self.viewer.write_text(re.sub(r"format \d+", "format 1", VIEWER))
        self.assertIn("is not the viewer of this version: build or install", self.report(results, status=4).stderr)

    def test_titles_end_nothing(self):
        case = self.write("case.toml", block_case().replace('"A block falls"', '"</script><b>bold & \\"quoted\\""'))
        results = self.simulate(case, "out", {"time.end": 0.02})
        self.report(results)
        self.assertEqual(Page(results / "report.html").runs[0]["summary"]["title"], '</script><b>bold & "quoted"')

    def test_wrong_use(self):
        results = self.simulate(DISC, "disc", SHORT)
        self.assertIn("summary.json", self.report(self.folder / "bin", status=4).stderr)
        self.assertIn("no such directory", self.report(self.folder / "nowhere", status=4).stderr)
        self.report(status=1)
        self.assertIn("--size-limit", self.report(results, "--size-limit", "0.5", status=1).stderr)
        other = self.write("notes.html", "<p>my notes</p>")
        self.assertIn("is not a report", self.report(results, "-o", other, status=4).stderr)
        self.assertEqual(other.read_text(), "<p>my notes</p>")
        self.report(results, "-o", self.folder / "page.html")
        self.report(results, "-o", self.folder / "page.html")  # an own page is overwritten
        missing = self.folder / "missing"
        process = self.report(results, "-o", missing / "page.html", status=4)
        self.assertIn(f"{missing}/page.html: cannot write: {missing} does not exist", process.stderr)
        self.assertNotIn(".new", process.stderr)
        process = self.report(results, "-o", other / "page.html", status=4)
        self.assertIn(f"{other}/page.html: cannot write: {other} is not a directory", process.stderr)
        os.truncate(results / "results.h5", 3000)
        self.assertIn("results.h5", self.report(results, status=2).stderr)
        self.viewer.unlink()
        process = self.report(results, status=4)
        self.assertIn("share/ricochet/viewer.html", process.stderr)
        self.assertIn("build or install Ricochet again", process.stderr)

    def test_runs_without_displacements_stand_still(self):
        for field in ("von_mises", "contact_pressure", "stress"):
            with self.subTest(field):
                results = self.simulate(DISC, field, SHORT | {"output.fields": f'["{field}"]'})
                self.report(results)
                (data,) = (page := Page(results / "report.html")).runs
                self.assertEqual(data["body"]["deviations"], [])
                self.assertFalse(page.reals(data["body"]["mean"]).any())
                self.assertTrue(any("no displacements" in sentence for sentence in data["thinned"]))

    def test_what_is_missing_is_said(self):
        results = self.simulate(DISC, "disc", SHORT)

        def sentences(name, content):
            whole = (results / name).read_bytes()
            (results / name).write_bytes(content(whole))
            self.report(results)
            (results / name).write_bytes(whole)
            return " ".join(Page(results / "report.html").runs[0]["thinned"])

        self.assertIn("history.csv ends at step", sentences("history.csv", lambda text: b"".join(text.splitlines(True)[:99])))
        self.assertIn("of the 21 frames", sentences("results.xdmf", lambda text: text[:len(text) // 2]))
        self.assertIn("have 0 of the 21 frames", sentences("results.xdmf", lambda text: b""))
        self.assertIn("obstacles.xdmf has 0 of 21 frames", sentences("obstacles.xdmf", lambda text: b""))
        (results / "results.h5").unlink()
        self.report(results)
        self.assertIn("missing", " ".join(Page(results / "report.html").runs[0]["thinned"]))
        text = (results / "history.csv").read_text()
        for wrong in ("nan", "0"):
            rows = text.splitlines()
            fields = rows[50].split(",")
            rows[50] = ",".join([fields[0], wrong, *fields[2:]])
            (results / "history.csv").write_text("\n".join(rows) + "\n")
            self.assertIn("history.csv:51: the time", self.report(results, status=2).stderr)

    def test_numbers_that_are_none_are_judged(self):
        results = self.simulate(DISC, "disc", SHORT)
        path = results / "history.csv"
        header, *rows = path.read_text().splitlines()
        names = header.split(",")
        for column, judged in (("total_energy", "energy"), ("contact_work", "energy"), ("max_penetration", "penetration"),
                               ("contact_force_y", "force"), ("lowest.reaction_normal", "force")):
            with self.subTest(column):
                fields = [row.split(",") for row in rows]
                for row in fields[100:]:
                    row[names.index(column)] = "inf"
                path.write_text("\n".join([header, *(",".join(row) for row in fields)]) + "\n")
                self.report(results)
                judgement = Page(results / "report.html").runs[0]["judgement"]
                self.assertAlmostEqual(judgement[f"{judged}_broken_at"], 0.01, delta=1e-12)
                others = {"energy", "penetration", "force"} - {judged}
                self.assertEqual([judgement[f"{other}_broken_at"] for other in others], [None, None])

    def test_an_infinite_depth_is_not_left_out(self):
        results = self.simulate(DISC, "disc", SHORT)
        summary = summary_of(results)
        summary["unwatched_penetration"]["found"] = [
            {"obstacle": "floor", "bodies": ["body 0"], "depth": "inf", "relative_depth": "inf", "time": 0.005,
             "place": [0.0, 0.0], "first_time": 0.005, "groups": [], "contact": None, "passed_through": False,
             "through_groups": []}]
        (results / "summary.json").write_text(json.dumps(summary))
        self.report(results)
        judgement = Page(results / "report.html").runs[0]["judgement"]
        self.assertEqual([judgement["penetration"], judgement["relative_penetration"]], ["inf", "inf"])
        # An unknown value is another matter.
        self.report(self.simulate(DISC, "without", SHORT | {"output.fields_every": 0}))
        self.assertIsNone(Page(self.folder / "without" / "report.html").runs[0]["judgement"]["relative_penetration"])

    def test_judgements(self):
        """An oscillating force is found in short and in sparsely written histories, rounding does not count, a
        divergence is recognized by its size, and without fields nothing is stated about the body's size."""
        rattling = {"time.scheme": "klr-conserving", "mass.type": "consistent", "output.fields_every": 0}
        for name, values in (("short", {"time.end": 0.03}), ("sparse", {"output.history_every": 7})):
            self.report(self.simulate(DISC, name, rattling | values))
            judgement = Page(self.folder / name / "report.html").runs[0]["judgement"]
            self.assertGreater(judgement["roughness"], 6, name)
            self.assertIsNone(judgement["relative_penetration"])
            self.assertGreater(judgement["penetration"], 0)
        case = DISC.parents[1] / "hertz" / "cylinder.toml"
        self.report(self.simulate(case, "static", {}))
        self.assertEqual(Page(self.folder / "static" / "report.html").runs[0]["judgement"]["roughness"], 1)
        self.report(self.simulate(DISC, "explosion", {"time.scheme": "newmark", "time.beta": 0.25, "time.gamma": 0.2, "time.end": 0.2}))
        judgement = Page(self.folder / "explosion" / "report.html").runs[0]["judgement"]
        self.assertGreater(judgement["energy_gain"], 1e12 * judgement["energy_scale"])

    def test_damaged_frames_are_named(self):
        results = self.simulate(DISC, "disc", SHORT)
        with h5py.File(results / "results.h5", "r+") as file:
            del file["frames/000003/displacement"]
        self.assertIn("/frames/000003/displacement", self.report(results, status=2).stderr)
        (results / "obstacles.xdmf").write_text('<Grid Name="obstacles" GridType="Uniform"><Time Value="x"/></Grid>')
        self.assertIn("obstacles.xdmf:1: 'x' is not a number", self.report(results, status=2).stderr)
