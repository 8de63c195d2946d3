"""Penetration that no contact prevents is found and reported: the whole boundary against obstacles, bodies against each
other, contact at the rim of its group. The depths are computed here from the fields, or follow from a free fall."""

import json
import re
import shutil

import meshio

from harness import SOURCE, TestCase, body_case, gravity, run, settings, summary_of, write_msh

OBLIQUE = SOURCE / "cases" / "oblique" / "oblique.toml"
# Faster than its contact group, 20 degrees about the lowest point, is wide enough for.
FAST = {"initial.velocity": "[0.0, -3.0]", "time.step": 1e-5, "time.end": 6e-3, "contact.0.friction": 0.0}

CASE = body_case("blocks.msh", [0.0, 0.0], [0.0, 1.0], gravity(0.0, -10.0), body="low", bottom="base", lame=(1000.0, 1000.0),
                 mass="equivalent", step=0.001, end=0.2)
CASE += '[[material]]\ngroup = "high"\ndensity = 1.0\nlambda = 1000.0\nmu = 1000.0\n'


def blocks(path, gap=0.1):
    """Returns a block with its base (in the group "base") on y = 0, and a smaller one above it that touches nothing:
    squares of 0.1."""
    nodes, cells = [], []
    for tag, (x, y, columns, rows) in enumerate(((0.0, 0.0, 10, 5), (0.25, 0.5 + gap, 5, 3)), start=1):
        first = len(nodes) + 1
        nodes += [(x + 0.1 * i, y + 0.1 * j) for j in range(rows + 1) for i in range(columns + 1)]
        at = lambda i, j: first + j * (columns + 1) + i
        cells += [(3, tag, (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))) for j in range(rows) for i in range(columns)]
        if tag == 1:
            cells += [(1, 3, (at(i, 0), at(i + 1, 0))) for i in range(columns)]
    write_msh(path, ['2 1 "low"', '2 2 "high"', '1 3 "base"'], nodes, cells)


def found_in(output):
    return summary_of(output)["unwatched_penetration"]


class Penetration(TestCase):
    def test_the_boundary_beyond_a_contact_group(self):
        """All nodes that enter the obstacle are in the fields: the deepest node of all, except those that contact
        holds."""
        output = self.simulate(OBLIQUE, values={**FAST, "output.fields_every": 1})
        entry = found_in(output)
        deepest, when = 0.0, None
        with meshio.xdmf.TimeSeriesReader(output / "results.xdmf") as reader:
            points, _ = reader.read_points_cells()
            for step in range(reader.num_steps):
                time, data, _ = reader.read_data(step)
                free = data["contact_status"] < 0
                depth = -(points[:, 1] + data["displacement"][:, 1])[free].min()
                if depth > deepest:
                    deepest, when = depth, time
        self.assertGreater(deepest, 1e-5, "this case goes deep")
        [found] = entry["found"]
        self.assertEqual(found["obstacle"], "foundation")
        self.assertIn("upper", found["groups"])
        self.assertAlmostEqual(found["depth"], deepest, delta=1e-12 * deepest)
        self.assertAlmostEqual(found["time"], when, delta=1e-12)
        self.assertAlmostEqual(found["relative_depth"], deepest / 0.04, delta=0.01 * deepest / 0.04)
        self.assertAlmostEqual(-found["place"][1], deepest, delta=1e-12 * deepest)
        [rim] = entry["contact_beyond_rim"]
        self.assertEqual((rim["group"], rim["obstacle"]), ("lower", "foundation"))
        self.assertLessEqual(rim["time"], found["first_time"])
        warnings = summary_of(output)["warnings"]
        self.assertEqual(sum("inside obstacle \"foundation\"" in text and "\"upper\"" in text for text in warnings), 1, warnings)
        self.assertEqual(sum("has reached the rim of the group" in text for text in warnings), 1, warnings)
        text = self.expect_status(0, run("info", output)).stdout
        self.assertIn(f"PENETRATION WITHOUT CONTACT: the body in \"foundation\", {found['depth']:.3g} deep", text)
        # The table of several runs has the worst of both, and states which results were not checked.
        other = self.folder / "unwatched"
        shutil.copytree(output, other)
        unwatched = summary_of(other)
        unwatched["unwatched_penetration"] |= {"found": [], "contact_beyond_rim": [], "not_watched": ["the rest"]}
        (other / "summary.json").write_text(json.dumps(unwatched), encoding="utf-8")
        rows = self.expect_status(0, run("info", output, other)).stdout.split("\n")[2:4]
        self.assertIn(f" {found['depth']:.3g} ", rows[0])
        self.assertIn(" ≥ ", rows[1])
        self.assertIn("not checked for interpenetration: the rest", self.expect_status(0, run("info", other)).stdout)
        # The report judges the same.
        for directory, checked in ((output, True), (other, False)):
            self.expect_status(0, run("report", directory))
            page = (directory / "report.html").read_text(encoding="utf-8")
            data = re.search(r'<script type="[^"]*" id="ricochet-runs">(.*?)</script>', page, re.DOTALL)[1]
            judgement = json.loads(data)["runs"][0]["judgement"]
            self.assertEqual(judgement["penetration_not_watched"], "" if checked else "the rest")
            if checked:
                self.assertEqual(judgement["penetration"], found["depth"])
                self.assertIn("foundation", judgement["unwatched_penetration"])
                self.assertEqual(judgement["contact_beyond_rim"], "lower")

    def test_a_group_that_is_wide_enough(self):
        output = self.simulate(OBLIQUE, values={"output.fields_every": 0})
        entry = found_in(output)
        self.assertTrue(entry["checked"])
        self.assertEqual((entry["depth"], entry["found"], entry["contact_beyond_rim"]), (0.0, [], []))
        self.assertEqual(entry["looks_at_obstacles"], summary_of(output)["steps"] + 1)

    def two_blocks(self, name, gap=0.1, values=None, more=""):
        blocks(self.folder / "blocks.msh", gap)
        case = self.write("case.toml", CASE + more)
        return self.simulate(case, name, values)

    def test_two_bodies(self):
        """One falls freely through the other: ½ g t² − gap, exact with the trapezoidal rule."""
        output = self.two_blocks("out")
        entry = found_in(output)
        [found] = entry["found"]
        self.assertEqual(found["bodies"], ['body "low"', 'body "high"'])
        self.assertIsNone(found["obstacle"])
        # The lower one is compressed slightly by its own weight.
        self.assertAlmostEqual(found["depth"], 0.5 * 10.0 * 0.2**2 - 0.1, delta=0.003)
        self.assertAlmostEqual(found["time"], 0.2, delta=1e-9)
        met = (2 * 0.1 / 10.0) ** 0.5
        self.assertGreater(found["first_time"], met - 0.001)
        self.assertLess(0.5 * 10.0 * found["first_time"] ** 2 - 0.1, 0.25 * 0.1 + 0.004, "a quarter of an edge at most")
        self.assertLess(entry["looks_at_bodies"], 60)
        warnings = summary_of(output)["warnings"]
        self.assertEqual(len(warnings), 1, warnings)
        self.assertIn('body "low" and body "high" overlap', warnings[0])
        # The same names wherever bodies are distinguished.
        self.assertEqual([body["name"] for body in summary_of(output)["bodies"]], ['body "low"', 'body "high"'])
        self.assertIn('impact 1: body "low" on "floor"', self.expect_status(0, run("info", output)).stdout)
        self.assertIn('  body "high": mass', self.expect_status(0, run("info", self.folder / "case.toml")).stdout)

    def test_an_overlap_of_the_start(self):
        """Also with an obstacle that no contact names: each is reported once, at the start."""
        ceiling = "[obstacle.ceiling]\ntype = \"plane\"\npoint = [0.0, 0.7]\nnormal = [0.0, -1.0]\n"
        output = self.two_blocks("out", gap=-0.03, values={"time.end": 0.01}, more=ceiling)
        entry = found_in(output)
        self.assertEqual([found["first_time"] for found in entry["found"]], [0.0, 0.0])
        in_ceiling, overlap = entry["found"]
        self.assertEqual((in_ceiling["obstacle"], in_ceiling["bodies"]), ("ceiling", ['body "high"']))
        self.assertAlmostEqual(in_ceiling["depth"], 0.07, delta=1e-9)
        self.assertGreaterEqual(overlap["depth"], 0.03 - 1e-9)
        warnings = summary_of(output)["warnings"]
        self.assertEqual(len(warnings), 2, warnings)
        for text in warnings:
            self.assertTrue(text.startswith("at the start"), text)
        self.assertIn("no [[contact]] names this obstacle", warnings[0])

    def test_a_run_that_is_resumed(self):
        """From its last checkpoint it finds the same as the whole run, and has repeated its messages."""
        for case, values in ((OBLIQUE, FAST), (None, {})):
            values = {**values, "output.checkpoint_every": 130 if case is None else 250}
            name = "bodies" if case is None else "obstacle"
            output = self.two_blocks(name, values=values) if case is None else self.simulate(case, name, values)
            whole = summary_of(output)
            (output / "summary.json").unlink()
            case = case or self.folder / "case.toml"
            self.expect_status(0, run("run", case, "-o", output, "--resume", "--quiet", *settings(values)))
            resumed = summary_of(output)
            self.assertTrue(resumed["resumed_at"])
            self.assertEqual(resumed["unwatched_penetration"], whole["unwatched_penetration"])
            self.assertEqual(resumed["warnings"], whole["warnings"])
