"""Cases of several mesh files, [part.NAME], and bodies that move at the start, [[motion]]."""

import json
import os

import meshio
import numpy

from harness import MESHES, History, TestCase, run, summary_of

WIDTH, HEIGHT = 3.0, 2.0
CORNERS = (0.0, 1.4, WIDTH), (0.0, 0.9, HEIGHT)


def rectangle():
    """Returns nodes and quadrilaterals of [0, 3] x [0, 2], and the facets below and above, for simple arithmetic."""
    nodes = [(x, y) for y in CORNERS[1] for x in CORNERS[0]]
    cells = [(first, first + 1, first + 4, first + 3) for first in (0, 1, 3, 4)]
    return nodes, cells, {"low": [(0, 1), (1, 2)], "high": [(6, 7), (7, 8)]}


def mesh_text(bodies):
    """Returns a .msh file of rectangles; `bodies` is a list of (prefix of their groups, map of their nodes)."""
    names, nodes, elements = [], [], []
    for prefix, place in bodies:
        own_nodes, cells, facets = rectangle()
        first = len(nodes) + 1
        nodes += [place(*node) for node in own_nodes]
        groups = [(1, name, 1, edges) for name, edges in facets.items()] + [(2, "body", 3, cells)]
        for dimension, name, kind, members in groups:
            names.append(f'{dimension} {len(names) + 1} "{prefix}{name}"')
            for member in members:
                elements.append(f"{len(elements) + 1} {kind} 2 {len(names)} 1 " + " ".join(str(first + k) for k in member))
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames"]
    lines += ["$Nodes", str(len(nodes)), *(f"{i} {x!r} {y!r} 0" for i, (x, y) in enumerate(nodes, start=1)), "$EndNodes"]
    return "\n".join([*lines, "$Elements", str(len(elements)), *elements, "$EndElements", ""])


def beside(x, y):
    """Returns the position of the second body: scaled by 2, rotated by 90 degrees counter-clockwise, moved."""
    return -2.0 * y + 12.0, 2.0 * x + 0.5


BESIDE = "scale = 2.0\nturn = { angle = 90.0 }\nmove = [12.0, 0.5]\n"
REST = """
[[material]]
group = "one.body"
density = 1.0
lambda = 100.0
mu = 50.0
[[material]]
group = "two.body"
density = 3.0
lambda = 200.0
mu = 50.0
[obstacle.floor]
type = "plane"
point = [0.0, -0.05]
normal = [0.0, 1.0]
[[contact]]
group = ["one.low", "two.high"]
obstacle = "floor"
friction = 0.2
[load]
gravity = [0.0, -10.0]
[initial]
velocity = [0.0, -0.25]
[[probe]]
name = "one"
group = "one.body"
[mass]
type = "consistent"
[time]
scheme = "contact-stabilized"
step = 0.01
end = 0.3
[output]
checkpoint_every = 5
"""
MOTIONS = {"one": "velocity = [0.5, -1.0]\nspin = 0.25\n", "two": "spin = -0.125\n"}


class Parts(TestCase):
    def setUp(self):
        super().setUp()
        self.write("rectangle.msh", mesh_text([("", lambda x, y: (x, y))]))

    def parts_case(self, order=("one", "two"), motions=True, rest=REST):
        """Returns the two bodies, in one file each."""
        text = ""
        for name in order:
            place = BESIDE if name == "two" else ""
            text += f'[part.{name}]\nfile = "rectangle.msh"\n{place}{MOTIONS[name] if motions else ""}'
        return text + rest

    def history_of(self, name, text):
        return History(self.simulate(self.write(f"{name}.toml", text), name) / "history.csv")

    def expect_same(self, history, reference, tolerance=0.0, labels=("one", "two")):
        """`labels`: the columns' names of the bodies "one" and "two" of the reference."""
        names = {name: name for name in reference.names}
        for label, own in zip(("one", "two"), labels):
            names |= {name: name.replace(label, own) for name in names if name.startswith(f"momentum.{label}_")}
        self.assertEqual(sorted(history.names), sorted(names.values()))
        self.assertEqual(len(history.rows), len(reference.rows))
        largest = max(abs(value) for row in reference.rows for value in row)
        for name, own in names.items():
            for one, two in zip(history[own], reference[name]):
                self.assertLessEqual(abs(one - two), tolerance * largest, name)

    def message(self, text, *arguments, status=2):
        return self.expect_status(status, run("validate", self.write("refused.toml", text), *arguments)).stderr

    # --- results

    def test_parts_are_the_bodies_of_one_file(self):
        self.write("both.msh", mesh_text([("one.", lambda x, y: (x, y)), ("two.", beside)]))
        motions = "".join(f'[[motion]]\ngroup = "{name}.body"\n{motion}' for name, motion in MOTIONS.items())
        one_file = self.history_of("one_file", '[mesh]\nfile = "both.msh"\n' + motions + REST)
        parts = self.history_of("parts", self.parts_case())
        self.expect_same(one_file, parts, 1e-12, labels=("0", "1"))  # "one.body" is no plain name
        # Both touch the floor, and the motions make a difference.
        self.assertGreater(max(map(abs, parts["contact_force_x"])), 1.0)
        still = self.history_of("still", self.parts_case(motions=False))
        self.assertGreater(max(abs(a - b) for a, b in zip(still["one.displacement_average_x"],
                                                          parts["one.displacement_average_x"])), 1e-3)

    def test_start_with_the_momenta_of_rigid_bodies(self):
        rest = REST.replace("velocity = [0.0, -0.25]", "velocity = [0.0, 0.0]").replace("end = 0.3", "end = 0.01")
        history = self.history_of("momenta", self.parts_case(rest=rest))
        area, inertia = WIDTH * HEIGHT, WIDTH * HEIGHT * (WIDTH ** 2 + HEIGHT ** 2) / 12.0
        self.assertAlmostEqual(history["momentum_x"][0], 0.5 * area, delta=1e-12 * area)
        self.assertAlmostEqual(history["momentum_y"][0], -1.0 * area, delta=1e-12 * area)
        # About the origin: that of the first body's centre, and both spins; the second is scaled by 2 and has density
        # 3.
        orbit = area * (WIDTH / 2 * -1.0 - HEIGHT / 2 * 0.5)
        wanted = orbit + 0.25 * inertia - 0.125 * 3.0 * 2.0 ** 4 * inertia
        self.assertAlmostEqual(history["angular_momentum_z"][0], wanted, delta=1e-12 * 48.0 * inertia)

    def test_names_change_nothing_and_the_order_only_rounding(self):
        reference = self.history_of("reference", self.parts_case())
        renamed = self.parts_case().replace("part.one", "part.z").replace("part.two", "part.a")
        renamed = renamed.replace('"one.', '"z.').replace('"two.', '"a.')
        self.expect_same(self.history_of("renamed", renamed), reference, labels=("z", "a"))
        self.expect_same(self.history_of("reordered", self.parts_case(("two", "one"))), reference, 1e-11)

    def test_only_the_part_that_is_placed_moves(self):
        output = self.simulate(self.write("placed.toml", self.parts_case()), "placed")
        with meshio.xdmf.TimeSeriesReader(output / "results.xdmf") as results:
            points, cells = results.read_points_cells()
        nodes = numpy.array(rectangle()[0])
        placed = numpy.array([beside(*node) for node in nodes])
        found = {tuple(point) for point in numpy.round(points[:, :2], 12)}
        self.assertEqual(found, {tuple(point) for point in numpy.round(numpy.vstack([nodes, placed]), 12)})
        self.assertEqual(len(points), 18)
        self.assertEqual(sum(len(block.data) for block in cells), 8)

    def test_parts_at_one_place_are_not_joined(self):
        text = self.parts_case(motions=False).replace(BESIDE, "")
        summary = json.loads((self.simulate(self.write("case.toml", text)) / "summary.json").read_text())
        self.assertEqual(summary["nodes"], 18)

    # --- other features that use parts

    def test_bodies_are_called_by_their_parts(self):
        text = self.expect_status(0, run("info", self.write("case.toml", self.parts_case()))).stdout
        self.assertIn('part "two": ' + str(self.folder / "rectangle.msh") + ", scaled by 2, rotated by 90°, moved", text)
        self.assertIn('body "one": mass 6 per unit of thickness', text)
        self.assertIn('body "two": mass 72 per unit of thickness', text)
        self.assertIn('group "two.all": 4 cells', text)
        self.assertIn('group "one.boundary": 8 facets', text)

    def test_summary_names_the_files(self):
        output = self.simulate(self.write("case.toml", self.parts_case()))
        parameters = summary_of(output)["parameters"]
        self.assertEqual(parameters["part.one.file"], "rectangle.msh")
        self.assertEqual(parameters["part.two.scale"], "2")
        self.assertEqual(parameters["part.one.velocity"], "[0.5, -1]")

    def test_settings_and_studies_reach_into_parts(self):
        case = self.write("case.toml", self.parts_case())
        output = self.simulate(case, "faster", {"part.one.velocity": "[1.0, -1.0]", "part.two.spin": 0})
        self.assertAlmostEqual(History(output / "history.csv")["momentum_x"][0], 6.0, delta=1e-10)
        self.expect_status(0, run("study", case, "-o", self.folder / "study", "--vary", "part.two.scale=2,4", "--quantity",
                                  "history.momentum_y[0]"))
        table = (self.folder / "study" / "study.csv").read_text()
        self.assertIn("part.two.scale", table.splitlines()[0])
        self.assertEqual(len(table.splitlines()), 3, table)

    def test_geometry_of_a_part_is_meshed_when_asked_for(self):
        rest = REST.replace('"two.body"', '"two.all"').replace(', "two.high"', "")
        text = self.parts_case(rest=rest, motions=False).replace(
            f'file = "rectangle.msh"\n{BESIDE}', f'file = "{MESHES / "disc.geo"}"\nmove = [20.0, 1.0]\n')
        case = self.write("case.toml", text)
        environment = os.environ | {"RICOCHET_CACHE": str(self.folder / "cache")}
        process = self.expect_status(0, run("validate", case, environment=environment))
        self.assertIn(f"valid, as far as can be checked without a mesh of {MESHES / 'disc.geo'}\n", process.stdout)
        self.assertIn(f"known only after {MESHES / 'disc.geo'} has been meshed",
                      self.expect_status(0, run("info", case, environment=environment)).stdout)
        self.expect_status(0, run("validate", case, "--mesh", environment=environment))
        self.assertIn('body "two"', self.expect_status(0, run("info", case, environment=environment)).stdout)

    # --- refusals

    def test_refusals_say_where_and_what_to_do(self):
        case = self.parts_case()
        self.assertIn('refused.toml:2:8: "file" of [mesh] and [part.NAME] exclude each other',
                      self.message('[mesh]\nfile = "rectangle.msh"\n' + case))
        self.assertIn("no [part.NAME] either", self.message(REST))
        solid = MESHES / "tetrahedron_o1_msh41_ascii.msh"
        self.assertIn('--set part.two.file=' + str(solid) + ': part "two" is a mesh of dimension 3, part "one" of dimension 2',
                      self.message(case, "--set", f"part.two.file={solid}"))
        self.assertIn('part "two" is a mesh of degree 2, part "one" of degree 1',
                      self.message(case, "--set", f"part.two.file={MESHES / 'triangle_o2_msh41_ascii.msh'}"))
        missing = self.message(case.replace('"rectangle.msh"', '"none.msh"'), status=4)
        self.assertIn("refused.toml:2:8: there is no file", missing)
        self.assertIn("refused.toml:6:8: there is no file", missing)
        self.write("broken.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
        self.assertIn('--set part.two.file=broken.msh: part "two": ' + str(self.folder / "broken.msh"),
                      self.message(case, "--set", "part.two.file=broken.msh"))
        self.assertIn("can only contain letters, digits, _ and -", self.message(case.replace("[part.one]", '[part."o.ne"]')))
        self.assertIn('there is no group "body" of cells', self.message(case.replace('"one.body"', '"body"')))
        self.assertIn('did you mean "one.body" or "two.body"?', self.message(case.replace('"one.body"', '"body"')))
        shared = self.message(case + '[[motion]]\ngroup = "one.body"\nspin = 1.0\n')
        self.assertIn('group "one.body" shares cells with part "one", which has a motion at', shared)

    def interrupted(self, text):
        """Makes a run look as if it had been interrupted."""
        case = self.write("case.toml", text)
        output = self.simulate(case)
        summary = output / "summary.json"
        summary.write_text(summary.read_text().replace('"status": "done"', '"status": "running"'))
        return case, output

    def test_resume_refuses_a_part_that_was_edited(self):
        mesh = mesh_text([("", lambda x, y: (x, y))])
        self.write("two.msh", mesh)
        two = '[part.two]\nfile = "two.msh"'
        case, output = self.interrupted(self.parts_case().replace('[part.two]\nfile = "rectangle.msh"', two))
        self.assertIn(" 1.4 0.9 ", mesh)
        self.write("two.msh", mesh.replace(" 1.4 0.9 ", " 1.5 0.9 "))
        process = self.expect_status(2, run("run", case, "-o", output, "--resume"))
        self.assertIn('case.toml:6:8: the run cannot be resumed: the mesh has changed since it began (differences in: '
                      'nodes of part "two")', process.stderr)
        # A group that was renamed, in the file of the first part.
        self.write("two.msh", mesh)
        self.write("rectangle.msh", mesh.replace('"high"', '"top"'))
        process = self.expect_status(2, run("run", case, "-o", output, "--resume"))
        self.assertIn('case.toml:2:8: the run cannot be resumed', process.stderr)
        self.assertIn('(differences in: groups of part "one")', process.stderr)
        # The contents decide, not the name of the file.
        self.write("other.msh", mesh)
        self.expect_status(0, run("run", case, "-o", output, "--resume", "--set", "part.one.file=other.msh"))

    def test_resume_refuses_other_parts(self):
        case, output = self.interrupted(self.parts_case())
        self.write("case.toml", self.parts_case(("two", "one")))
        process = self.expect_status(2, run("run", case, "-o", output, "--resume"))
        self.assertIn("(differences in: the order of the parts)", process.stderr)
        self.write("case.toml", self.parts_case())
        process = self.expect_status(2, run("run", case, "-o", output, "--resume", "--set", "part.one.spin=0.5"))
        self.assertIn("part.one.spin was 0.25, now it is 0.5", process.stderr)
        self.expect_status(0, run("run", case, "-o", output, "--resume"))
