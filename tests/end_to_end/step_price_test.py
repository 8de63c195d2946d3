"""A step costs about as much as a triangular solve: checked by timings of bench/step."""

import os
import pathlib
import subprocess
import sys

from harness import SOURCE, TestCase

BENCH = pathlib.Path(os.environ["RICOCHET_BUILD_DIR"]) / "ricochet_step_bench"
sys.path.insert(0, str(SOURCE / "bench" / "step"))


class StepPrice(TestCase):
    def price(self, body):
        import run

        path = run.case(self.folder, body)
        # The machine may be busy: the best of three.
        for _ in range(3):
            process = subprocess.run([BENCH, path, "--steps", "130", "--at-most", "1.5"], text=True, capture_output=True, timeout=300)
            if process.returncode == 0:
                return
        self.fail(process.stdout + process.stderr)

    def test_disc(self):
        self.price(("disc", 2, 0.0202))

    def test_ball(self):
        self.price(("ball", 3, 0.13))
