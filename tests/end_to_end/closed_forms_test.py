"""The reference values of benchmarks/ and of the cases with closed forms agree with those recomputed by
benchmarks/closed_forms.py."""

import subprocess
import sys
import unittest

from harness import SOURCE
import closed_forms


class ClosedForms(unittest.TestCase):
    def test_reference_values(self):
        script = SOURCE / "benchmarks" / "closed_forms.py"
        done = subprocess.run([sys.executable, "-B", script], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertGreater(len(done.stdout.splitlines()), 150)

    def test_the_table_of_the_tests_in_cpp_is_up_to_date(self):
        self.assertEqual(closed_forms.TABLE.read_text(encoding="ascii"), closed_forms.table(), "run benchmarks/closed_forms.py --table")
