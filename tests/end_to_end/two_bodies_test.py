"""Reports on two bodies in contact: impacts, forces and momenta of each, sliding, penetration, texts, resumption from a
checkpoint. Two bars of equal length and wave speed return all of the approach; the rest are balances."""

import re

from harness import History, TestCase, run, settings, summary_of

CELLS = 40


def strip(cells, rows, height, split=False):
    """Returns [0, 1] x [0, height] of rectangles, as a .msh file with the groups left, right (or left0, left1, … of
    each row), bottom, top and body."""
    at = lambda i, j: 1 + i * (rows + 1) + j
    nodes = [(i / cells, height * j / rows) for i in range(cells + 1) for j in range(rows + 1)]
    ends = [(f"{name}{j}" if split else name, [(at(i, j), at(i, j + 1))]) for name, i in (("left", 0), ("right", cells)) for j in range(rows)]
    groups = [(1, name, 1, [edge for own, edges in ends if own == name for edge in edges]) for name in dict(ends)]
    groups += [(1, "bottom", 1, [(at(i, 0), at(i + 1, 0)) for i in range(cells)]),
              (1, "top", 1, [(at(i, rows), at(i + 1, rows)) for i in range(cells)]),
              (2, "body", 3, [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(cells) for j in range(rows)])]
    elements = [(kind, tag, members) for tag, (_, _, kind, all_members) in enumerate(groups, start=1) for members in all_members]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {tag} "{name}"' for tag, (dimension, name, _, _) in enumerate(groups, start=1)]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes)), *(f"{n} {x!r} {y!r} 0" for n, (x, y) in enumerate(nodes, start=1)), "$EndNodes"]
    lines += ["$Elements", str(len(elements))]
    lines += [f"{n} {kind} 2 {tag} {tag} {' '.join(map(str, members))}" for n, (kind, tag, members) in enumerate(elements, start=1)]
    return "\n".join([*lines, "$EndElements", ""])


def material(part, density, wave_speed=1.0):
    return f'[[material]]\ngroup = "{part}.body"\ndensity = {density}\nyoung = {density * wave_speed**2}\npoisson = 0.0\n'


# The bar "one" comes at the speed 1 from a gap of 0.1; "two" has a third of its mass and stiffness, and other nodes.
BARS = ('[part.one]\nfile = "one.msh"\nvelocity = [1.0, 0.0]\n[part.two]\nfile = "two.msh"\nmove = [1.1, 0.0]\n'
        + material("one", 3.0) + material("two", 1.0)
        + '[[contact]]\ngroup = "one.right"\nagainst = "two.left"\n'
        '[[support]]\ngroup = ["one.top", "one.bottom", "two.top", "two.bottom"]\ncomponents = ["y"]\n'
        f'[time]\nstep = {0.5 / CELLS}\nend = 3.0\n'
        '[[probe]]\nname = "between"\ncontact = 0\n[[probe]]\nname = "foot"\nboundary = "two.left"\n')
EXPECT = ('[[expect]]\nquantity = "max_abs(history.pair_force.0_x)"\nminimum = 0.01\n'
          '[[expect]]\nquantity = "history.momentum.two_x[-1]"\nminimum = 0.01\n'
          '[[expect]]\nquantity = "summary.impacts.0.against.velocity_after.0"\nvalue = 1.5\nrelative = 0.01\n')

# A block on a longer one, pressed on it by gravity, that slides at the speed 1 over facets of 1/8 and 1/4.
BLOCKS = ('[part.slab]\nfile = "slab.msh"\n[part.block]\nfile = "block.msh"\nmove = [0.0, 0.25]\nvelocity = [1.0, 0.0]\n'
          + material("slab", 1.0, 50.0) + material("block", 1.0, 50.0)
          + '[[contact]]\ngroup = "slab.top"\nagainst = "block.bottom"\n[[support]]\ngroup = "slab.bottom"\n'
          'components = ["x", "y"]\n[load]\ngravity = [0.0, -1.0]\n[time]\nstep = 0.005\nend = 0.1\n')


class TwoBodies(TestCase):
    def bars(self, more=""):
        self.write("one.msh", strip(CELLS, 2, 0.05))
        self.write("two.msh", strip(CELLS, 3, 0.05))
        return self.write("bars.toml", BARS + more)

    def blocks(self):
        self.write("slab.msh", strip(4, 2, 0.25))
        self.write("block.msh", strip(8, 4, 0.5))
        return self.write("blocks.toml", BLOCKS)

    def test_a_probe_in_a_place_of_two_nodes_is_at_the_one_with_multipliers(self):
        """It is at that of the finer side, whichever body comes first: the force there is the pressure over its own part of the
        height."""
        height, rows = 0.1, {"one": 2, "two": 4}
        for name, own in rows.items():
            self.write(f"{name}.msh", strip(10, own, height))
        for first, second in (("one", "two"), ("two", "one")):
            for group, against in (("one.right", "two.left"), ("two.left", "one.right")):
                placed = {"one": "velocity = [0.1, 0.0]\n", "two": "move = [1.0, 0.0]\n"}
                case = self.write("touching.toml", "".join(f'[part.{part}]\nfile = "{part}.msh"\n{placed[part]}' for part in (first, second))
                                  + material("one", 3.0) + material("two", 1.0)
                                  + f'[[contact]]\ngroup = "{group}"\nagainst = "{against}"\n[time]\nstep = 0.05\nend = 0.3\n'
                                  '[[probe]]\nname = "between"\nat = [1.0, 0.05]\n')
                process = self.expect_status(0, run("run", case, "-o", self.folder / "touching", "--force"))
                self.assertIn('it is at the node of body "two", which carries the multipliers', process.stderr)
                history = History(self.folder / "touching" / "history.csv")
                pressure, reaction = history["between.pressure"][-1], history["between.reaction_normal"][-1]
                self.assertGreater(pressure, 0.0)
                self.assertAlmostEqual(reaction, pressure * height / rows["two"], delta=1e-12 * pressure)

    def test_an_impact_names_both_bodies(self):
        out = self.simulate(self.bars(EXPECT))
        found = summary_of(out)
        [impact] = found["impacts"]
        one, two = (body["mass"] for body in found["bodies"])
        self.assertAlmostEqual(one, 0.15, delta=1e-12)
        self.assertEqual((impact["body"], impact["against"]["body"], impact["obstacle"]), (0, 1, None))
        # The missing energy is left in the mesh as vibrations; they carry no momentum.
        self.assertAlmostEqual(impact["restitution"], 1.0, delta=0.01)
        # Momenta and impulse are complete.
        change = [impact["velocity_after"][0] - impact["velocity_before"][0],
                  impact["against"]["velocity_after"][0] - impact["against"]["velocity_before"][0]]
        self.assertAlmostEqual(one * change[0], impact["impulse"][0], delta=1e-12)
        self.assertAlmostEqual(two * change[1], -impact["impulse"][0], delta=1e-12)
        self.assertAlmostEqual(change[1], 1.5, delta=0.01)
        self.assertAlmostEqual(impact["kinetic_energy_ratio"], 1.0, delta=0.02)
        text = self.expect_status(0, run("info", out)).stdout
        self.assertIn('bodies "one" and "two" first at', text)
        self.assertIn(f'restitution {impact["restitution"]:.4g}', text)
        self.assertNotIn('on ""', text)
        self.assertIn('contact of "one.right" against "two.left"', text)
        self.assertIn('"two.left" carries the multipliers: its mesh is finer', text)

    def test_forces_and_momenta_of_each(self):
        out = self.simulate(self.bars())
        history = History(out / "history.csv")
        force = history["pair_force.0_x"]
        self.assertLess(min(force), -0.05, "it holds the first bar up")
        self.assertGreater(1e-3 * -min(force), max(force))
        self.assertEqual(force, history["between.force_x"])
        for own, other in zip(force, history["foot.force_x"]):
            self.assertAlmostEqual(own, -other, delta=1e-14)
        self.assertEqual(set(history["contact_force_x"]), {0.0})
        largest = max(map(abs, history["momentum_x"]))
        for whole, one, two in zip(history["momentum_x"], history["momentum.one_x"], history["momentum.two_x"]):
            self.assertAlmostEqual(one + two, whole, delta=1e-12 * largest)
        self.assertAlmostEqual(history["momentum.one_x"][0], 0.15, delta=1e-12)
        self.assertAlmostEqual(history["momentum.two_x"][-1], summary_of(out)["bodies"][1]["mass"] * 1.5, delta=1e-3)
        # In the opposite order in the case the force has the opposite sign, whichever side carries the multipliers.
        for side in ("group", "against"):
            turned = self.simulate(self.bars(), name=side, values={"contact.0.group": "two.left", "contact.0.against": "one.right",
                                                                   "contact.0.multipliers_on": side})
            self.assertGreater(max(History(turned / "history.csv")["pair_force.0_x"]), 0.05, side)
            self.assertEqual(summary_of(turned)["impacts"][0]["body"], 1, side)

    def test_two_contacts_of_two_bodies_are_one_impact(self):
        for name in ("one.msh", "two.msh"):
            self.write(name, strip(CELLS, 2, 0.05, split=True))
        both = '[[contact]]\ngroup = "one.right0"\nagainst = "two.left0"\n[[contact]]\ngroup = "two.left1"\nagainst = "one.right1"\n'
        case = BARS.replace('[[contact]]\ngroup = "one.right"\nagainst = "two.left"\n', both).replace('boundary = "two.left"', 'boundary = "two.left0"')
        # Under Newmark's scheme the forces of the history are those that act.
        out = self.simulate(self.write("split.toml", case), values={"time.scheme": "newmark", "time.preset": "trapezoidal"})
        [impact] = summary_of(out)["impacts"]
        self.assertEqual((impact["body"], impact["against"]["body"]), (0, 1), "in the order of the first contact")
        mass = summary_of(out)["bodies"][0]["mass"]
        self.assertAlmostEqual(mass * (impact["velocity_after"][0] - impact["velocity_before"][0]), impact["impulse"][0], delta=1e-12)
        history = History(out / "history.csv")
        low, high = history["pair_force.0_x"], history["pair_force.1_x"]
        self.assertLess(min(low), -0.015)
        self.assertGreater(max(high), 0.015, "that on the second bar, as the second contact names it first")
        largest = max(abs(a - b) for a, b in zip(low, high))
        self.assertAlmostEqual(impact["largest_force"], largest, delta=1e-12)

    def test_a_run_goes_on(self):
        case = self.bars()
        whole = self.simulate(case, name="whole")
        parts = self.simulate(case, name="parts", values={"time.end": 1.0})
        self.expect_status(0, run("run", case, "-o", parts, "--resume", "--quiet"))
        for entry in ("impacts", "sliding", "extrema", "unwatched_penetration"):
            self.assertEqual(summary_of(parts)[entry], summary_of(whole)[entry], entry)
        self.assertEqual((parts / "history.csv").read_bytes(), (whole / "history.csv").read_bytes())

    def test_texts_before_a_run(self):
        case = self.bars()
        for command in ("validate", "info"):
            text = self.expect_status(0, run(command, case)).stdout
            line = next(line for line in text.splitlines() if line.lstrip().startswith('"one.right" against "two.left"'))
            self.assertIn('"two.left" carries the multipliers: its mesh is finer', line)
            self.assertIn("4 contact points on 100 % of its area, gaps from 0.1 to 0.1", line)
            self.assertIn("the bodies would meet at t = 0.1 (the run ends at 3)", line)
        apart = self.expect_status(0, run("validate", case, *settings({"part.one.velocity": "[-1.0, 0.0]"}))).stdout
        self.assertIn("the bodies do not approach each other", apart)

    def test_sliding_beyond_half_a_facet_is_told_once(self):
        out = self.simulate(self.blocks())
        found = summary_of(out)
        [sliding] = found["sliding"]
        self.assertAlmostEqual(sliding["limit"], 0.0625, delta=1e-12)
        self.assertGreater(sliding["slip"], sliding["limit"])
        self.assertLessEqual(sliding["slip"], 0.1 + 1e-3, "no farther than the block has come")
        self.assertAlmostEqual(sliding["time_beyond"], 0.0625, delta=0.03)
        told = [text for text in found["warnings"] if "have slid along each other" in text]
        self.assertEqual(len(told), 1, found["warnings"])
        self.assertIn('"slab.top" and "block.bottom"', told[0])
        self.assertIn("BEYOND SMALL SLIDING", self.expect_status(0, run("info", out)).stdout)
        short = self.simulate(self.blocks(), name="short", values={"time.end": 0.04})
        self.assertIsNone(summary_of(short)["sliding"][0]["time_beyond"])
        self.assertEqual([text for text in summary_of(short)["warnings"] if "slid" in text or "overlap" in text], [])
        self.assertEqual(summary_of(short)["unwatched_penetration"]["found"], [])
        # The advice of the message.
        large = self.simulate(self.blocks(), name="large", values={"contact.0.sliding": "large"})
        self.assertEqual([text for text in summary_of(large)["warnings"] if "slid" in text or "overlap" in text], [])

    def test_one_body_has_no_columns_of_bodies(self):
        self.write("one.msh", strip(CELLS, 2, 0.05))
        case = self.write("alone.toml", '[mesh]\nfile = "one.msh"\n' + material("one", 1.0).replace("one.", "")
                          + '[obstacle.wall]\ntype = "plane"\npoint = [1.1, 0.0]\nnormal = [-1.0, 0.0]\n'
                          '[[contact]]\ngroup = "right"\nobstacle = "wall"\n[initial]\nvelocity = [1.0, 0.0]\n'
                          "[time]\nstep = 0.0125\nend = 0.5\n")
        out = self.simulate(case)
        names = History(out / "history.csv").names
        self.assertEqual([name for name in names if re.search(r"pair_force|momentum\.", name)], [])
        self.assertNotIn("against", summary_of(out)["impacts"][0])
        self.assertEqual(summary_of(out)["sliding"], [])
