"""`ricochet study` used by mistake or with malice: messages, and files that stay unchanged."""

import json
import pathlib
import shutil
import subprocess

from harness import PROGRAM, RESPECTS_MODES, SOURCE, TestCase, run, settings

BAR = SOURCE / "cases" / "bar" / "impact.toml"
SHORT = {"time.end": 0.02, "output.fields_every": 0}


class StudyMisuse(TestCase):
    def study(self, name, *arguments, status=0, values=SHORT, case=BAR):
        self.output = self.folder / name
        return self.expect_status(status, run("study", case, *arguments, *settings(values), "-o", self.output, "--quiet"))

    def edit(self, change, file="study.json"):
        path = self.output / file
        content = json.loads(path.read_text())
        change(content)
        path.write_text(json.dumps(content))

    def refused(self, status, said, *arguments, before=()):
        """Refused, but not because of a defect of the program."""
        errors = self.expect_status(status, run(*arguments, before=before)).stderr
        for words in said if isinstance(said, tuple) else (said,):
            self.assertIn(words, errors)
        self.assertNotIn("internal error", errors)
        return errors

    def test_folders_that_are_not_the_studys_stay(self):
        precious = self.folder / "precious"
        precious.mkdir()
        (precious / "summary.json").write_text("{}")
        vary = ("--vary", "time.step=0.004,0.002")
        for folder in ("../../precious", str(precious), "..", ".", "", "a/../../../precious", ".hidden", "x\0y",
                       "001-step=0.004"):
            self.study("out", *vary)
            self.edit(lambda study: study["runs"].__setitem__(1, folder))
            for option in ("--force", "--resume"):
                self.refused(2, ("study.json: this file is damaged: ", "choose another directory"),
                             "study", BAR, *vary, *settings(SHORT), "-o", self.output, option)
            self.refused(2, "is damaged", "info", self.output)
            self.assertTrue((precious / "summary.json").exists(), folder)
            self.assertTrue((self.output / "runs" / "001-step=0.004" / "history.csv").exists())
            shutil.rmtree(self.output)

    def test_only_runs_are_removed(self):
        """In place of a run there is a link, or a file of the user."""
        vary = ("--vary", "time.step=0.004,0.002")
        self.study("out", *vary)
        second = self.output / "runs" / "002-step=0.002"
        elsewhere = self.folder / "elsewhere"
        second.rename(elsewhere)
        again = ("study", BAR, *vary, *settings(SHORT), "-o", self.output, "--force", "--quiet")
        second.symlink_to(elsewhere)
        self.refused(4, ("002-step=0.002: is a symbolic link", "is not removed"), *again)
        second.unlink()
        second.mkdir()
        (second / "thesis.tex").write_text("words")
        self.refused(4, "holds no files of a run", *again)
        self.assertTrue((second / "thesis.tex").exists())
        self.assertTrue((self.output / "runs" / "001-step=0.004" / "history.csv").exists(), "nothing is half done")
        shutil.rmtree(second)
        (self.output / "runs" / "notes").mkdir()
        self.expect_status(0, run(*again))
        self.assertTrue((self.output / "runs" / "notes").exists())
        runs = self.output / "runs"
        runs.rename(self.folder / "moved")
        runs.symlink_to(self.folder / "moved")
        self.refused(4, "runs: is a symbolic link", *again)
        self.assertTrue((self.folder / "moved" / "001-step=0.004" / "history.csv").exists())

    def test_benchmarks_remove_nothing_else_either(self):
        self.output = self.folder / "out"
        self.expect_status(0, run("benchmark", "rod", "-o", self.output, "--quiet"))
        precious = self.folder / "precious"
        precious.mkdir()
        (precious / "summary.json").write_text("{}")
        self.edit(lambda plan: plan["runs"][0].__setitem__("folder", "../../precious"), "benchmark.json")
        self.refused(2, ("benchmark.json: this file is damaged", "../../precious"),
                     "benchmark", "rod", "-o", self.output, "--force", "--quiet")
        self.assertTrue(precious.exists())

    def test_a_damaged_study_says_where(self):
        self.study("out", "--vary", "time.step=0.004,0.002")
        original = (self.output / "study.json").read_text()
        changes = {
            'there is no entry "axes"': lambda study: study.pop("axes"),
            '"runs" has 1 folder, but the values of "axes" result in 2 runs': lambda study: study["runs"].pop(),
            "0 values for 1 key": lambda study: study["axes"][0]["values"].__setitem__(0, []),
            "2 values for 1 key": lambda study: study["axes"][0]["values"].__setitem__(0, ["1", "2"]),
            "an axis has no keys or no values": lambda study: study["axes"][0].__setitem__("values", []),
            "nothing varies": lambda study: study.__setitem__("axes", []),
            "expected a text": lambda study: study["axes"][0]["keys"].__setitem__(0, {}),
            '"time.end" does not vary': lambda study: study["questions"].__setitem__("order", "time.end"),
            "is not a quantity": lambda study: study["questions"].__setitem__("quantities", ["steps"])}
        for said, change in changes.items():
            (self.output / "study.json").write_text(original)
            self.edit(change)
            for command in (("study", "--resume", self.output), ("info", self.output), ("report", self.output)):
                self.refused(2, (str(self.output / "study.json"), said, "choose another directory"), *command)
        (self.output / "study.json").write_text(original[:len(original) // 2])
        self.refused(2, ("is damaged", "line "), "study", "--resume", self.output)

    def test_a_study_that_is_not_there(self):
        nowhere = self.folder / "nosuchdir"
        for arguments in (("--resume", nowhere), ("--resume", "-o", nowhere)):
            self.refused(4, ("nosuchdir: there is no such directory", "ricochet study CASE.toml --vary"),
                         "study", *arguments)
        (self.folder / "empty").mkdir()
        self.refused(4, "empty: holds no study: study.json is missing", "study", "--resume", self.folder / "empty")
        output = self.simulate(BAR, "run", SHORT)
        self.refused(4, "run: holds a run, not a study; `ricochet run --resume`", "study", "--resume", output)
        self.assertFalse(nowhere.exists())

    def test_values_that_are_one(self):
        for vary, said in (("time.step=0.20,0.2", '"0.20" and "0.2" are the same value'),
                           ("time.scheme=newmark, newmark", '"newmark" appears twice'),
                           ("contact.00.friction=0,1", "write 0, as in contact.0.friction")):
            self.refused(1, said, "study", BAR, "--vary", vary, "-o", self.folder / "no")
        # With another spelling it is the same run.
        self.study("out", "--vary", "time.step=0.004,0.002")
        self.study("out", "--vary", "time.step=4e-3,0.0020", "--resume", values={"time.end": "2e-2",
                                                                                 "output.fields_every": 0})
        self.assertEqual(sorted(path.name for path in (self.output / "runs").iterdir()),
                         ["001-step=0.004", "002-step=0.002"])
        self.refused(2, "write 0, as in contact.0.friction", "run", BAR, "--set", "contact.00.friction=0", "-o",
                     self.folder / "no")

    def test_columns_that_no_run_has(self):
        """They are refused before the first run if that can be known, else reported at the end."""
        vary = ("--vary", "time.step=0.004,0.002")
        for question, said in (
                (("--quantity", "max(history.bottm.pressure)"), 'did you mean "bottom.pressure"?'),
                (("--quantity", "history.kinetic_enrgy[-1]"), 'did you mean "kinetic_energy"?'),
                (("--exact", "history.top.displacement_z[-1]=1"), "no column"),
                (("--quantity", "summary.stepss"), 'summary.json has no entry "stepss"; did you mean "steps"?'),
                (("--quantity", "summary.impacts.0.restituton"), 'no entry "impacts.0.restituton"; did you mean "impacts.0.restitution"?'),
                (("--exact", "summary.probe.0.position.0=1"), 'did you mean "probes.0.position.0"?'),
                (("--quantity", "summary.contacts.0.grup"), 'did you mean "contacts.0.group"?'),
                (("--quantity", "summary.impacts.restitution"), "specify the entry, counted from 0, as in summary.impacts.0.restitution"),
                (("--quantity", "summary.impacts.-1.restitution"), "not from the end, as in summary.impacts.0.restitution"),
                (("--quantity", "summary.extrema.lowest_gap.maximum"), 'no column "lowest_gap"'),
                (("--exact", "summary.extrema.kinetic_enrgy.maximum=1"), 'did you mean "kinetic_energy"?'),
                (("--quantity", "summary.extrema.top.displacment_y.maximum"), 'did you mean "top.displacement_y"?'),
                (("--quantity", "history.kinetic_energy(t=3)"), "the time 3 is outside the run, which extends from 0 to 0.02"),
                (("--quantity", "max(history.kinetic_energy, 0.01, 0.03)"), "the time 0.03 is outside the run"),
                (("--quantity", "history.kinetic_energy[11]"), "the row 11 is outside of history.csv, which has at most 11 rows"),
                (("--reference", "finest", "--compare", "top.displacment"), 'did you mean "top.displacement')):
            errors = self.refused(1, said, "study", BAR, *vary, *question, *settings(SHORT), "-o", self.folder / "no")
            self.assertIn(question[-2], errors)
            self.assertFalse((self.folder / "no").exists())
        reference = self.simulate(BAR, "reference", SHORT)
        self.refused(1, "--compare kinetic_enrgy", "study", BAR, *vary, "--reference", reference, "--compare",
                     "kinetic_enrgy", *settings(SHORT), "-o", self.folder / "no")
        self.study("moved", *vary, "--reference", reference)
        reference.rename(self.folder / "elsewhere")
        self.refused(1, "name another with --reference", "study", "--resume", self.output)
        self.assertIn("was moved or removed", self.expect_status(0, run("info", self.output)).stderr)
        # A probe that only some of the runs have.
        self.study("probes", "--vary", "probe.0.name=low,lower", "--quantity", "max(history.low.gap)")
        self.refused(1, "no column", "study", BAR, "--vary", "probe.0.name=low,lower", "--quantity",
                     "history.kinetic_enrgy[-1]", *settings(SHORT), "-o", self.folder / "no")
        process = self.study("none", "--vary", "probe.0.name=low,lower", "--quantity", "max(history.lo.gap)", status=1)
        self.assertIn("--quantity max(history.lo.gap): history.csv has no column", process.stderr)
        self.assertIn("history.csv has no column", (self.output / "study.md").read_text())
        self.assertIn("2 of 2 runs done", process.stdout)
        self.refused(1, 'probe "top" has "every"', "study", BAR, *vary, "--quantity", "max(history.top.displacement_y)",
                     *settings(SHORT | {"probe.1.every": 2}), "-o", self.folder / "no")
        # Entries that depend on the results are reported afterwards, and are no mistake if some run has them.
        process = self.study("late", *vary, "--quantity", "summary.impacts.7.restitution", status=1)
        self.assertIn("--quantity summary.impacts.7.restitution", process.stderr)
        self.study("some", "--vary", "time.end=0.02,0.04", "--quantity", "history.time(t=0.03)",
                   values={"output.fields_every": 0})
        self.study("extrema", *vary, "--quantity", "summary.extrema.top.displacement_y.maximum")
        # The bounds are those of the longest run, wherever it is among them.
        for ends in ("0.04,0.02", "0.02,0.04"):
            for question, said in (("history.time(t=0.05)", "from 0 to 0.04"), ("history.time[30]", "at most 21 rows")):
                self.refused(1, said, "study", BAR, "--vary", f"time.end={ends}", "--quantity", question, "-o",
                             self.folder / "no", *settings({"time.step": 0.002}))

    def test_names_stay_what_they_are(self):
        """Names given by a user, a case or a mesh are not markup, whatever they look like."""
        title = "<b>x</b> | `a` ](http://example.org) $y$"
        self.study("out", "--vary", f'title="{title}",plain <i>,"a*b*"', values=SHORT)
        text = (self.output / "study.md").read_text()
        for line in text.splitlines():
            self.assertNotRegex(line, r"<[a-z/]")
        self.assertIn(r"&lt;b&gt;x&lt;/b&gt; \| \`a\` ]\(http://example.org) \$y\$", text)
        self.assertIn(r"a\*b\*", text)
        rows = [line for line in text.splitlines() if line.startswith("|")]
        self.assertEqual({line.replace("\\|", "").count("|") for line in rows[:5]}, {rows[0].count("|")})
        self.expect_status(0, run("report", self.output))
        page = (self.output / "report.html").read_text()
        self.assertIn("&lt;b&gt;x&lt;/b&gt;", page)
        self.assertNotIn("<b>x", page)
        self.expect_status(0, run("plot", self.output, "--what", "processor_seconds-against-title", "-o",
                                  self.folder / "figure.svg"))

    def test_two_studies_in_one_directory(self):
        slow = {"time.end": 4, "output.fields_every": 0}
        self.output = self.folder / "out"
        command = ["study", str(BAR), "--vary", "time.step=0.0005,0.00025", *settings(slow), "-o", str(self.output),
                   "--quiet"]
        first = subprocess.Popen([str(PROGRAM), *command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            while not (self.output / "study.json").exists():
                self.assertIsNone(first.poll())
            for option in ("--resume", "--force"):
                self.refused(4, "another run is writing into this directory", *command, option)
        finally:
            first.terminate()
            first.wait()

    def test_a_directory_that_is_read_only(self):
        folder = self.folder / "locked"
        folder.mkdir(mode=0o500)
        for output in (folder / "out", folder):
            self.refused(4, "locked", "study", BAR, "--vary", "time.step=0.004", "-o", output, before=RESPECTS_MODES)

    def test_output_that_nobody_reads(self):
        """The study is made nonetheless, and its exit status states that its table could not be printed."""
        self.output = self.folder / "out"
        command = [str(PROGRAM), "study", str(BAR), "--vary", "time.step=0.004,0.002", *settings(SHORT), "-o",
                   str(self.output), "--quiet"]
        with open("/dev/full", "w", encoding="utf-8") as full:
            process = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(process.returncode, 4, process.stderr)
        self.assertIn("standard output", process.stderr)
        self.assertEqual(len(pathlib.Path(self.output / "study.csv").read_text().splitlines()), 3)

    def test_jobs(self):
        for jobs in ("0", "-1", "many", "1025"):
            self.refused(1, "--jobs", "study", BAR, "--vary", "time.step=0.004", "-o", self.folder / "no", "--jobs", jobs)
        self.refused(1, "more than 10000 runs", "study", BAR, "--vary",
                     "time.step=" + ",".join(f"{i}e-5" for i in range(1, 10002)), "-o", self.folder / "no")
        self.assertFalse((self.folder / "no").exists())
