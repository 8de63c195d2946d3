"""Energy gained or lost by the method in a run, and the reactions that acted: in summary.json, in words, in tables."""

import re

from harness import DISC, History, TestCase, block_case, run, summary_of

# Steps of several wave crossings of a cell, in which the end reactions lose energy.
LONG = {"time.scheme": "reduced-kane", "mass.type": "equivalent", "time.step": 1e-3, "time.end": 0.05, "output.fields_every": 0}


def percent(part):
    return f"{100 * part:.{2 if part < 0.1 else 3}g} %"


def of_method(history):
    algorithmic = history["algorithmic_energy"]
    return [work - taken - (term - algorithmic[0])
            for work, taken, term in zip(history["contact_work"], history["numerical_dissipation"], algorithmic)]


class MethodEnergy(TestCase):
    def said(self, folder):
        """Returns the line of `ricochet info`."""
        [line] = [line for line in self.expect_status(0, run("info", folder)).stdout.splitlines() if line.startswith("  the method ")]
        return line

    def test_it_is_what_is_missing_in_the_total_energy(self):
        """Only contact acts on the disc: the energy lost since the start is that of the method."""
        for name, values in (("end", {"time.reaction_weight": "end"}), ("newmark", {"time.scheme": "newmark", "time.preset": "textbook-half", "time.step": 2e-3}),
                             ("midpoint", {"time.scheme": "midpoint", "mass.type": "consistent"})):
            with self.subTest(name):
                folder = self.simulate(DISC, name, LONG | values)
                history = History(folder / "history.csv")
                budget, scale = summary_of(folder)["energy_budget"], history.largest_energy()
                self.assertEqual(budget["largest_energy"], scale)
                changes = [(energy - history["total_energy"][0]) / scale for energy in history["total_energy"]]
                self.assertAlmostEqual(budget["lost_by_method"], -min(changes), delta=1e-8)
                self.assertAlmostEqual(budget["created_by_method"], max(changes), delta=1e-8)
                self.assertAlmostEqual(budget["at_end"]["method"], changes[-1], delta=1e-8)
                put_in = [energy / scale for energy in of_method(history)]
                self.assertAlmostEqual(budget["lost_by_method"], -min(put_in), delta=1e-14)
                self.assertAlmostEqual(budget["created_by_method"], max(put_in), delta=1e-14)
                self.assertAlmostEqual(budget["at_end"]["method"], put_in[-1], delta=1e-14)
                self.assertEqual([value for key, value in budget["at_end"].items() if key != "method"], 5 * [0.0])
                most = max(-min(put_in), max(put_in))
                self.assertGreater(most, 1e-3, "otherwise the test proves nothing")
                self.assertRegex(self.said(folder), rf"{'created' if name == 'midpoint' else 'lost'} (up to )?{re.escape(percent(most))} ")

    def test_percentages_are_those_of_an_energy_that_is_shown(self):
        """Gravity has a potential: the total energy of a falling block is 0 at the start and never above."""
        folder = self.simulate(self.write("block.toml", block_case()), "block", {"time.end": 0.1})
        found = summary_of(folder)
        self.assertLess(found["extrema"]["total_energy"]["maximum"], 1e-6 * found["energy_scale"])
        self.assertIn(f"; largest total, kinetic or elastic energy {found['energy_scale']:.6g}\n", self.expect_status(0, run("info", folder)).stdout)

    def test_friction_is_another_thing(self):
        folder = self.simulate(DISC, "friction", LONG | {"contact.0.friction": 0.3, "initial.velocity": "[0.1,-0.1]"})
        history, found = History(folder / "history.csv"), summary_of(folder)
        budget, scale = found["energy_budget"], history.largest_energy()
        self.assertAlmostEqual(budget["lost_by_method"], -min(of_method(history)) / scale, delta=1e-14)
        self.assertLess(budget["at_end"]["friction"], -1e-4, "otherwise the test proves nothing")
        self.assertAlmostEqual(budget["at_end"]["friction"], history["friction_work"][-1] / scale, delta=1e-14)
        # "automatic" selects the end reactions with friction.
        self.assertEqual(found["reactions"], {"acting": "end", "least_end_weight": None, "largest_end_weight": None, "steps_of_means": 0,
                                              "steps_without_mean": 0})
        self.assertTrue(self.said(folder).endswith("; reactions: those at the end of the step"), self.said(folder))
        adaptive = self.simulate(DISC, "friction-adaptive", LONG | {
            "contact.0.friction": 0.3, "initial.velocity": "[0.1,-0.1]", "time.reaction_weight": "adaptive"})
        acting = summary_of(adaptive)["reactions"]
        self.assertEqual(acting["acting"], "adaptive")
        self.assertGreater(acting["steps_of_means"], 10)
        self.assertLess(acting["steps_without_mean"], 0.1 * acting["steps_of_means"])
        self.assertRegex(self.said(adaptive), "; reactions: the mean over the step")
        self.assertLess(summary_of(adaptive)["energy_budget"]["lost_by_method"], budget["lost_by_method"])

    def test_it_does_not_depend_on_the_rows_that_are_written(self):
        often, rarely = (summary_of(self.simulate(DISC, f"every-{every}", LONG | {"time.reaction_weight": "end", "output.history_every": every}))
                         for every in (1, 7))
        energies = [[found["energy_budget"]["largest_energy"] * found["energy_budget"][key] for key in ("lost_by_method", "created_by_method")]
                    for found in (often, rarely)]
        for a, b in zip(*energies):
            self.assertAlmostEqual(a, b, delta=1e-14 * often["energy_budget"]["largest_energy"])

    def test_the_weights_that_acted(self):
        """Below a wave crossing the mean itself acts and keeps the energy; above, up to a third of the end reactions
        contribute."""
        folder = self.simulate(DISC, "fine", LONG | {"time.step": 1e-4})
        found, history = summary_of(folder), History(folder / "history.csv")
        touching = sum(count > 0 for count in history["active_contacts"])
        reactions = found["reactions"]
        self.assertEqual([reactions[key] for key in ("acting", "least_end_weight", "largest_end_weight", "steps_without_mean")], ["adaptive", 0, 0, 0])
        # A mean also acts in the step in which a point separates.
        self.assertGreaterEqual(reactions["steps_of_means"], touching)
        self.assertLessEqual(reactions["steps_of_means"], 1.2 * touching)
        self.assertRegex(self.said(folder), r"^  the method conserved the energy to within \S+ of the largest; reactions: the mean over the step$")
        folder = self.simulate(DISC, "coarse", LONG | {"time.step": 1e-2, "time.end": 0.1})
        reactions = summary_of(folder)["reactions"]
        self.assertGreater(reactions["largest_end_weight"], 0.05)
        self.assertLessEqual(reactions["largest_end_weight"], 1 / 3 + 1e-12)
        self.assertRegex(self.said(folder), r"; reactions: the mean over the step, in which those at its end have the weight \S+( to 0\.\d+)?$")
        for scheme, mass, acting in (("newmark", "equivalent", None), ("mean-reaction", "equivalent", "mean"), ("midpoint", "consistent", None)):
            preset = {"time.preset": "textbook-half"} if scheme == "newmark" else {}
            folder = self.simulate(DISC, scheme, LONG | preset | {"time.scheme": scheme, "mass.type": mass, "time.step": 1e-4, "time.end": 0.02})
            reactions = summary_of(folder)["reactions"]
            self.assertEqual(reactions and reactions["acting"], acting)
            self.assertEqual("reactions:" in self.said(folder), acting is not None)

    def test_a_run_that_continues_reports_the_same(self):
        for weight in ("end", "adaptive"):
            values = LONG | {"time.reaction_weight": weight, "output.checkpoint_every": 1000}
            whole = self.simulate(DISC, f"whole-{weight}", values)
            # In the middle of the first impact, after which the body flies.
            parts = self.simulate(DISC, f"parts-{weight}", values | {"time.end": 0.02})
            self.assertFalse(summary_of(parts)["impacts"][0]["ended"])
            self.expect_status(0, run("run", "--resume", parts, "--quiet", "--set", "time.end=0.05"))
            self.assertEqual(summary_of(parts)["resumed_at"], [20])
            for entry in ("energy_budget", "reactions", "impacts", "extrema"):
                self.assertEqual(summary_of(whole)[entry], summary_of(parts)[entry], entry)

    def test_a_restitution_that_the_method_has_made_is_marked(self):
        """A block that strikes flat, at steps of many wave crossings: the end reactions take much of its energy."""
        case = self.write("block.toml", block_case().replace("gravity = [0.0, -10.0]", "gravity = [0.0, 0.0]")
                          + '[initial]\nvelocity = [0.0, -1.0]\ndisplacement = [0.0, 0.1]\n')
        values = {"time.scheme": "reduced-kane", "mass.type": "equivalent", "time.end": 1.5}
        folders = {}
        for weight, step in (("end", 0.05), ("adaptive", 0.002)):
            folders[weight] = folder = self.simulate(case, weight, {k: v for k, v in values.items()} | {"time.reaction_weight": weight, "time.step": step})
            found = summary_of(folder)
            impact = found["impacts"][0]
            approach = 0.5 * found["bodies"][0]["mass"] * impact["normal_velocity_before"]**2
            history = History(folder / "history.csv")
            put_in = dict(zip(history["time"], of_method(history)))
            after = min(put_in, key=lambda time: abs(time - impact["end"] - step))
            self.assertAlmostEqual(impact["method_energy"], put_in[after], delta=1e-12 * approach)
            large = abs(impact["method_energy"]) > 0.1 * abs(1 - impact["restitution"]**2) * approach
            self.assertEqual(large, weight == "end")
            self.assertEqual(impact["restitution_inexact"], large)
            text = self.expect_status(0, run("info", folder)).stdout
            told = (f"restitution {impact['restitution']:.4g} (inexact: of the energy of the approach, the method lost "
                    f"{percent(abs(impact['method_energy']) / approach)}, and the body lost {percent(1 - impact['restitution']**2)})")
            self.assertEqual(told in text, large, text)
        text = self.expect_status(0, run("info", *folders.values())).stdout
        rows = {weight: [line for line in text.splitlines() if line.startswith(f"{folder} ")] for weight, folder in folders.items()}
        self.assertIn("-" + percent(summary_of(folders["end"])["energy_budget"]["lost_by_method"]), rows["end"][0])
        self.assertRegex(rows["end"][1], r"\d\S?! ")
        self.assertNotIn("!", rows["adaptive"][1])
        self.assertIn("  ! the method itself lost or created more than a tenth", text)
        self.assertIn(f"{folders['end']}: mass equivalent, built as ", text)
        self.assertRegex(text, r"built as \S+; reactions: those at the end of the step; variation of foot\.reaction_normal \S+\n")

