"""Cases that are well formed but inconsistent with their mesh: each ends with status 2 and a message that states the
error, its location (file:line:column), and the alternatives."""

import os
import re

from harness import MESHES, TWO_TRIANGLES, History, TestCase, block_case, run, summary_of

MIXED = block_case("mixed_o1_msh41_ascii.msh").replace('group = "body"', 'group = "all"')


def support(group, components, value, parameters=""):
    lines = ["[[support]]", f'group = "{group}"', f"components = {components}", f"value = {value}"]
    return "\n".join(lines + ([f"parameters = {{ {parameters} }}"] if parameters else [])) + "\n"


def obstacle(name, point, normal, more=""):
    return (f'[obstacle.{name}]\ntype = "plane"\npoint = {point}\nnormal = {normal}\n{more}'
            f'[[contact]]\ngroup = "bottom"\nobstacle = "{name}"\n')


# Cases; the piece of each whose location the message must name (its last occurrence); and parts of the message.
REFUSED = {
    "contact group that the mesh does not have": (
        block_case().replace('group = "bottom"', 'group = "botom"'), '"botom"', 'no group "botom"', 'did you mean "bottom"'),
    "material group that the mesh does not have": (
        block_case().replace('group = "body"', 'group = "steel"'), '"steel"', 'no group "steel"', '"body"'),
    "group of cells where facets are wanted": (block_case().replace('group = "bottom"', 'group = "body"'), '"body"', '"body"', "facets"),
    "group without elements": (MIXED.replace('group = "bottom"', 'group = "nothing"'), '"nothing"', '"nothing"', "is empty"),
    "support in a direction that does not exist": (block_case() + support("sides", '["x", "z"]', 0), '"z"]', 'no component "z" in two dimensions'),
    "vectors of different lengths": (block_case().replace("[0.0, -10.0]", "[0.0, 0.0, -10.0]"), "[0.0, 0.0, -10.0]", '"gravity"', "has 3 entries"),
    "contact inside the body": (MIXED.replace('group = "bottom"', 'group = "interface"'), '"interface"', '"interface" is not on the surface'),
    "traction inside the body": (
        MIXED + '[[traction]]\ngroup = "interface"\nvalue = [1.0, 0.0]\n', '"interface"', '"interface" is not on the surface'),
    "cells without material": (MIXED.replace('group = "all"', 'group = "left half"'), "[[material]]", "have no material", '"all"'),
    "obstacle that does not exist": (
        block_case().replace('obstacle = "floor"', 'obstacle = "flor"'), '"flor"', "there is no [obstacle.flor]", 'did you mean "floor"'),
    "two contacts of the same facets with the same obstacle": (
        MIXED + '[[contact]]\ngroup = "bottom left"\nobstacle = "floor"\n', '"bottom left"', '"bottom" and "bottom left" overlap'),
    "multipliers that differ at a shared node": (
        block_case() + '[[contact]]\ngroup = "sides"\nobstacle = "floor"\nmultipliers = "dual"\n', None, "share a node", "multipliers"),
    "line that turns about its normal": (
        block_case().replace("normal = [0.0, 1.0]", "normal = [0.0, 1.0]\nrotation_rate = 1.0"), "1.0\n[[contact", "three dimensions"),
    "one plane with two frictions": (
        block_case() + obstacle("again", [0.0, 0.0], [0.0, 2.0]) + "friction = 0.3\n", None, "case.toml:", '"again" and "floor"',
        "are the same surface", "different friction"),
    "supports that disagree": (
        MIXED + support("bottom", '["x"]', 0) + support("interface", '["x"]', '"t"'), '"interface"', 'support of group "interface"', '"0"'),
    "supports that disagree in a parameter": (
        MIXED + support("bottom", '["x"]', '"p*t"', "p = 1.0") + support("interface", '["x"]', '"p*t"', "p = 2.0"), '"interface"',
        'support of group "interface"'),
    "two probes of one name": (block_case() + '[[probe]]\nname = "foot"\nat = [0.0, 0.0]\n', '"foot"', '"foot"'),
    "probe with the name of a column": (block_case().replace('"foot"', '"total_energy"'), '"total_energy"', '"total_energy"'),
    "initial displacement that is not finite": (
        block_case() + '[initial]\ndisplacement = ["log(x-0.1)", "0"]\n', '["log(x-0.1)", "0"]', "no finite value at x = 0.1"),
}


class SemanticErrors(TestCase):
    def refuse(self, text, at, *fragments, command="validate", environment=None):
        """`at` is the piece of the case file whose location the message must name: its last occurrence."""
        case = self.write("case.toml", text)
        arguments = [command, case] + (["-o", self.folder / "out", "--quiet"] if command == "run" else [])
        process = self.expect_status(2, run(*arguments, environment=environment))
        for fragment in fragments:
            self.assertIn(fragment, process.stderr)
        if at:
            before = text[:text.rindex(at)]
            line, column = before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1
            self.assertIn(f"case.toml:{line}:{column}: ", process.stderr)
        errors = [line for line in process.stderr.splitlines() if not line.startswith("warning: ")]
        self.assertTrue(errors and errors[0].startswith("ricochet: "), process.stderr)
        self.assertEqual(process.stdout, "")
        if command == "validate":
            self.expect_status(2, run("run", case, "-o", self.folder / "out", environment=environment))

    def test_the_case_they_start_from_is_valid(self):
        for text in (block_case(), MIXED):
            self.expect_status(0, run("validate", self.write("case.toml", text)))

    def test_vectors_of_three_dimensions_on_a_plane_mesh(self):
        text = (block_case().replace("[0.0, 0.0]", "[0.0, 0.0, 0.0]").replace("[0.0, 1.0]", "[0.0, 0.0, 1.0]")
                .replace("[0.0, -10.0]", "[0.0, 0.0, -10.0]").replace("[1.3, 0.1]", "[1.3, 0.1, 0.0]"))
        self.refuse(text, "[0.0, 0.0, 0.0]", "has 3 entries", "dimension 2")

    def test_cells_with_two_materials(self):
        second = '[[material]]\ngroup = "left half"\ndensity = 2.0\nlambda = 1.0\nmu = 1.0\n'
        self.refuse(MIXED + second, '"left half"', '"all" and "left half" overlap')

    def test_friction_that_differs_at_a_shared_node(self):
        text = block_case().replace('obstacle = "floor"', 'obstacle = "floor"\nfriction = 0.3')
        self.refuse(text + '[[contact]]\ngroup = "sides"\nobstacle = "floor"\nfriction = 0.2\n', None, "share a node",
                    "friction")

    def test_refusals(self):
        for name, row in REFUSED.items():
            with self.subTest(name):
                self.refuse(*row)

    def test_multipliers_that_are_not_stable(self):
        text = block_case().replace('obstacle = "floor"', 'obstacle = "floor"\nmultipliers = "p0"')
        self.refuse(text, '"p0"', "p0", 'unstable_multipliers = "allow"')
        case = self.write("case.toml", text.replace('"p0"', '"p0"\nunstable_multipliers = "allow"'))
        process = self.expect_status(0, run("validate", case))
        self.assertIn("warning: ", process.stderr)
        self.assertIn("p0", process.stderr)

    def test_obstacles_that_leave_no_room(self):
        press = obstacle("press", [0.0, 0.3], [0.0, -1.0], "velocity = [0.0, -100.0]\n")
        self.refuse(block_case().split("[[probe]]")[0] + press, None, "step ", "no motion meets the conditions of contact", "reference position",
                    "contact.0 (normal (0, 1))", "contact.1 (normal (0, -1))", command="run")

    def test_equilibrium_that_does_not_exist(self):
        self.refuse(block_case().replace("[0.0, -10.0]", "[1.0, -10.0]") + '[initial]\ndisplacement = "static"\n', None,
                    "there is no equilibrium", "[[support]]", command="run")

    def test_load_that_is_not_finite_at_some_instant(self):
        self.refuse(block_case() + '[[traction]]\ngroup = "sides"\nvalue = ["1/(t-0.25)", "0"]\n', None,
                    '"1/(t-0.25)" has no finite value', "t = 0.25", command="run")
        self.assertIn('"failed"', (self.folder / "out" / "summary.json").read_text(encoding="utf-8"))

    def test_equivalent_mass_without_a_free_node(self):
        mesh = self.write("all_around.msh", TWO_TRIANGLES)
        text = block_case().replace(str(MESHES / "quadrilateral_o1_msh41_ascii.msh"), str(mesh))
        for mass in ("equivalent", "equivalent-nearest", "equivalent-lumped"):
            with self.subTest(mass):
                self.refuse(text.replace('"consistent"', f'"{mass}"'), f'"{mass}"', "contact")

    def test_geometry_without_the_gmsh_program(self):
        text = block_case("quadrilateral.geo").replace("[[material]]", "size = 0.5\n[[material]]", 1)
        # Our own cache of meshes must not help.
        environment = dict(os.environ, PATH=str(self.folder), RICOCHET_CACHE=str(self.folder))
        self.refuse(text, None, "gmsh", "quadrilateral.geo", command="run", environment=environment)

    def test_support_against_an_obstacle_is_a_warning(self):
        case = self.write("case.toml", block_case() + support("bottom", '["y"]', 0))
        process = self.expect_status(0, run("validate", case))
        self.assertIn("warning: 4 nodes of contact boundaries are held by supports", process.stderr)

    def test_locking_is_told_from_a_ratio_of_0_45_on(self):
        """For any modulus: the ratio is the user's number, without rounding."""
        def warns(young, ratio):
            text = re.sub(r"lambda = .*\nmu = .*", f"young = {young}\npoisson = {ratio}", block_case())
            process = self.expect_status(0, run("validate", self.write("case.toml", text)))
            return "elements of degree 1 lock" in process.stderr

        for young in ("5e6", "60e6", "61e6", "1e9", "210e9"):
            self.assertTrue(warns(young, 0.45), young)
        self.assertFalse(warns("60e6", 0.4499))

    def axisymmetric(self, more="", mesh_keys="", contact="bottom", drive="[load]\ngravity = [0.0, -1.0]\n"):
        """Returns a unit square beside its axis; `bottom` is all of its boundary, including the axis."""
        mesh = self.write("section.msh", TWO_TRIANGLES)
        return (f'[mesh]\nfile = "{mesh}"\ndegree = 2\nplane = "axisymmetric"\n{mesh_keys}'
                '[[material]]\ngroup = "body"\ndensity = 1.0\nlambda = 100.0\nmu = 50.0\n'
                '[obstacle.floor]\ntype = "plane"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n'
                f'[[contact]]\ngroup = "{contact}"\nobstacle = "floor"\n{drive}[mass]\ntype = "consistent"\n'
                f'[time]\nscheme = "newmark"\npreset = "trapezoidal"\nstep = 0.01\nend = 0.02\n{more}')

    def test_axis_of_an_axisymmetric_body(self):
        process = self.expect_status(0, run("validate", self.write("case.toml", self.axisymmetric())))
        self.assertIn("3 nodes are held there in the radial direction", process.stderr)
        self.assertIn('1 facet of group "bottom" lies on the axis', process.stderr)
        told = self.expect_status(0, run("info", self.folder / "case.toml")).stdout
        self.assertRegex(told, r'material "body": volume 3\.14159, mass 3\.14159,')
        self.assertRegex(told, r"the body: mass 3\.14159, centre \(0, 0\.5\), moment of inertia about it \(1\.047, 1\.571, 1\.047\)")
        self.assertIn("displacement of degree 2, axisymmetric", told)
        self.assertIn('group "bottom": 4 facets of dimension 1, area 12.566', told)
        held = self.axisymmetric(support("bottom", '["x"]', 0))
        self.expect_status(0, run("validate", self.write("case.toml", held)))

    def test_ring_on_a_pin(self):
        """It is pressed all round, and no force acts along its axis: rounding does not violate the balance of
        momentum."""
        text = self.axisymmetric(mesh_keys="move = [1.0, 0.0]\n", drive='[initial]\ndisplacement = "static"\n')
        text = text.replace("point = [0.0, 0.0]\nnormal = [0.0, 1.0]", "point = [1.001, 0.0]\nnormal = [1.0, 0.0]")
        results = self.simulate(self.write("case.toml", text))
        summary = summary_of(results)
        self.assertEqual(summary["warnings"], [])
        row = History(results / "history.csv")
        self.assertGreater(row["contact_force_x"][-1], 0.1)
        self.assertEqual(row["momentum_x"][-1], 0.0)

    def test_axisymmetric_bodies_that_make_no_sense(self):
        plane = 'plane = "axisymmetric"'
        self.refuse(self.axisymmetric(mesh_keys="move = [-0.25, 0.0]\n"), '"axisymmetric"', "node 1 is at (-0.25, 0)",
                    "wrong side of the axis")
        self.refuse(self.axisymmetric(drive="[load]\ngravity = [0.5, -1.0]\n"), "[0.5, -1.0]", "radial component 0.5")
        self.refuse(self.axisymmetric('[[motion]]\ngroup = "body"\nvelocity = [1.0, 0.0]\n'), "[1.0, 0.0]", "radial")
        self.refuse(self.axisymmetric('[[motion]]\ngroup = "body"\nspin = 2.0\n'), "2.0\n", "cannot rotate")
        self.refuse(self.axisymmetric().replace("normal = [0.0, 1.0]", "normal = [0.0, 1.0]\nvelocity = [0.1, 0.2]"),
                    "[obstacle.floor]", '"floor" has the radial component 0.1')
        free = self.axisymmetric().replace('type = "plane"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]',
                                           'type = "sphere"\ncentre = [0.0, -1.0]\nradius = 1.0\nmass = 1.0')
        self.refuse(free, "[obstacle.floor]", "not in axisymmetric cases: mesh the body as a part")
        # None of this needs a mesh.
        geometry = self.write("section.geo", "")
        for text, words in ((free, "not in axisymmetric cases"), (self.axisymmetric(drive="[load]\ngravity = [0.5, -1.0]\n"), "radial component 0.5"),
                            (free.replace("mass = 1.0", "velocity = [0.1, 0.2]"), '"floor" has the radial component 0.1')):
            case = self.write("case.toml", text.replace(str(self.folder / "section.msh"), str(geometry)))
            self.assertIn(words, self.expect_status(2, run("validate", case)).stderr)
        pulled = self.write("case.toml", self.axisymmetric(support("bottom", '["x"]', '"0.1*t"')))
        self.assertIn("a node on the axis of an axisymmetric body cannot leave the axis",
                      self.expect_status(2, run("validate", pulled)).stderr)
        solid = block_case("hexahedron_o1_msh41_ascii.msh").replace("[0.0, 0.0]", "[0.0, 0.0, 0.0]")
        solid = solid.replace("[0.0, 1.0]", "[0.0, 0.0, 1.0]").replace("[0.0, -10.0]", "[0.0, 0.0, -10.0]")
        solid = solid.replace("at = [1.3, 0.1]", "at = [1.3, 0.1, 0.0]").replace("[mesh]\n", f"[mesh]\n{plane}\n")
        self.refuse(solid, '"axisymmetric"', "dimension 3")

    def test_laws_of_finite_strain_that_make_no_sense(self):
        def with_law(text, law, more=""):
            return text.replace("density = ", f'law = "{law}"\n{more}density = ', 1)

        self.expect_status(0, run("validate", self.write("case.toml", with_law(block_case(), "neo-hookean"))))
        self.refuse(with_law(block_case(), "neo-hookean", "damping = { stiffness = 0.1 }\n"), "0.1 }",
                    "stiffness damping", "set it to 0")
        self.refuse(with_law(block_case(), "saint-venant-kirchhoff", 'dilatation = "mean"\n'), '"mean"',
                    "neo-hookean, mooney-rivlin")
        self.refuse(with_law(block_case(), "mooney-rivlin"), None, '"c10"')
        self.refuse(with_law(block_case(), "neo-hokean"), '"neo-hokean"', 'did you mean "neo-hookean"')
        newmark = 'scheme = "newmark"\npreset = "trapezoidal"\n'
        self.refuse(with_law(block_case(), "neo-hookean").replace(newmark, 'scheme = "bathe"\n'), '"bathe"',
                    "linear", "reduced-kane")
        # Compressed to negative length: only a run detects that.
        turned = with_law(block_case(), "neo-hookean") + '[initial]\ndisplacement = ["-1.5*x", "0"]\n'
        status = run("run", self.write("case.toml", turned), "-o", self.folder / "turned")
        self.assertEqual(status.returncode, 2)
        self.assertIn("is inverted", status.stderr)
        # One of two materials is linear.
        halves = with_law(MIXED, "neo-hookean").replace('group = "all"', 'group = "left half"', 1)
        status = run("validate", self.write("case.toml", halves + '[[material]]\ngroup = "all"\ndensity = 1.0\n'
                                            "lambda = 1.0\nmu = 1.0\n"))
        self.assertEqual(status.returncode, 2)

    def test_relaxation_that_makes_no_sense(self):
        def relaxing(modulus, time, law="neo-hookean", more=""):
            return block_case().replace("density = ", f'law = "{law}"\n{more}relaxation = {{ modulus = {modulus}, '
                                        f"time = {time} }}\ndensity = ", 1)

        newmark = 'scheme = "newmark"\npreset = "trapezoidal"\n'
        fits = relaxing("[0.3, 0.2]", "[0.1, 1]").replace(newmark, "")
        fits = fits.replace('type = "consistent"', 'type = "equivalent"')
        self.expect_status(0, run("validate", self.write("case.toml", fits)))
        self.refuse(relaxing("[0.3, 0.2]", "[0.1, 1]"), '"newmark"', "does not support viscoelastic branches", "reduced-kane")
        self.refuse(relaxing("[0.3]", "[0.1]", "linear"), "{ modulus", "saint-venant-kirchhoff")
        self.refuse(relaxing("[0.3, -0.2]", "[0.1, 1]"), "-0.2]", 'entry 2 of "modulus"', "a positive number")
        self.refuse(relaxing("[0.3, 0.2]", "[0.1, 0]"), "0] }", 'entry 2 of "time"', "a positive number")
        self.refuse(relaxing("[0.3, 0.2]", "[0.1]"), "[0.1]", "2 and 1")
        self.refuse(relaxing("0.3", "[0.1]"), "0.3,", '"modulus"', "a list")
        self.refuse(relaxing("[]", "[0.1]"), "[], time", '"modulus"', "a list")
        self.refuse(block_case().replace("density = ", 'law = "neo-hookean"\nrelaxation = { modulus = [0.3] }\n'
                                         "density = ", 1), None, 'has no "time"')
        plane_stress = fits.replace("[mesh]\n", '[mesh]\nplane = "stress"\n')
        self.refuse(plane_stress, "{ modulus", "plane strain")

    def test_supports_with_parameters_of_their_own(self):
        """Two supports with the same text are not the same support."""
        text = MIXED.replace("end = 0.3", "end = 0.1") + support("bottom", '["x"]', '"p*t"', "p = 1.0")
        text = text.replace('name = "foot"\nat = [1.3, 0.1]', 'name = "foot"\nat = [0.0, 0.0]')
        text += support("bottom", '["y"]', '"p*t"', "p = 2.0")
        results = self.simulate(self.write("case.toml", text), options=("--log-level", "error"))
        *_, last = (results / "history.csv").read_text(encoding="ascii").splitlines()
        header = (results / "history.csv").read_text(encoding="ascii").splitlines()[0].split(",")
        values = dict(zip(header, map(float, last.split(","))))
        self.assertAlmostEqual(values["foot.displacement_x"], 0.1, delta=1e-15)
        self.assertAlmostEqual(values["foot.displacement_y"], 0.2, delta=1e-15)
