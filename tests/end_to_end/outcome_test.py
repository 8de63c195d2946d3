"""Results of a run, in summary.json and in words: its impacts and its largest stress."""

import math
import re

import h5py
import numpy

from harness import DISC, SOURCE, SPINNING, History, TestCase, block_case, body_case, run, settings, summary_of, with_more
from two_bodies_test import strip

# The puck of the first case strikes a wall once and leaves.
PUCK = SOURCE / "cases" / "puck" / "puck.toml"
OUTCOME = ("bodies", "impacts", "impacts_left_out", "rotation", "peak_stress")


def cube_mesh(cells):
    """Returns a unit cube of cells³ hexahedra of order 1, in Gmsh's format 2.2."""
    n = cells + 1
    nodes = [f"{1 + i + n * (j + n * k)} {i / cells} {j / cells} {k / cells}"
             for k in range(n) for j in range(n) for i in range(n)]
    corners = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
    elements = [" ".join(str(1 + i + a + n * (j + b + n * (k + c))) for a, b, c in corners)
                for k in range(cells) for j in range(cells) for i in range(cells)]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "1", '3 1 "body"', "$EndPhysicalNames",
                      "$Nodes", str(len(nodes)), *nodes, "$EndNodes", "$Elements", str(len(elements)),
                      *(f"{number} 5 2 1 1 {of}" for number, of in enumerate(elements, 1)), "$EndElements", ""])


class Outcome(TestCase):
    def test_the_mass_that_was_built_is_named(self):
        case = """[mesh]
file = "cube.msh"
[[material]]
group = "body"
density = 1.0
lambda = 1.0
mu = 1.0
[obstacle.floor]
type = "plane"
point = [0.0, 0.0, -0.001]
normal = [0.0, 0.0, 1.0]
[[contact]]
group = "boundary"
obstacle = "floor"
[time]
scheme = "newmark"
preset = "trapezoidal"
step = 0.001
end = 0.001
"""
        for cells, built in ((3, "equivalent-nodewise"), (8, "equivalent-cellwise")):  # of 27, only one has no contact node
            self.write("cube.msh", cube_mesh(cells))
            folder = self.simulate(self.write("cube.toml", case), f"cube-{cells}")
            found = summary_of(folder)
            self.assertEqual(found["mass"], "equivalent")
            self.assertEqual(found["mass_built"], built)
            self.assertEqual(found["contact_points"], 6 * cells**2 + 2)
            said = self.expect_status(0, run("info", folder)).stdout
            self.assertIn(f"equivalent, built as {built}", said)

    def test_impacts_balance_momentum_and_are_told(self):
        folder = self.simulate(PUCK, "puck")
        found = summary_of(folder)
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
        self.assertIsNone(impact["why_no_restitution"])
        self.assertLess(impact["kinetic_energy_ratio"], 1.0)
        self.assertLess(impact["begin"], impact["largest_force_time"])
        self.assertLess(impact["largest_force_time"], impact["end"])
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn(f"restitution {impact['restitution']:.4g}", said)
        peak = found["peak_stress"]
        least = "≥ " if peak["states_looked_at"] < peak["states"] else ""
        self.assertIn(f"largest von Mises stress {least}{peak['von_mises']:.6g}", said)

    def test_a_stress_that_grows_with_refinement_is_marked(self):
        """A clamped block has its largest stress at the end of its support, a disc on a floor inside."""
        clamped = block_case() + '[[support]]\ngroup = "sides"\ncomponents = ["x", "y"]\n'
        marked = self.simulate(self.write("clamped.toml", clamped), "clamped", {"time.end": 0.1})
        peak = summary_of(marked)["peak_stress"]
        self.assertEqual((peak["grows_with_refinement"], peak["sits_on"]), (True, "the edge of a support"))
        line = "it grows with refinement: it sits on the edge of a support"
        self.assertIn(line, self.expect_status(0, run("info", marked)).stdout)
        disc = self.simulate(DISC, "smooth", {"time.end": 0.02})
        peak = summary_of(disc)["peak_stress"]
        self.assertEqual((peak["grows_with_refinement"], peak["sits_on"]), (False, None))
        self.assertNotIn("grows with refinement", self.expect_status(0, run("info", disc)).stdout)

    def test_they_tell_where_and_on_how_many_points(self):
        folder = self.simulate(PUCK, "puck", {"time.end": 7e-4, "output.history_every": 1})
        impact = summary_of(folder)["impacts"][0]
        header, *rows = (folder / "history.csv").read_text(encoding="ascii").splitlines()
        column = header.split(",").index("active_contacts")
        self.assertEqual(impact["contact_points"], max(float(row.split(",")[column]) for row in rows))
        with h5py.File(folder / "results.h5") as file:
            nodes = file["/mesh/nodes"][()]
        lowest = nodes[numpy.argmin(nodes[:, 1])]  # it flies without rotation
        self.assertEqual(impact["first_place"], list(lowest[:2]))
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertFalse(impact["coarse"])
        self.assertIn(f", at most {impact['contact_points']} of {impact['all_contact_points']} contact points at once\n", said)

    def test_a_coarse_contact_zone_is_told(self):
        folder = self.simulate(self.write("block.toml", block_case()), "block")
        impact = summary_of(folder)["impacts"][0]
        self.assertIn(impact["contact_points"], (1, 2, 3))
        self.assertLess(impact["contact_points"], impact["all_contact_points"])
        self.assertTrue(impact["coarse"])
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn("at once: the contact zone is too coarse for a reliable largest force and duration", said)

    def test_a_contact_across_the_axis_has_no_impulse_and_says_so(self):
        """A ring grows until a wall all round it stops it: the force of the wall is radial, and cancels over the ring."""
        text = (block_case().replace("[[material]]", 'plane = "axisymmetric"\n[[material]]', 1)
                .replace("point = [0.0, 0.0]\nnormal = [0.0, 1.0]", "point = [1.52, 0.0]\nnormal = [-1.0, 0.0]")
                .replace('group = "bottom"', 'group = "sides"')
                .replace("[load]\ngravity = [0.0, -10.0]", '[initial]\nvelocity = ["x", "0"]')
                + '[[probe]]\nname = "wall"\ncontact = 0\n')
        folder = self.simulate(self.write("ring.toml", text), "ring", options=("--quiet", "--force"))
        found = summary_of(folder)
        self.assertEqual(found["impacts"][0]["largest_force"], 0.0)
        self.assertGreater(max(map(abs, History(folder / "history.csv")["wall.force_x"])), 0.1)
        [line] = [line for line in self.expect_status(0, run("info", folder)).stdout.splitlines() if line.startswith("  impact 1: ")]
        self.assertIn(", radial contact: its force has no resultant along the axis, hence no impulse; a [[probe]] of the contact shows", line)
        self.assertNotIn("largest force 0", line)

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
        impact = summary_of(folder)["impacts"][0]
        whole = sum(component**2 for component in impact["impulse"])**0.5
        # Coulomb's cone holds in each step, and therefore for the sums.
        self.assertLessEqual(whole, (1 + 0.3**2)**0.5 * impact["normal_impulse"] * (1 + 1e-9))
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn(f"normal impulse {impact['normal_impulse']:.4g} (with friction {whole:.4g}),", said)
        folder = self.simulate(DISC, "disc", {"time.end": 0.03})
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn(f"normal impulse {summary_of(folder)['impacts'][0]['normal_impulse']:.4g}, largest force", said)

    def test_they_do_not_depend_on_what_else_is_written(self):
        often = summary_of(self.simulate(DISC, "often", {"time.end": 0.03}))
        rarely = summary_of(self.simulate(DISC, "rarely", {"time.end": 0.03, "output.history_every": 50}))
        self.assertEqual(often["impacts"], rarely["impacts"])
        self.assertFalse(often["impacts"][0]["ended"])
        self.assertIsNone(often["impacts"][0]["restitution"])
        self.assertEqual(often["impacts"][0]["why_no_restitution"], "the body still touches")

    def test_the_explicit_scheme_writes_every_second_row(self):
        explicit = {"time.scheme": "semi-explicit", "mass.type": "equivalent-lumped", "time.step": 2e-7, "time.end": 11 * 2e-7}
        for name, values, steps in (("default", {}, [0, 2, 4, 6, 8, 10, 11]), ("asked", {"output.history_every": 1}, [*range(12)])):
            folder = self.simulate(PUCK, name, explicit | values)
            self.assertEqual(list(History(folder / "history.csv")["step"]), steps)

    def test_a_grazing_impact_has_no_restitution(self):
        values = {"initial.velocity": "[200.0, -0.3]", "load.gravity": "[0.0, 0.0]", "time.end": 0.2}
        folder = self.simulate(DISC, "grazing", values)
        impact = summary_of(folder)["impacts"][0]
        self.assertTrue(impact["ended"])
        self.assertAlmostEqual(impact["normal_velocity_before"], -0.3, delta=1e-9)
        self.assertIsNone(impact["restitution"])
        self.assertIn("less than 1 % of the speed at which it slid along the obstacle", impact["why_no_restitution"])
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn(f"no restitution ({impact['why_no_restitution']})", said)
        # On a belt that runs along with it, it does not graze.
        carried = self.simulate(DISC, "carried", values | {"obstacle.foundation.velocity": "[200.0, 0.0]"})
        impact = summary_of(carried)["impacts"][0]
        self.assertAlmostEqual(impact["obstacle_sliding_velocity"][0], 200.0, delta=1e-9)
        self.assertIsNone(impact["why_no_restitution"])
        self.assertIn(f"restitution {impact['restitution']:.4g}", self.expect_status(0, run("info", carried)).stdout)

    def test_a_body_that_begins_inside_has_no_restitution(self):
        """Being pushed out could give any restitution. Deeper ones are refused, with the location."""
        deep = self.expect_status(2, run("run", DISC, "-o", self.folder / "deep", "--set", "mesh.move=[0.0, -1.0]"))
        self.assertIn('inside obstacle "foundation", the deepest by 0.999 at (0, -0.999)', deep.stderr)
        folder = self.simulate(DISC, "inside", {"mesh.move": "[0.0, -0.00102]", "time.end": 0.2, "load.gravity": "[0.0, 0.0]",
                                                "initial.velocity": "[0.0, 0.0]"}, options=("--quiet", "--force"))
        impact = summary_of(folder)["impacts"][0]
        self.assertTrue(impact["from_inside"])
        self.assertTrue(impact["ended"])
        self.assertIsNone(impact["restitution"])
        self.assertIn("no restitution (the body began inside the obstacle", self.expect_status(0, run("info", folder)).stdout)

    def test_the_largest_stress_is_that_of_the_fields_and_more(self):
        every = self.simulate(DISC, "every", {"time.end": 0.02, "output.fields_every": 1})
        peak = summary_of(every)["peak_stress"]
        self.assertEqual(peak["states_looked_at"], 201)
        self.assertEqual(peak["states"], 201)
        with h5py.File(every / "results.h5") as file:
            values = [float(numpy.max(frame["von_mises"])) for frame in file["frames"].values()]
        self.assertEqual(len(values), 201)
        self.assertEqual(max(values), peak["von_mises"])
        sampled = self.simulate(DISC, "few", {"time.end": 0.02, "output.fields_every": 100})
        few = summary_of(sampled)["peak_stress"]
        self.assertLess(few["states_looked_at"], 100)
        self.assertLessEqual(few["von_mises"], peak["von_mises"])
        # A value that was not evaluated in every step may have been higher.
        said = [self.expect_status(0, run("info", folder)).stdout for folder in (every, sampled)]
        self.assertIn(f"largest von Mises stress {peak['von_mises']:.6g} at", said[0])
        self.assertIn(f"largest von Mises stress ≥ {few['von_mises']:.6g} at", said[1])

    def test_a_block_that_springs_off_is_doubted(self):
        """It lands compressed, and leaves with its elastic energy, too: faster than it came."""
        self.write("strip.msh", strip(8, 4, 0.5))
        text = body_case("strip.msh", [0.0, -0.001], [0.0, 1.0], '[initial]\nvelocity = [0.0, -0.1]\ndisplacement = ["0", "-0.02*y"]\n',
                         mass="equivalent", scheme="reduced-kane", step=1e-3, end=0.4)
        case = self.write("case.toml", text)
        folder = self.simulate(case)
        restitution = summary_of(folder)["impacts"][0]["restitution"]
        self.assertGreater(restitution, 1.1)
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn(f"restitution {restitution:.4g} (above 1: energy of deformation or rotation has become that of the rebound)", said)
        compared = self.expect_status(0, run("info", folder, folder)).stdout
        self.assertIn(f" {restitution:.4g}± ", compared)
        self.assertIn("  ± negative or above 1: ", compared)
        self.expect_status(0, run("study", case, "--vary", "time.step=1e-3,2e-3", "-o", self.folder / "study", "--quiet"))
        self.assertEqual((self.folder / "study" / "study.csv").read_text().count("restitution: above 1"), 2)

    def test_several_runs_are_compared(self):
        """In the second table, a mark stands exactly at the numbers that cannot be trusted."""
        runs = {"puck": self.simulate(PUCK, "puck", {"time.end": 7e-4, "output.fields_every": 1}),
                "block": self.simulate(self.write("block.toml", block_case()), "block"),
                "disc": self.simulate(DISC, "disc", {"time.end": 0.02, "output.fields_every": 100})}
        text = self.expect_status(0, run("info", *runs.values())).stdout
        rows = {line.split()[0]: line for line in text.split("\n\n")[1].split("\n")[1:4]}
        for name, folder in runs.items():
            with self.subTest(name):
                found = summary_of(folder)
                impacts, peak = found["impacts"], found["peak_stress"]
                history = History(folder / "history.csv")
                turned_at = next((t for t, turned in zip(history["time"], history["max_rotation"]) if turned > 0.1), math.inf)
                turned = lambda time: "?" if turned_at <= time else ""
                ended = [each for each in impacts if each["restitution"] is not None]
                restitution = "-"
                if ended:
                    more = "*" if len(impacts) > 1 else ""
                    restitution = f"{ended[0]['restitution']:.4g}{more}{turned(ended[0]['end'])}"
                hardest = max(impacts, key=lambda each: each["largest_force"])
                coarse = "~" if hardest["coarse"] else ""
                force = f"{hardest['largest_force']:.4g}{coarse}{turned(hardest['begin'] + hardest['duration'])}"
                sampled = peak["states_looked_at"] < peak["states"]
                grows = "^" if peak["grows_with_refinement"] else ""
                stress = [f"{peak['von_mises']:.4g}{turned(peak['time'])}{grows}"]
                self.assertEqual(rows[str(folder)].split()[1:],
                                 [str(len(impacts)), restitution, force] + ["≥"] * sampled + stress)
        self.assertIn("~ the contact zone is too coarse", text)
        self.assertIn("? cells rotate by more than 0.1 rad", text)
        self.assertIn("≥ not every step was evaluated", text)
        alone = self.expect_status(0, run("info", runs["puck"], runs["puck"])).stdout
        for mark in "~?≥*":
            self.assertNotIn(f"  {mark} ", alone)

    def test_turning_after_the_last_impact_is_told_from_turning_in_it(self):
        """The puck leaves with a spin and rotates in free flight."""
        folder = self.simulate(PUCK, "puck", {"time.end": 6e-3, "time.step": 4e-6})
        found = summary_of(folder)
        [impact] = found["impacts"]
        rotation = found["rotation"]
        history = History(folder / "history.csv")
        pairs = list(zip(history["time"], history["max_rotation"]))
        self.assertEqual(rotation["time_beyond"], next(time for time, turned in pairs if turned > 0.1))
        self.assertGreater(rotation["time_beyond"], impact["end"])
        until = max(turned for time, turned in pairs if time <= impact["end"])
        self.assertAlmostEqual(rotation["until_impact_end"][0], until, delta=0.01 * until)
        said = self.expect_status(0, run("info", folder)).stdout
        self.assertIn(f"(beyond small strain from t = {rotation['time_beyond']:.6g} on, after the last impact had ended)", said)
        self.assertIn(f"cells rotated by up to {rotation['until_impact_end'][0]:.3g} rad until its end", said)
        self.assertNotIn("BEYOND SMALL STRAIN", said)
        self.assertFalse(any("not those of a real body" in warning for warning in found["warnings"]), found["warnings"])
        # It arrives without a spin: the printed value is not rounding.
        self.assertIn(f"spin 0 before and {impact['spin_after']:.4g} after", said)
        self.expect_status(0, run("report", folder))
        self.assertIn('"rotation_after_impacts":true', (folder / "report.html").read_text(encoding="utf-8"))
        # The disc is pressed flat.
        folder = self.simulate(DISC, "disc", {"time.end": 0.02})
        said = self.expect_status(0, run("info", folder)).stdout
        beyond = summary_of(folder)["rotation"]["time_beyond"]
        self.assertIn(f"(BEYOND SMALL STRAIN from t = {beyond:.6g} on, before the last impact has ended)", said)
        self.expect_status(0, run("report", folder))
        self.assertIn('"rotation_after_impacts":false', (folder / "report.html").read_text(encoding="utf-8"))

    def test_a_body_that_small_strain_makes_grow_as_it_turns(self):
        """The law of finite strain gives the correct restitution."""
        case = self.write("spinning.toml", SPINNING)
        outcomes = {}
        for law in ("linear", "neo-hookean"):
            process = self.expect_status(0, run("run", case, "-o", self.folder / law, *settings({"material.0.law": law})))
            outcomes[law] = process, summary_of(self.folder / law)["impacts"][0]
        (said, grown), (other, true) = outcomes["linear"], outcomes["neo-hookean"]
        error = grown["restitution"] - true["restitution"]
        self.assertGreater(error, 0.1)
        self.assertAlmostEqual(grown["restitution_by_turning"], error, delta=0.15 * error)
        self.assertAlmostEqual(grown["turn_growth"], 0.5 * grown["restitution_by_turning"] * -grown["normal_velocity_before"], delta=1e-12)
        self.assertEqual((true["turn_growth"], true["restitution_by_turning"]), (0, 0))
        told = f"too large by about {grown['restitution_by_turning']:.2g}"
        self.assertIn(f"the restitution of impact 1 is {told}", said.stderr)
        self.assertIn(f"(BEYOND SMALL STRAIN: {told}", said.stdout)
        self.assertNotIn("SMALL STRAIN", other.stdout)
        self.assertNotIn("too large by", other.stderr)
        self.assertIn(f"{grown['restitution']:.4g}?", self.expect_status(0, run("info", self.folder / "linear", self.folder / "neo-hookean")).stdout)
        # The card of the report is red, though no cell rotates by 0.1 rad.
        self.expect_status(0, run("report", self.folder / "linear"))
        page = (self.folder / "linear" / "report.html").read_text(encoding="utf-8")
        rotation, limit = (float(re.search(rf'"{name}":([0-9.e-]+)[,}}]', page)[1]) for name in ("rotation", "rotation_limit"))
        self.assertLess(rotation, 0.1)
        self.assertLess(limit, rotation)

    def test_a_probe_along_a_segment_is_one_line(self):
        more = '[[probe]]\nname = "foot-line"\nfrom = [0.1, 0.2]\nto = [1.3, 0.1]\n'
        folder = self.simulate(self.write("block.toml", block_case() + more), "block")
        lines = [line for line in self.expect_status(0, run("info", folder)).stdout.split("\n") if line.startswith("  probe")]
        self.assertEqual(len(lines), 2, lines)
        history = History(folder / "history.csv")
        hardest = max(max(history[f"foot-line.{k}.reaction_normal"]) for k in range(4))
        self.assertEqual(lines[1], '  probe "foot-line": 4 nodes from (0.1, 0.2) to (1.3, 0.1), largest contact force on a '
                                   f"node {hardest:.6g}")

    def test_a_run_that_goes_on_ends_with_the_same(self):
        values = {"time.end": 0.03, "output.checkpoint_every": 130}
        whole = summary_of(self.simulate(DISC, "whole", values))
        broken = self.simulate(DISC, "broken", values)
        (broken / "summary.json").unlink()
        max(broken.glob("checkpoint-*.ckpt")).unlink()  # of its end
        self.expect_status(0, run("run", DISC, "-o", broken, "--resume", "--quiet", *settings(values)))
        resumed = summary_of(broken)
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
