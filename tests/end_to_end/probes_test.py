"""Probes and sensors: consistency with each other, with the fields and with physical laws."""

import meshio
import numpy

from harness import DISC, MESHES, SOURCE, History, TestCase, block_case, run, summary_of, total_variation, with_more

DISC_PROBES = """
[[probe]]
name = "rim"
boundary = "lower"
[[probe]]
name = "body"
group = "body"
[[probe]]
name = "half"
group = "lower"
[[probe]]
name = "floor"
contact = 0
[[probe]]
name = "axis"
from = [0.0, 0.041]
to = [0.0, 0.001]
within = 5e-4
every = 10
[[probe]]
name = "top"
at = [0.0, 0.041]
every = 10
"""

BALL_PROBES = """
[[probe]]
name = "ball"
group = "ball"
[[probe]]
name = "ground"
contact = 0
[[probe]]
name = "under"
boundary = "lower"
about = [0.0, 0.0, 0.5]
"""


def vector(history, name, axes="xy"):
    return numpy.array([history[f"{name}_{axis}"] for axis in axes]).T


class Probes(TestCase):
    def test_the_order_of_probes_does_not_matter_to_a_comparison(self):
        """The variation of the contact force is that of the resultant; that of a probe stands under its name."""
        probes = ['[[probe]]\nname = "low"\nat = [0.0, 0.0]\n', '[[probe]]\nname = "high"\nat = [0.1, 1.0]\n']
        runs = [self.simulate(self.write("case.toml", block_case().split("[[probe]]")[0].replace('group = "bottom"', 'group = "boundary"')
                                         + "".join(order)), name) for name, order in (("a", probes), ("b", probes[::-1]), ("c", []))]
        said = self.expect_status(0, run("info", *runs)).stdout
        history = History(runs[0] / "history.csv")
        variation = max(total_variation(history[f"contact_force_{axis}"]) for axis in "xy")
        self.assertGreater(variation, 0.0)
        rows = [next(line for line in said.splitlines() if line.startswith(f"{folder} ")).split() for folder in runs]
        self.assertEqual([row[-3] for row in rows], [f"{variation:.4g}"] * 3)
        self.assertIn("  variation of contact force: the total variation of contact_force_* or pair_force.*", said)
        own = {name: f"{name}.reaction_normal {total_variation(history[f'{name}.reaction_normal']):.4g}" for name in ("low", "high")}
        self.assertNotEqual(own["low"].split()[1], own["high"].split()[1])
        self.assertIn(f"  {runs[0]}: variation of {own['low']}, {own['high']}\n", said)
        self.assertIn(f"  {runs[1]}: variation of {own['high']}, {own['low']}\n", said)

    def test_a_disc_with_friction(self):
        case = self.write("disc.toml", with_more(DISC, DISC_PROBES))
        results = self.simulate(case, values={
            "contact.0.friction": 0.3, "initial.velocity": "[0.05,-0.1]", "time.end": 0.03,
            "time.scheme": "newmark", "time.preset": "textbook-half", "mass.type": "consistent",
            "output.fields_every": 10, "output.fields": '["all"]'})
        history = History(results / "history.csv")
        # One contact, whose nodes are those of the boundary: three ways to the same force.
        force = vector(history, "contact_force")
        self.assertGreater(numpy.abs(force[:, 0]).max(), 1.0)
        size = numpy.abs(force).max()
        for name in ("rim.force", "floor.force"):
            numpy.testing.assert_allclose(vector(history, name), force, rtol=0, atol=1e-13 * size)
        # The consistent mass times the mean velocity is the momentum: polygons of straight triangles.
        points, cells, read = self.frames(results)
        mass = 6000.0 * sum(0.5 * numpy.cross(points[t[1], :2] - points[t[0], :2], points[t[2], :2] - points[t[0], :2])
                            for t in cells)
        numpy.testing.assert_allclose(mass * vector(history, "body.velocity_average"), vector(history, "momentum"),
                                      rtol=0, atol=1e-12 * abs(mass))
        self.compare_extrema(history, read)
        self.compare_samples(results, history)

    def frames(self, results):
        with meshio.xdmf.TimeSeriesReader(results / "results.xdmf") as reader:
            points, cells = reader.read_points_cells()
            return points, cells[0].data, [reader.read_data(k) for k in range(reader.num_steps)]

    def compare_extrema(self, history, read):
        rows = {at: i for i, at in enumerate(history["time"])}
        lower = numpy.unique(meshio.read(SOURCE / "cases/disc/disc.msh").cells_dict["line"])
        in_boundary = numpy.isin(numpy.arange(len(read[0][1]["gap"])), lower) & ~numpy.isnan(read[0][1]["gap"])
        for at, nodal, cell in read:
            row = rows[at]
            for k, axis in enumerate("xy"):
                for motion in ("displacement", "velocity"):
                    for name, values in (("body", nodal[motion][:, k]), ("half", nodal[motion][in_boundary, k])):
                        self.assertEqual(history[f"{name}.{motion}_minimum_{axis}"][row], values.min())
                        self.assertEqual(history[f"{name}.{motion}_maximum_{axis}"][row], values.max())
            stress = cell["von_mises"][0]
            self.assertEqual(history["body.von_mises_minimum"][row], stress.min())
            self.assertEqual(history["body.von_mises_maximum"][row], stress.max())
            self.assertTrue(stress.min() <= history["body.von_mises_average"][row] <= stress.max() or stress.max() == 0)

    def compare_samples(self, results, history):
        sampled = History(results / "probes-10.csv")
        self.assertEqual(sampled["step"], history["step"][::10])
        self.assertEqual(sampled["time"], history["time"][::10])
        # The segment runs from the top to the lowest node, which the case watches in every row.
        last = max(int(name.split(".")[1]) for name in sampled.names if name.startswith("axis."))
        self.assertGreater(last, 5)
        for column in ("displacement_x", "displacement_y", "velocity_y", "reaction_normal", "reaction_tangential_x", "gap"):
            self.assertEqual(sampled[f"axis.{last}.{column}"], history[f"lowest.{column}"][::10])
        self.assertEqual(sampled["axis.0.displacement_y"], sampled["top.displacement_y"])
        summary = summary_of(results)
        along = [p for p in summary["probes"] if p["name"].startswith("axis.")]
        heights = [p["position"][1] for p in along]
        self.assertEqual(heights, sorted(heights, reverse=True))
        self.assertTrue(all(abs(p["position"][0]) <= 5e-4 and abs(p["position"][0]) == p["distance"] for p in along))

    def test_centre_and_area_of_a_contact(self):
        """A block on its edge: every contact node is watched, so that the resultant can be summed here."""
        bottom = ('[[probe]]\nname = "edge"\nfrom = [0.1, 0.2]\nto = [1.3, 0.1]\nwithin = 1e-3\n'
                  '[[probe]]\nname = "contact"\ncontact = 0\n'
                  '[[probe]]\nname = "bottom"\nboundary = "bottom"\nabout = [0.3, -0.2]\n')
        case = self.write("case.toml", block_case() + bottom)
        results = self.simulate(case, values={"time.end": 1.0, "contact.0.friction": 0.4})
        history = History(results / "history.csv")
        summary = summary_of(results)
        nodes = [p for p in summary["probes"] if p["name"].startswith("edge.")]
        self.assertEqual(len(nodes), 4)
        normal = numpy.array([history[f"{p['name']}.reaction_normal"] for p in nodes])
        tangential = numpy.array([history[f"{p['name']}.reaction_tangential_x"] for p in nodes])
        x = numpy.array([[p["position"][0]] for p in nodes])
        total = normal.sum(axis=0)
        size = total.max()
        closed = total > 0
        self.assertGreater(closed.sum(), 5)
        self.assertGreater((~closed).sum(), 5)
        numpy.testing.assert_allclose(history["contact.force_y"], total, rtol=0, atol=1e-12 * size)
        numpy.testing.assert_allclose(history["contact.force_x"], tangential.sum(axis=0), rtol=0, atol=1e-12 * size)
        centre = numpy.array(history["contact.centre_x"])
        numpy.testing.assert_allclose(centre[closed], ((normal * x).sum(axis=0) / numpy.where(closed, total, 1))[closed],
                                      rtol=1e-12)
        self.assertFalse(centre[~closed].any())
        # Without friction the resultant at the centre has the moment of all of them, about any point.
        smooth = History(self.simulate(case, "smooth", values={"time.end": 1.0}) / "history.csv")
        moment = numpy.array(smooth["bottom.moment_z"])
        expected = (numpy.array(smooth["contact.centre_x"]) - 0.3) * numpy.array(smooth["contact.force_y"])
        self.assertGreater(numpy.abs(moment).max(), 0.0)
        numpy.testing.assert_allclose(moment, expected, rtol=0, atol=1e-12 * numpy.abs(moment).max())
        self.assertFalse(numpy.array(history["contact.area"])[~closed].any())
        # Edges between pressed nodes count in full, those with one pressed end in part.
        length = numpy.hypot(1.2, 0.1) / 3
        pressed = normal > 0
        whole = length * (pressed[1:] & pressed[:-1]).sum(axis=0)
        touched = length * (pressed[1:] | pressed[:-1]).sum(axis=0)
        area = numpy.array(history["contact.area"])
        self.assertTrue((area >= whole - 1e-12).all() and (area <= touched + 1e-12).all())
        numpy.testing.assert_allclose(area[pressed.all(axis=0)], 3 * length, atol=1e-12)
        self.assertTrue((touched > whole).any())
        arm = numpy.array([[p["position"][0] - 0.3, p["position"][1] + 0.2] for p in nodes])
        moment = (arm[:, :1] * normal - arm[:, 1:] * tangential).sum(axis=0)
        numpy.testing.assert_allclose(history["bottom.moment_z"], moment, rtol=0, atol=1e-12 * size)

    def test_supports_carry_the_weight(self):
        """At rest under gravity with the sides held, force and moment of the supports are minus those of the weight."""
        text = block_case().replace('[[contact]]\ngroup = "bottom"\nobstacle = "floor"\n', "")
        text = text[:text.index("[obstacle.floor]")] + text[text.index("[load]"):]
        text += ('[[support]]\ngroup = "sides"\ncomponents = ["x", "y"]\n[initial]\ndisplacement = "static"\n'
                 '[[probe]]\nname = "sides"\nboundary = "sides"\n')
        results = self.simulate(self.write("case.toml", text), values={"time.end": 0.05})
        history = History(results / "history.csv")
        mesh = meshio.read(MESHES / "quadrilateral_o1_msh41_ascii.msh")
        area, first = 0.0, 0.0
        for quad in mesh.cells_dict["quad"]:
            for t in (quad[[0, 1, 2]], quad[[0, 2, 3]]):
                p = mesh.points[t][:, :2]
                own = 0.5 * abs(numpy.cross(p[1] - p[0], p[2] - p[0]))
                area += own
                first += own * p[:, 0].mean()
        for row in range(len(history.rows)):
            self.assertAlmostEqual(history["sides.force_x"][row], 0.0, delta=1e-11)
            self.assertAlmostEqual(history["sides.force_y"][row], 10.0 * area, delta=1e-11)
            self.assertAlmostEqual(history["sides.moment_z"][row], 10.0 * first, delta=1e-11)

    def test_supports_apart_from_contacts(self):
        """Sides held along x share the lower corners with the contact: forces along y on these belong to the contact,
        not to the supports."""
        corners = '[[probe]]\nname = "other"\nat = [0.1, 0.2]\n[[probe]]\nname = "sides"\nboundary = "sides"\n'
        text = block_case() + '[[support]]\ngroup = "sides"\ncomponents = ["x"]\n' + corners
        results = self.simulate(self.write("case.toml", text), values={"time.end": 0.6})
        history = History(results / "history.csv")
        pressed = numpy.array(history["foot.reaction_normal"]) + numpy.array(history["other.reaction_normal"])
        self.assertGreater(pressed.max(), 0.0)
        numpy.testing.assert_allclose(history["sides.force_y"], pressed, rtol=0, atol=1e-12 * pressed.max())
        self.assertFalse(numpy.array(history["sides.support_y"]).any())
        self.assertEqual(history["sides.force_x"], history["sides.support_x"])
        said = "its force and moment are the sum of supports and of contacts, which share 2 nodes with it; support and"
        summary = summary_of(results)
        self.assertEqual([entry["name"] for entry in summary["probe_sums"]], ["sides"])
        self.assertTrue(summary["probe_sums"][0]["sums"].startswith(said))
        self.assertIn(f'probe "sides": {said}', self.expect_status(0, run("info", results)).stdout)

    def test_a_ball(self):
        path = SOURCE / "cases/ball/ball.toml"
        case = self.write("ball.toml", with_more(path, BALL_PROBES))
        results = self.simulate(case, values={"output.fields_every": 80})
        history = History(results / "history.csv")
        force = vector(history, "contact_force", "xyz")
        size = numpy.abs(force).max()
        self.assertGreater(size, 0)
        for name in ("ground.force", "under.force"):
            numpy.testing.assert_allclose(vector(history, name, "xyz"), force, rtol=0, atol=1e-12 * size)
        self.assertGreater(max(history["ground.area"]), 0)
        read = self.frames(results)[2]
        rows = {at: i for i, at in enumerate(history["time"])}
        for at, _, cell in read:
            self.assertEqual(history["ball.von_mises_maximum"][rows[at]], cell["von_mises"][0].max())

    def test_moments_at_finite_strain_have_the_places_of_their_instant(self):
        """A rubber puck that is thrown aside and flattened: the impulse of the moments is the change of the angular
        momentum, to first order in the step, as the moments are those of its end; on a plane they are those of the
        force at the centre. With reference positions half of it was missing."""
        case = self.write("rolls.toml", f"""[mesh]
file = "{SOURCE / 'cases' / 'puck' / 'puck.msh'}"
[[material]]
group = "puck"
density = 1200.0
law = "neo-hookean"
young = 1.0e6
poisson = 0.4
[obstacle.wall]
type = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
[[contact]]
group = "skin"
obstacle = "wall"
friction = 0.3
[initial]
velocity = [3.0, -3.0]
[time]
step = 4.0e-5
end = 4.0e-3
[output]
fields_every = 0
[[probe]]
name = "rim"
boundary = "skin"
[[probe]]
name = "zone"
contact = 0
""")
        errors = []
        for step in (2e-5, 1e-5):
            h = History(self.simulate(case, f"rolls-{step}", {"time.step": step}) / "history.csv")
            moment, steps = numpy.array(h["rim.moment_z"]), numpy.diff(h["time"])
            of_centre = (numpy.array(h["zone.centre_x"]) * h["zone.force_y"] - numpy.array(h["zone.centre_y"]) * h["zone.force_x"])
            numpy.testing.assert_allclose(moment, of_centre, rtol=0, atol=1e-12 * abs(moment).max())
            change = h["angular_momentum_z"][-1] - h["angular_momentum_z"][0]
            errors.append(abs((steps * moment[1:]).sum() / change - 1))
        self.assertLess(errors[0], 0.003)
        self.assertLess(errors[1], 0.6 * errors[0])

    def test_at_a_node_of_two_contacts(self):
        """Gap and pressure are those with the nearer obstacle, whichever comes first in the case."""
        roof = ('[obstacle.roof]\ntype = "plane"\npoint = [0.0, 5.0]\nnormal = [0.0, -1.0]\n'
                '[[contact]]\ngroup = "bottom"\nobstacle = "roof"\n')
        text = block_case().replace("[obstacle.floor]", roof + "[obstacle.floor]")
        process = self.expect_status(0, run("run", self.write("two.toml", text), "-o", self.folder / "two"))
        self.assertIn('refer to obstacle "floor", the nearest one at the start', process.stderr)
        self.assertAlmostEqual(History(self.folder / "two" / "history.csv")["foot.gap"][0], 0.1)

    def test_what_is_refused(self):
        for probe, message in (
                ('at = [0.0, 0.0]\ngroup = "body"', "group"),
                ('contact = 1', "there is no contact 1: the case has 1 of them, numbered from 0"),
                ('contact = -1', "at least 0"),
                ('group = "bodies"', "bodies"),
                ('boundary = "body"', "body"),
                ('boundary = ""', '"boundary" must be the name of a group'),
                ('from = [5.0, 5.0]\nto = [6.0, 6.0]', 'set "within"'),
                ('from = [5.0, 5.0]\nto = [5.0, 5.0]', "same point"),
                ('from = [5.0, 5.0]', '"to"'),
                ('group = "body"\nabout = [0.0, 0.0]', 'for probes with "boundary" only'),
                ('at = [0.0, 0.0]\nwithin = 1.0', 'for probes with "from" only'),
                ('boundary = "bottom"\nabout = [0.0, 0.0, 1.0]', "has 3 entries"),
                ('at = [0.0, 0.0]\nevery = 0', "every"),
                ('', "at")):
            case = self.write("bad.toml", block_case() + f'[[probe]]\nname = "p"\n{probe}\n')
            process = self.expect_status(2, run("run", case, "-o", self.folder / "bad"))
            self.assertIn(message, process.stderr, probe)
            self.assertRegex(process.stderr, r"bad\.toml:\d+:\d+", probe)


    def test_columns_in_a_file_of_their_own(self):
        """history.csv does not have them, and no other probe is suggested."""
        case = self.write("sampled.toml", block_case() + '[[probe]]\nname = "f"\nat = [0.0, 0.0]\nevery = 3\n'
                          '[[expect]]\nquantity = "max(history.f.displacement_x)"\nmaximum = 1\n')
        errors = self.expect_status(2, run("run", case, "-o", self.folder / "sampled")).stderr
        self.assertRegex(errors, r'sampled\.toml:\d+:\d+: history\.csv has no column "f\.displacement_x": probe "f" has '
                                 r'"every", so its columns are in probes-3\.csv; remove "every"')
        self.assertNotIn("did you mean", errors)
