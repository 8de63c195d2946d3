"""A short run of the disc through its first contact under every scheme: small enough for a build with sanitizers."""

import unittest

from harness import DISC, History, SCHEMES, TestCase


class ShortRuns(TestCase):
    def test_the_disc_touches_and_its_account_closes(self):
        for scheme, mass in SCHEMES.items():
            with self.subTest(scheme):
                values = {"time.scheme": scheme, "mass.type": mass, "time.step": 5e-4, "time.end": 0.015}
                history = History(self.simulate(DISC, scheme, values) / "history.csv")
                self.assertEqual(history["step"], list(range(31)))
                self.assertGreater(max(history["contact_force_y"]), 0.0)
                self.assertGreater(max(history["active_contacts"]), 1.0)
                self.assertLessEqual(max(map(abs, history["energy_residual"])), 1e-10 * history.largest_energy())


if __name__ == "__main__":
    unittest.main()
