"""The reference values of benchmarks/ and of the cases with closed forms agree with those recomputed by
benchmarks/closed_forms.py."""

import subprocess
import sys
import unittest

from harness import SOURCE


class ClosedForms(unittest.TestCase):
    def test_reference_values(self):
        script = SOURCE / "benchmarks" / "closed_forms.py"
        done = subprocess.run([sys.executable, "-B", script], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertGreater(len(done.stdout.splitlines()), 150)


if __name__ == "__main__":
    unittest.main()
