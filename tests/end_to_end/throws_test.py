"""Some of the random throws of ./dev bench throws, judged as there."""

import os
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["RICOCHET_SOURCE_DIR"])
sys.path.insert(0, str(SOURCE / "bench" / "throws"))

import run as throws  # noqa: E402


class Throws(unittest.TestCase):
    def test_none_fails_goes_through_or_gains_energy(self):
        touched = 0
        with tempfile.TemporaryDirectory(prefix="ricochet-throws-") as folder:
            for seed in range(1001, 1007):
                _, wrong, touches = throws.throw(seed, pathlib.Path(folder), False)
                self.assertEqual(wrong, [], f"throw {seed}")
                touched += touches
        self.assertGreater(touched, 3)


if __name__ == "__main__":
    unittest.main()
