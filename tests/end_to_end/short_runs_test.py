"""A short run of the disc through its first contact under every scheme: small enough for a build with sanitizers."""

from harness import DISC, SCHEMES, History, TestCase, method, run, summary_of


class ShortRuns(TestCase):
    def test_the_disc_touches_and_its_account_closes(self):
        for scheme in SCHEMES:
            with self.subTest(scheme):
                values = method(scheme) | {"time.step": 5e-4, "time.end": 0.015}
                history = History(self.simulate(DISC, scheme, values) / "history.csv")
                self.assertEqual(history["step"], list(range(31)))
                self.assertGreater(max(history["contact_force_y"]), 0.0)
                self.assertGreater(max(history["active_contacts"]), 1.0)
                self.assertLessEqual(max(map(abs, history["energy_residual"])), 1e-10 * history.largest_energy())

    def test_the_critical_step_is_reported_and_refused(self):
        values = {"time.scheme": "semi-explicit", "mass.type": "equivalent-lumped", "time.step": 5e-4, "time.end": 0.005}
        results = self.simulate(DISC, values=values)
        summary = summary_of(results)
        critical = summary["critical_time_step"]
        self.assertAlmostEqual(summary["critical_fraction"], 5e-4 / critical, delta=1e-12)
        described = self.expect_status(0, run("info", results)).stdout
        self.assertIn(f"critical step {critical:.6g}; the step is {5e-4 / critical:.3g} of it", described)
        refused = run("run", DISC, "-o", self.folder / "refused", "--set", "time.scheme=semi-explicit", "--set",
                      "mass.type=equivalent-lumped", "--set", f"time.step={1.2 * critical}")
        self.assertIn(f"1.2 times the critical step, {critical:.6g}", self.expect_status(2, refused).stderr)
        # Other schemes have none.
        implicit = self.simulate(DISC, "implicit", {"time.end": 0.001})
        self.assertIsNone(summary_of(implicit)["critical_time_step"])
