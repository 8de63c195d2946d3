"""Traps for users of several bodies: momenta that cancel, points that face nothing, corners against large facets, ties
between bodies in motion, static starts of floating bodies, motions far away."""

from harness import History, TestCase, run, summary_of
from two_bodies_test import material, strip


def wedge(cells):
    """Returns the strip [0, 1] x [0, 1] of rectangles, whose top is a roof with its ridge in the middle, 0.5 higher."""
    lines = strip(cells, cells, 1.0).split("\n")
    at = lines.index("$Nodes") + 2
    for k in range(at, at + (cells + 1) ** 2):
        number, x, y, _ = lines[k].split()
        lines[k] = f"{number} {x} {float(y) * (1.0 + 0.5 - abs(float(x) - 0.5))!r} 0"
    return "\n".join(lines)


class TwoBodiesTraps(TestCase):
    def bodies(self, one, two, more, contact='[[contact]]\ngroup = "one.right"\nagainst = "two.left"\n'):
        self.write("one.msh", one)
        self.write("two.msh", two)
        return self.write("case.toml", '[part.one]\nfile = "one.msh"\n[part.two]\nfile = "two.msh"\nmove = [1.1, 0.0]\n' + contact
                          + material("one", 1.0) + material("two", 1.0) + more)

    def warnings(self, folder, part):
        return [text for text in summary_of(folder)["warnings"] if part in text]

    def test_momenta_that_cancel(self):
        case = self.bodies(strip(8, 2, 0.25), strip(8, 3, 0.25), "[time]\nstep = 0.03\nend = 1.5\n")
        out = self.simulate(case, values={"part.one.velocity": "[0.1, 0.0]", "part.two.velocity": "[-0.1, 0.0]"})
        self.assertEqual(self.warnings(out, "is violated"), [])
        self.assertLess(summary_of(out)["checks"]["momentum"]["largest"], 1e-10)
        self.assertEqual(len(summary_of(out)["impacts"]), 1)
        # Also for a body that only rotates.
        out = self.simulate(case, name="spin", values={"part.one.spin": 0.1, "check.on_failure": '"stop"'})
        self.assertEqual(self.warnings(out, "is violated"), [])

    def test_far_from_where_they_were(self):
        case = self.bodies(strip(8, 2, 0.25), strip(8, 3, 0.25), "[time]\nstep = 0.1\nend = 2.0\n[initial]\n")
        speeds = {"part.one.velocity": "[0.1, 0.0]"}
        near = self.simulate(case, values=speeds)
        far = self.simulate(case, name="far", values={**speeds, "initial.displacement": "[1e3, 0.0]"})
        lost = [summary_of(folder)["energy_budget"] for folder in (near, far)]
        for part, value in lost[0].items():
            if isinstance(value, float):
                self.assertAlmostEqual(lost[1][part], value, delta=1e-6 + 1e-3 * abs(value), msg=part)
        self.assertNotEqual(lost[1], {part: 0.0 for part in lost[1]})

    def test_probes_of_what_faces_nothing(self):
        above = '[[contact]]\ngroup = "one.top"\nagainst = "two.bottom"\n'
        probe = '[[probe]]\nname = "line"\nfrom = [0.0, 0.25]\nto = [1.0, 0.25]\n[time]\nstep = 0.03\nend = 0.3\n'
        case = self.bodies(strip(8, 2, 0.25), strip(8, 3, 0.25), probe, above)
        out = self.simulate(case, values={"part.two.move": "[0.45, 0.26]", "part.two.velocity": "[0.0, -0.1]"})
        columns = History(out / "history.csv").names
        gaps = [name for name in columns if name.startswith("line.") and name.endswith(".gap")]
        pressures = [name for name in columns if name.startswith("line.") and name.endswith(".pressure")]
        self.assertGreater(len(gaps), 2)
        self.assertLess(len(gaps), len(pressures))

    def test_a_ridge_against_large_facets(self):
        above = '[[contact]]\ngroup = "one.top"\nagainst = "two.bottom"\n'
        case = self.bodies(wedge(4), strip(3, 2, 0.5), "[time]\nstep = 0.02\nend = 2.0\n", above)
        out = self.simulate(case, values={"part.two.move": "[0.0, 1.51]", "part.one.velocity": "[0.0, 0.1]"})
        [told] = self.warnings(out, "has no force yet")
        self.assertIn('refine the mesh of "one.top" there', told)

    def test_a_ridge_is_met_the_less_late_the_finer_the_side_with_the_multipliers_is(self):
        above = '[[contact]]\ngroup = "one.top"\nagainst = "two.bottom"\n'
        case = self.bodies(wedge(4), strip(3, 2, 0.5), "[time]\nstep = 0.02\nend = 2.0\n", above)
        speed, gap = 0.1, 0.01

        def late(side, **refined):
            out = self.simulate(case, values={"part.two.move": f"[0.0, {1.5 + gap}]", "part.one.velocity": f"[0.0, {speed}]",
                                              "contact.0.multipliers_on": side, **refined}, options=("--quiet", "--force"))
            history = History(out / "history.csv")
            return speed * next(time for time, active in zip(history["time"], history["active_contacts"]) if active > 0) - gap

        for side, carries, other in (("group", "part.one.refine", "part.two.refine"), ("against", "part.two.refine", "part.one.refine")):
            first = late(side)
            self.assertAlmostEqual(late(side, **{other: 2}), first, delta=0.02 * first)
            self.assertLess(late(side, **{carries: 2}), 0.35 * first)

    def test_a_ridge_between_contact_points_is_one_itself(self):
        """With sliding = "large" the corners of the side without multipliers are contact points: large facets see them, too."""
        above = '[[contact]]\ngroup = "one.top"\nagainst = "two.bottom"\nsliding = "large"\nmultipliers_on = "against"\n'
        case = self.bodies(wedge(4), strip(3, 2, 0.5), "[time]\nstep = 0.02\nend = 2.2\n", above)
        values = {"part.two.move": "[0.0, 1.51]", "part.one.velocity": "[0.0, 0.1]", "material.0.law": "neo-hookean", "material.1.law": "neo-hookean"}
        forces = []
        for name, refined in (("coarse", {}), ("fine", {"part.two.refine": 2})):
            out = self.simulate(case, name=name, values={**values, **refined})
            self.assertEqual(self.warnings(out, "more than half a facet"), [])
            history = History(out / "history.csv")
            self.assertLess(max(history["max_penetration"]), 0.5 / 2)
            forces.append(min(history["pair_force.0_y"]))
        self.assertLess(forces[0], 0.0)  # on the body below
        self.assertAlmostEqual(forces[0] / forces[1], 1.0, delta=0.5)

    def test_ties_between_bodies_that_move_apart(self):
        tied = '[[contact]]\ngroup = "one.right"\nagainst = "two.left"\ntied = true\n'
        case = self.bodies(strip(8, 2, 0.25), strip(8, 3, 0.25), "[time]\nstep = 0.03\nend = 0.3\n", tied)
        together = self.simulate(case, values={"part.two.move": "[1.0, 0.0]"})
        self.assertEqual(self.warnings(together, "differ"), [])
        self.assertTrue(summary_of(together)["contacts"][0]["tied"])
        self.assertIn('"one.right" tied to "two.left"', self.expect_status(0, run("info", together)).stdout)
        torn = self.simulate(case, name="torn", values={"part.two.move": "[1.0, 0.0]", "part.one.velocity": "[0.1, 0.0]"})
        self.assertEqual(len(self.warnings(torn, "start with velocities that differ by up to 0.1")), 1)

    def test_surfaces_that_are_tied_and_meet(self):
        # Two blocks on a long one, tied to it and to each other; and with the long one's nodes as followers.
        self.write("long.msh", strip(9, 2, 0.25))
        self.write("short.msh", strip(4, 3, 0.5))
        tie = lambda one, two, side: f'[[contact]]\ngroup = "{one}"\nagainst = "{two}"\ntied = true\nmultipliers_on = "{side}"\n'
        parts = ('[part.base]\nfile = "long.msh"\nscale = 1.0\n[part.a]\nfile = "short.msh"\nscale = 0.5\nmove = [0.0, 0.25]\n'
                 '[part.b]\nfile = "short.msh"\nscale = 0.5\nmove = [0.5, 0.25]\n' + material("base", 1.0) + material("a", 1.0) + material("b", 1.0))
        for side in ("group", "against"):
            case = self.write(f"{side}.toml", parts + tie("a.bottom", "base.top", side) + tie("b.bottom", "base.top", side)
                              + tie("a.right", "b.left", "group") + "[time]\nstep = 0.03\nend = 0.3\n")
            # A uniform stretch has a uniform stress: only the ends pull.
            out = self.simulate(case, name=side, values={"part.base.velocity": "[0.1, 0.0]", "part.a.velocity": "[0.1, 0.0]",
                                                         "part.b.velocity": "[0.1, 0.0]"})
            history = History(out / "history.csv")
            self.assertLess(max(history["elastic_energy"]), 1e-20, "tied bodies that move alike have no strain")
            self.assertEqual(self.warnings(out, "differ"), [])

    def test_a_static_start_of_what_floats(self):
        above = '[[contact]]\ngroup = "one.top"\nagainst = "two.bottom"\n[[support]]\ngroup = "one.bottom"\ncomponents = ["x", "y"]\n'
        start = '[[support]]\ngroup = "two.left"\ncomponents = ["x"]\n[load]\ngravity = [0.0, -0.01]\n[initial]\ndisplacement = "static"\n[time]\nstep = 0.03\nend = 0.3\n'
        case = self.bodies(strip(8, 2, 0.25), strip(8, 3, 0.25), start, above)
        out = self.simulate(case, values={"part.two.move": "[0.0, 0.3]"})
        [told] = self.warnings(out, "closes the gap of contact.0")
        self.assertIn("0.05 wide", told)

    def test_nitsche_without_contact(self):
        self.write("one.msh", strip(4, 2, 0.25))
        case = self.write("alone.toml", '[mesh]\nfile = "one.msh"\n' + material("one", 1.0).replace("one.", "")
                          + '[mass]\ntype = "consistent"\n[time]\nscheme = "nitsche"\nstep = 0.01\nend = 0.1\n')
        self.simulate(case)

    def test_names_of_bodies_are_no_numbers_of_others(self):
        self.write("one.msh", strip(4, 2, 0.25))
        case = self.write("names.toml", '[part.1]\nfile = "one.msh"\n[part.0]\nfile = "one.msh"\nmove = [3.0, 0.0]\n'
                          + material("1", 1.0) + material("0", 1.0) + "[time]\nstep = 0.03\nend = 0.3\n")
        out = self.simulate(case)
        names = History(out / "history.csv").names  # which refuses duplicate columns
        self.assertEqual(len([name for name in names if name.startswith("momentum.")]), 4)
