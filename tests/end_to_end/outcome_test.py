"""What came out of a run, in summary.json and in words: its impacts and its largest stress."""

import json
import unittest

import h5py
import numpy

from harness import DISC, SOURCE, TestCase, block_case, run, settings, with_more

# The puck of the first case strikes a wall once and leaves.
PUCK = SOURCE / "cases" / "puck" / "puck.toml"
OUTCOME = ("bodies", "impacts", "impacts_left_out", "peak_stress")


def summary(folder):
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


class Outcome(TestCase):
    def test_impacts_balance_momentum_and_are_told(self):
        folder = self.simulate(PUCK, "puck")
        found = summary(folder)
        self.assertEqual(len(found["impacts"]), 1)
        impact = found["impacts"][0]
        body = found["bodies"][impact["body"]]
        self.assertTrue(impact["ended"])
        change = [body["mass"] * (after - before)
                  for before, after in zip(impact["velocity_before"], impact["velocity_after"])]
        scale = max(map(abs, change))
        for k, component in enumerate(change):
            self.assertAlmostEqual(component, impact["impulse"][k] + impact["other_impulse"][k], delta=1e-12 * scale)
        self.assertGreater(impact["restitution"], 0.5)
        self.assertLess(impact["kinetic_energy_ratio"], 1.0)
        self.assertLess(impact["begin"], impact["largest_force_time"])
        self.assertLess(impact["largest_force_time"], impact["end"])
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn(f"restitution {impact['restitution']:.4g}", said)
        self.assertIn(f"largest von Mises stress {found['peak_stress']['von_mises']:.6g}", said)

    def test_a_run_without_contact_says_so(self):
        told = "  no contact: no contact force acted in this run\n"

        def says(case, name, *options):
            process = self.expect_status(0, run("run", case, "-o", self.folder / name, "--quiet", *options))
            info = self.expect_status(0, run("info", self.folder / name)).stdout
            self.assertEqual(told in process.stdout, told in info)
            return told in info

        text = with_more(PUCK, "")
        short = self.write("short.toml", text.replace("end = 1.5e-3", "end = 3.0e-4"))
        self.assertTrue(says(short, "short"))
        touches = self.write("touches.toml", text.replace("end = 1.5e-3", "end = 4.2e-4"))
        self.assertFalse(says(touches, "touches"))
        text = block_case().replace('[[contact]]\ngroup = "bottom"\nobstacle = "floor"\n', "")
        self.assertFalse(says(self.write("free.toml", text), "free"))

    def test_impulses_say_whether_friction_is_in_them(self):
        folder = self.simulate(SOURCE / "cases" / "oblique" / "oblique.toml", "oblique", {"time.step": 1e-4})
        impact = summary(folder)["impacts"][0]
        whole = sum(component**2 for component in impact["impulse"])**0.5
        # Coulomb's cone holds in each step, so it holds for the sums.
        self.assertLessEqual(whole, (1 + 0.3**2)**0.5 * impact["normal_impulse"] * (1 + 1e-9))
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn(f"normal impulse {impact['normal_impulse']:.4g} (with friction {whole:.4g}),", said)
        folder = self.simulate(DISC, "disc", {"time.end": 0.03})
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn(f"normal impulse {summary(folder)['impacts'][0]['normal_impulse']:.4g}, largest force", said)

    def test_they_do_not_depend_on_what_else_is_written(self):
        often = summary(self.simulate(DISC, "often", {"time.end": 0.03}))
        rarely = summary(self.simulate(DISC, "rarely", {"time.end": 0.03, "output.history_every": 50}))
        self.assertEqual(often["impacts"], rarely["impacts"])
        self.assertFalse(often["impacts"][0]["ended"])
        self.assertIsNone(often["impacts"][0]["restitution"])

    def test_the_largest_stress_is_that_of_the_fields_and_more(self):
        every = self.simulate(DISC, "every", {"time.end": 0.02, "output.fields_every": 1})
        peak = summary(every)["peak_stress"]
        self.assertEqual(peak["states_looked_at"], 201)
        self.assertEqual(peak["states"], 201)
        with h5py.File(every / "results.h5") as file:
            values = [float(numpy.max(frame["von_mises"])) for frame in file["frames"].values()]
        self.assertEqual(len(values), 201)
        self.assertEqual(max(values), peak["von_mises"])
        few = summary(self.simulate(DISC, "few", {"time.end": 0.02, "output.fields_every": 100}))["peak_stress"]
        self.assertLess(few["states_looked_at"], 100)
        self.assertLessEqual(few["von_mises"], peak["von_mises"])

    def test_a_run_that_goes_on_ends_with_the_same(self):
        values = {"time.end": 0.03, "output.checkpoint_every": 130}
        whole = summary(self.simulate(DISC, "whole", values))
        broken = self.simulate(DISC, "broken", values)
        (broken / "summary.json").unlink()
        max(broken.glob("checkpoint-*.ckpt")).unlink()  # of its end
        self.expect_status(0, run("run", DISC, "-o", broken, "--resume", "--quiet", *settings(values)))
        resumed = summary(broken)
        self.assertEqual(resumed["resumed_at"], [260])
        for entry in OUTCOME:
            self.assertEqual(resumed[entry], whole[entry], entry)

    def test_expectations_reach_them(self):
        case = self.folder / "expects.toml"
        text = PUCK.read_text(encoding="utf-8").split("[[expect]]")[0].replace('file = "', f'file = "{PUCK.parent}/')
        case.write_text(text + '[[expect]]\nquantity = "summary.impacts.0.restitution"\nminimum = 2.0\n', encoding="utf-8")
        failed = self.expect_status(5, run("run", case, "-o", self.folder / "expects", "--quiet"))
        self.assertIn("summary.impacts.0.restitution", failed.stderr)
        case.write_text(text + '[[expect]]\nquantity = "summary.impacts.7.restitution"\nminimum = 2.0\n', encoding="utf-8")
        self.assertIn("7.restitution",
                      run("run", case, "-o", self.folder / "expects", "--quiet", "--force").stdout)


if __name__ == "__main__":
    unittest.main()
