"""The disc of the source's section 6 confirms its claims: the effects of each of its three schemes on energy, contact
force and interpenetration, at a time step of 1e-4 over 0.15 s. The semi-explicit scheme preserves the properties of the
equivalent mass."""

from harness import DISC, History, SCHEMES, TestCase, method, total_variation

RADIUS = 0.02
STEPS = 1500
CLOSED_FORM_ENERGY = 0.5 * 6000.0 * 3.141592653589793 * RADIUS**2 * 0.1**2


class DiscClaims(TestCase):
    def histories(self):
        found = {}
        for scheme in SCHEMES:
            values = method(scheme) | {"time.step": "1e-4", "time.end": "0.15", "output.fields_every": 0}
            found[scheme] = History(self.simulate(DISC, scheme, values) / "history.csv")
            self.assertEqual(found[scheme]["step"][-1], STEPS)
        return found

    def test_the_claims_of_the_source(self):
        histories = self.histories()
        energy = {scheme: history["total_energy"] for scheme, history in histories.items()}
        variation = {scheme: total_variation(history["lowest.reaction_normal"])
                     for scheme, history in histories.items()}
        for scheme, history in histories.items():
            # The polygon of the mesh has a slightly smaller area than the disc.
            self.assertAlmostEqual(energy[scheme][0] / CLOSED_FORM_ENERGY, 1.0, delta=0.01, msg=scheme)
            self.assertGreater(max(history["lowest.reaction_normal"]), 0.0, f"{scheme}: the disc never touched")
            # It touches at 7.35 ms and not before.
            touching = [t for t, force in zip(history["time"], history["contact_force_y"]) if force > 0.0]
            self.assertAlmostEqual(touching[0], 7.35e-3, delta=2e-4, msg=scheme)
            rise = abs(energy[scheme][0]) if scheme != "midpoint" else history.largest_energy()
            self.assertLessEqual(max(map(abs, history["energy_residual"])), 1e-10 * rise, scheme)

        conserving = energy["klr-conserving"]
        drift = max(abs(value - conserving[0]) for value in conserving) / conserving[0]
        self.assertLessEqual(drift, 1e-10, "klr-conserving keeps its half-step energy")

        loss = {scheme: abs(energy[scheme][-1] / energy[scheme][0] - 1.0) for scheme in ("newmark", "semi-explicit", "reduced-kane")}
        for scheme in loss:
            self.assertLessEqual(loss[scheme], 2e-3, f"{scheme}, no contact inertia: energy at the end")
            self.assertLessEqual(max(histories[scheme]["max_penetration"]), 1e-12 * RADIUS, scheme)
            self.assertLessEqual(100.0 * variation[scheme], variation["klr-conserving"],
                                 f"{scheme}, no contact inertia: a smooth contact force")
        self.assertGreater(max(histories["klr-conserving"]["max_penetration"]), 1e-4 * RADIUS,
                           "klr-conserving sinks in a little")

        growth = max(energy["midpoint"]) / energy["midpoint"][0]
        self.assertGreater(growth, 50.0, "midpoint creates energy")
        print(f"klr-conserving: drift {drift:.1e}, variation {variation['klr-conserving']:.4g}; "
              f"newmark: loss {loss['newmark']:.2e}, variation {variation['newmark']:.4g}; "
              f"semi-explicit: loss {loss['semi-explicit']:.2e}, variation {variation['semi-explicit']:.4g}; "
              f"midpoint: energy x {growth:.4g}")

    def test_the_figure_that_the_source_was_looking_for(self):
        """The default satisfies energy and momentum in every step up to rounding, with a smooth force and no
        interpenetration."""
        run = self.simulate(DISC, "default", {"output.fields_every": 0})
        history = History(run / "history.csv")
        energy = history["total_energy"]
        self.assertLessEqual(max(abs(value - energy[0]) for value in energy), 1e-11 * energy[0])
        self.assertLessEqual(max(history["max_penetration"]), 1e-12 * RADIUS)
        self.assertGreater(max(history["lowest.reaction_normal"]), 10.0)
        self.assertLess(total_variation(history["lowest.reaction_normal"]), 60.0)  # 39 is the minimum
