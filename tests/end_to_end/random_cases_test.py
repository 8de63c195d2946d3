"""Random cases under every scheme: what docs/energy.md says of the default, on the first of its 2,400 cases."""

import collections
import csv
import io
import os
import pathlib
import subprocess
import unittest

from harness import TestCase

PROGRAM = pathlib.Path(os.environ["RICOCHET_BUILD_DIR"]) / "ricochet_random_cases"
CASES = 48


class RandomCases(TestCase):
    def test_the_default_creates_no_energy_and_never_fails(self):
        output = subprocess.run([str(PROGRAM), "1", str(CASES)], capture_output=True, text=True, check=True).stdout
        rows = collections.defaultdict(list)
        for row in csv.DictReader(io.StringIO(output)):
            rows[row["method"]].append(row)
        for method in ("reduced-kane end, equivalent", "reduced-kane adaptive, equivalent", "reduced-kane, equivalent",
                       "reduced-kane, equivalent-cellwise"):
            self.assertEqual(len(rows[method]), CASES)
            for row in rows[method]:
                self.assertEqual(row["failure"], "", f"{method}: {row['description']}")
        for method, of_method in rows.items():
            if not method.startswith(("reduced-kane", "mean-reaction", "contact-stabilized")):
                continue
            for row in of_method:
                name = f"{method}: case {row['case']}, {row['description']}"
                self.assertLessEqual(float(row["created"]), 1e-8, name)
                self.assertLessEqual(float(row["penetration"]), 1e-10, name)
        # The same measure finds what others create.
        created = [float(row["created"]) > 0.01 for row in rows["newmark trapezoidal, equivalent"]]
        self.assertGreater(sum(created), CASES // 4)


if __name__ == "__main__":
    unittest.main()
