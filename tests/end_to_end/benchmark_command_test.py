"""`ricochet benchmark`: its table agrees with the runs, failed expectations are marked, methods are compared."""

import csv

from harness import SOURCE, TestCase, run, summary_of

SHORT = ("sdnv100", "rod", "incline-held")


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


class Benchmark(TestCase):
    def benchmark(self, *arguments, status=0):
        return self.expect_status(status, run("benchmark", *arguments, "--quiet"))

    def folder_with(self, *expectations, more=""):
        """Makes a folder of benchmarks with the rod, which has another expectation, and the block on a slope."""
        folder = self.folder / "own"
        folder.mkdir()
        rod = SOURCE / "cases" / "rod" / "rod.toml"
        text = rod.read_text(encoding="utf-8").split("[[expect]]")[0].replace('file = "', f'file = "{rod.parent}/')
        entries = "".join(f"[[expect]]\n{entry}\n" for entry in expectations)
        (folder / "rod.toml").write_text(text + entries, encoding="utf-8")
        (folder / "benchmarks.toml").write_text(
            '[[benchmark]]\nname = "rod"\ncase = "rod.toml"\ndescription = "a rod"\n'
            f'[[benchmark]]\nname = "slope"\ncase = "{SOURCE}/cases/incline/held.toml"\n{more}', encoding="utf-8")
        return folder

    def test_table_says_what_the_runs_say(self):
        output = self.folder / "out"
        process = self.benchmark(*SHORT, "-o", output)
        rows = rows_of(output / "benchmark.csv")
        self.assertEqual(list(rows[0]), ["case", "quantity", "reference", "value", "error", "tolerance", "published",
                                         "scheme", "mass", "holds"])
        self.assertEqual(list(dict.fromkeys(row["case"] for row in rows)), list(SHORT))
        for name in SHORT:
            summary = summary_of(output / "runs" / name)
            expected = [entry for entry in summary["expectations"] if entry["checked"]]
            own = [row for row in rows if row["case"] == name]
            self.assertEqual(len(own), len(expected))
            self.assertGreater(len(own), 4)
            for row, entry in zip(own, expected):
                self.assertEqual(row["quantity"], entry["name"] or entry["quantity"])
                self.assertEqual(float(row["value"]), entry["value"])
                self.assertEqual((row["published"], row["holds"]), (entry["published"], "yes"))
                self.assertEqual((row["scheme"], row["mass"]), (summary["scheme"], summary["mass"]))
                if "wanted_value" in entry:
                    self.assertEqual(float(row["reference"]), entry["wanted_value"])
                    self.assertEqual(float(row["error"]), entry["value"] - entry["wanted_value"])
                    self.assertEqual(float(row["tolerance"]), entry["tolerance"])
                else:
                    self.assertRegex(row["reference"], "^[≤≥] ")
                    self.assertEqual((float(row["error"]), row["tolerance"]), (0, ""))
        self.assertIn(f"{len(rows)} of {len(rows)} expected values hold", process.stdout)
        self.assertNotIn("DOES NOT HOLD", process.stdout)
        self.assertIn("| rod |", (output / "benchmark.md").read_text(encoding="utf-8"))
        # Printed again, and kept; not overwritten by accident.
        self.assertEqual(self.expect_status(0, run("info", output)).stdout, process.stdout)
        self.expect_status(0, run("report", output))
        self.assertIn('href="runs/rod"', (output / "report.html").read_text(encoding="utf-8"))
        self.assertIn("--force", self.benchmark("rod", "-o", output, status=4).stderr)
        before = (output / "runs" / "rod" / "summary.json").stat().st_mtime_ns
        self.benchmark("rod", "-o", output, "--resume")
        self.assertEqual((output / "runs" / "rod" / "summary.json").stat().st_mtime_ns, before)
        self.assertEqual([path.name for path in (output / "runs").iterdir()], ["rod"])

    def test_what_does_not_hold_is_marked(self):
        folder = self.folder_with('name = "energy"\nquantity = "history.total_energy[0]"\nvalue = 1.0\nrelative = 1e-3',
                                  'name = "least"\nquantity = "summary.steps"\nminimum = 299\npublished = "a, b"')
        process = self.benchmark("--folder", folder, "-o", self.folder / "out", status=5)
        self.assertEqual(process.stdout.count("DOES NOT HOLD"), 1)
        self.assertRegex(process.stdout, "rod +energy .*DOES NOT HOLD")
        energy, least = [row for row in rows_of(self.folder / "out" / "benchmark.csv") if row["case"] == "rod"]
        self.assertEqual((energy["holds"], least["holds"]), ("no", "yes"))
        self.assertEqual((least["reference"], least["published"]), ("≥ 299", "a, b"))
        self.assertIn("DOES NOT HOLD", (self.folder / "out" / "benchmark.md").read_text(encoding="utf-8"))

    def test_runs_that_fail_or_are_refused(self):
        """A limit below 0 is invalid, and an account that cannot close so well stops a run."""
        folder = self.folder_with('quantity = "summary.steps"\nminimum = 1',
                                  more='[[benchmark]]\nname = "stops"\ncase = "stops.toml"\n')
        text = (folder / "rod.toml").read_text(encoding="utf-8")
        (folder / "stops.toml").write_text(text + "[check]\nenergy_residual = 1e-18\non_failure = \"stop\"\n", encoding="utf-8")
        process = self.benchmark("--folder", folder, "-o", self.folder / "failed", status=3)
        self.assertRegex(process.stdout, r"stops: failed at t = \S+: ")
        row = rows_of(self.folder / "failed" / "benchmark.csv")[-1]
        self.assertEqual((row["case"], row["value"], row["holds"]), ("stops", "", "no"))
        (folder / "stops.toml").write_text(text + "[check]\nenergy_residual = -1\n", encoding="utf-8")
        self.assertIn("stops: refused", self.benchmark("--folder", folder, "-o", self.folder / "refused", status=2).stdout)

    def test_names(self):
        listed = self.benchmark("--list").stdout
        for name in SHORT:
            self.assertRegex(listed, rf"(?m)^{name} ")
        process = self.benchmark("sdnv10", "-o", self.folder / "out", status=1)
        self.assertIn('there is no "sdnv10" (did you mean "sdnv100"?); available: sdnv100, vm265', process.stderr)
        self.assertFalse((self.folder / "out").exists())
        self.assertIn("no benchmarks.toml", self.benchmark("--folder", self.folder, status=4).stderr)
        self.assertIn('(did you mean "newmark"?)', self.benchmark("--scheme", "newmrk", status=1).stderr)

    def test_every_published_case_is_listed(self):
        manifest = (SOURCE / "benchmarks" / "benchmarks.toml").read_text(encoding="utf-8")
        for path in (SOURCE / "benchmarks").glob("*/*.toml"):
            self.assertIn(f'case = "{path.parent.name}/{path.name}"', manifest)

    def test_scorecard(self):
        """The default keeps energy and reproduces all values; central differences take a step of their own; a scheme
        without friction is refused for cases with friction, which does not count as failure."""
        output = self.folder / "out"
        process = self.benchmark("rod", "incline-held", "-o", output, "--scheme",
                                 "reduced-kane,mean-reaction,taylor-flanagan,newmark/consistent", status=5)
        rows = {(row["scheme"], row["benchmark"]): row for row in rows_of(output / "scorecard.csv")}
        self.assertEqual(len(rows), 8)
        for (scheme, name), row in rows.items():
            if row["status"] == "refused":
                self.assertEqual((scheme, name, row["holds"]), ("mean-reaction", "incline-held", ""))
                self.assertIn("does not support friction", row["message"])
                continue
            folder = next((output / "runs").glob(f"{name}-{scheme}*"))
            summary = summary_of(folder)
            self.assertEqual((row["mass"], row["status"]), (summary["mass"], "done"))
            self.assertEqual(int(row["steps"]), summary["steps"])
            self.assertAlmostEqual(float(row["created_percent"]), 100 * summary["energy_budget"]["created_by_method"])
            values = [value for value in rows_of(output / "benchmark.csv")
                      if (value["scheme"], value["case"]) == (scheme, name)]
            self.assertEqual(int(row["applies"]), len(values))
            self.assertEqual(int(row["holds"]), sum(value["holds"] == "yes" for value in values))
        default, explicit = rows["reduced-kane", "rod"], rows["taylor-flanagan", "rod"]
        self.assertEqual(default["holds"], default["applies"])
        self.assertEqual(float(explicit["time_step"]), float(default["time_step"]))  # below the critical one
        self.assertLess(float(rows["taylor-flanagan", "incline-held"]["time_step"]),
                        float(rows["reduced-kane", "incline-held"]["time_step"]))
        self.assertEqual((explicit["mass"], rows["newmark", "rod"]["mass"]), ("lumped", "consistent"))
        self.assertGreater(float(rows["newmark", "rod"]["created_percent"]), 10)
        card = (output / "scorecard.md").read_text(encoding="utf-8")
        self.assertIn("| mean-reaction | equivalent | refused (1) |", card)
        self.assertIn('1. scheme "mean-reaction" does not support friction', process.stdout)
        # Refusals do not count.
        self.benchmark("incline-held", "-o", self.folder / "refused", "--scheme", "mean-reaction")
