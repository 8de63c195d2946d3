"""Random cases under every scheme: the statements of docs/energy.md about the default, on the first of its cases."""

import collections
import csv
import io
import os
import pathlib
import subprocess

from harness import TestCase

PROGRAM = pathlib.Path(os.environ["RICOCHET_BUILD_DIR"]) / "ricochet_random_cases"
CASES = {"plane": 40, "sphere": 16, "turn": 24, "pair": 40}
DEFAULT = ("reduced-kane end, equivalent", "reduced-kane adaptive, equivalent", "reduced-kane, equivalent",
           "reduced-kane, equivalent-cellwise")


class RandomCases(TestCase):
    def run_cases(self, kind, *method):
        output = subprocess.run([str(PROGRAM), kind, "1", str(CASES[kind]), *method], capture_output=True, text=True, check=True).stdout
        rows = collections.defaultdict(list)
        for row in csv.DictReader(io.StringIO(output)):
            rows[row["method"]].append(row)
        for method in DEFAULT:
            self.assertEqual(len(rows[method]), CASES[kind])
            for row in rows[method]:
                # Some pairs of bodies do not face each other at the start, which is reported.
                faces = kind != "pair" or "do not face each other" not in row["failure"]
                self.assertEqual(row["failure"] if faces else "", "", f"{method}: {row['description']}")
        return rows

    def check_energy(self, rows, schemes):
        for method, of_method in rows.items():
            if not method.startswith(schemes):
                continue
            for row in of_method:
                name = f"{method}: case {row['case']}, {row['description']}"
                self.assertLessEqual(float(row["created"]), 1e-8, name)
                self.assertLessEqual(float(row["penetration"]), 1e-10, name)

    def test_the_default_creates_no_energy_and_never_fails(self):
        rows = self.run_cases("plane")
        self.check_energy(rows, ("reduced-kane", "mean-reaction", "contact-stabilized"))
        # The same measure detects energy created by other schemes.
        created = [float(row["created"]) > 0.01 for row in rows["newmark trapezoidal, equivalent"]]
        self.assertGreater(sum(created), CASES["plane"] // 4)

    def test_nor_does_it_on_balls_and_in_hollows(self):
        self.check_energy(self.run_cases("sphere", "reduced-kane"), "reduced-kane")

    def test_nor_on_obstacles_that_turn(self):
        rows = self.run_cases("turn", "reduced-kane")
        self.check_energy(rows, "reduced-kane")
        touched = [float(row["largest"]) > 0.0 for row in rows["reduced-kane, equivalent"]]
        self.assertGreater(sum(touched), CASES["turn"] // 2)

    def test_nor_where_bodies_slide_over_ends_and_corners(self):
        """Also in steps whose pairs are frozen while points are over a rim, as in cases 132 and 251."""
        rows = []
        for first, count in (("1", "16"), ("132", "1"), ("251", "1")):
            output = subprocess.run([str(PROGRAM), "slide", first, count, DEFAULT[0]], capture_output=True, text=True, check=True).stdout
            rows += csv.DictReader(io.StringIO(output))
        ended = [row for row in rows if "overlap at the start" not in row["failure"]]
        self.assertGreater(len(ended), 12)
        for row in ended:
            self.assertEqual(row["failure"], "", row["description"])
            self.assertLessEqual(float(row["created"]), 1e-8, row["description"])
        self.assertGreater(sum(int(row["held"]) for row in ended), 0)

    def test_nor_between_bodies_whose_meshes_do_not_match(self):
        rows = self.run_cases("pair", "reduced-kane")
        self.check_energy(rows, "reduced-kane")
        touched = [float(row["largest"]) > 0.0 for row in rows["reduced-kane, equivalent"]]
        self.assertGreater(sum(touched), CASES["pair"] // 2)
