"""Corrections of the velocities that close the balance of energy of a step: a run reports those that no tolerance explains."""

from harness import History, TestCase, run, settings, summary_of
from newton_tolerance_test import BOX_GEO, floor, material, time

LARGE = 1e-4
STRIKES = '[initial]\nvelocity = ["2-4*(y-0.2)", "-2+4*(x-0.5)"]\n'
HILL = 'type = "sphere"\ncentre = [0.4, -0.35]\nradius = 0.3'
WARNING = "corrections of velocities, which close the balance of energy"


class VelocityCorrections(TestCase):
    def setUp(self):
        super().setUp()
        self.write("box.geo", BOX_GEO.format(width=1.0, height=0.4, size=0.12))
        law = material().replace("poisson = 0.3", "poisson = 0.45")
        self.case = self.write("case.toml", '[mesh]\nfile = "box.geo"\n' + law + floor(0.4, HILL) + STRIKES + time())

    def outcome(self, name, values, resume=False):
        folder = self.folder / name
        again = "--resume" if resume else "--force"
        self.expect_status(0, run("run", self.case, "-o", folder, "--quiet", again, *settings(values)))
        return History(folder / "history.csv"), summary_of(folder)

    def warnings(self, summary):
        return [text for text in summary["warnings"] if WARNING in text]

    def shares(self, history):
        """Returns the share of the energy that corrections have changed in each step, from the account of the history."""
        column = history["velocity_correction"]
        energies = [kinetic + elastic for kinetic, elastic in zip(history["kinetic_energy"], history["elastic_energy"])]
        return [abs(after - before) / energy for before, after, energy in zip(column, column[1:], energies[1:])]

    def test_large_steps_of_a_block_that_strikes_a_hill(self):
        history, summary = self.outcome("large", {"time.step": 0.02})
        found, shares, times = summary["velocity_corrections"], self.shares(history), history["time"][1:]
        large = [time for time, share in zip(times, shares) if share > LARGE]
        self.assertGreater(len(large), 2)
        self.assertEqual((found["steps"], found["first_time"]), (len(large), large[0]))
        self.assertAlmostEqual(found["largest"], max(shares), delta=1e-9 * max(shares))
        self.assertEqual(found["time"], times[shares.index(max(shares))])
        told = self.warnings(summary)
        self.assertEqual(len(told), 1, summary["warnings"])
        self.assertIn(f"in {len(large)} of {len(shares)} steps, from t = {large[0]:.6g} on", told[0])
        shown = self.expect_status(0, run("info", self.folder / "large")).stdout
        self.assertIn(f"LARGE CORRECTIONS OF VELOCITIES in {len(large)} of {len(shares)} steps", shown)
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-13 * history.largest_energy(), "corrections are in no balance")

    def test_shorter_steps_reduce_them_and_a_loose_tolerance_is_named_first(self):
        for step in (0.02, 0.005):
            for tolerance in (1e-4, 1e-12):
                _, summary = self.outcome("out", {"time.step": step, "solver.newton_tolerance": tolerance})
                found = summary["velocity_corrections"]
                told = self.warnings(summary)
                self.assertEqual(len(told), 1 if step == 0.02 else 0)
                self.assertEqual(["set solver.newton_tolerance" in text for text in told], [tolerance > 1e-6] * len(told))
                self.assertEqual(found["steps"] > 0, step == 0.02)
                self.assertEqual(found["first_time"] is None, step == 0.005)
                self.assertEqual(found["largest"] > LARGE, step == 0.02)
                self.assertGreater(found["largest"], 1e-6)
        self.assertNotIn("CORRECTIONS", self.expect_status(0, run("info", self.folder / "out")).stdout)

    def test_every_step_counts_with_few_rows_and_in_a_resumed_run(self):
        _, whole = self.outcome("whole", {"time.step": 0.02})
        _, rare = self.outcome("rare", {"time.step": 0.02, "output.history_every": 7})
        self.outcome("resumed", {"time.step": 0.02, "time.end": 0.14})
        _, resumed = self.outcome("resumed", {"time.step": 0.02}, resume=True)
        for other in (rare, resumed):
            self.assertEqual(other["velocity_corrections"], whole["velocity_corrections"])
            self.assertEqual(self.warnings(other), self.warnings(whole))
        self.assertEqual(resumed["resumed_at"], [7])

    def test_a_body_that_comes_to_rest_has_none(self):
        """Energies decrease to rounding of those of the fall, of which corrections may be any share."""
        law = material(law='law = "neo-hookean"\nrelaxation = { modulus = [20.0], time = [0.05] }')
        rests = '[load]\ngravity = [0, -1]\n[initial]\ndisplacement = "static"\n'
        held = '[[support]]\ngroup = "base"\ncomponents = ["x", "y"]\n'
        for what, more in (("rests", rests), ("relaxes", held + '[initial]\nvelocity = ["0.1*y", 0.0]\n')):
            with self.subTest(what):
                plane = floor(0.4, 'type = "plane"\npoint = [0, 0]\nnormal = [0, 1]')
                self.case = self.write("rest.toml", '[mesh]\nfile = "box.geo"\n' + law + plane + more + time(0.02, 12.0))
                history, summary = self.outcome("rest", {})
                self.assertEqual(summary["velocity_corrections"]["steps"], 0)
                if what == "relaxes":
                    total = history["total_energy"]
                    self.assertLess(total[-1], 1e-12 * max(total))

    def test_schemes_and_laws_without_corrections_say_nothing(self):
        for values in ({"time.scheme": "newmark", "time.preset": "trapezoidal", "time.step": 0.01, "time.end": 0.05},
                       {"material.0.law": "linear", "time.end": 0.05}):
            history, summary = self.outcome("without", values)
            self.assertIsNone(summary["velocity_corrections"])
            self.assertEqual("velocity_correction" in history.names, "time.scheme" in values)
