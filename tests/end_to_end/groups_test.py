"""Built-in groups, lists of groups, positions of bodies, and reversed cells."""

import meshio
import numpy

from harness import MESHES, History, TestCase, block_case, run, summary_of

MIXED = MESHES / "mixed_o1_msh41_ascii.msh"


class Groups(TestCase):
    def history_of(self, name, text, values=None):
        return History(self.simulate(self.write(f"{name}.toml", text), name, values) / "history.csv")

    def expect_same(self, history, reference, tolerance=0.0):
        self.assertEqual(history.names, reference.names)
        largest = max(abs(value) for row in reference.rows for value in row)
        for row, other in zip(history.rows, reference.rows):
            for name, one, two in zip(history.names, row, other):
                self.assertLessEqual(abs(one - two), tolerance * largest, name)

    # --- built-in groups and lists

    def test_all_is_every_cell_and_lists_are_unions(self):
        reference = self.history_of("reference", block_case())
        self.expect_same(self.history_of("all", block_case().replace('"body"', '"all"')), reference)
        self.expect_same(self.history_of("list", block_case().replace('"bottom"', '["bottom"]')), reference)
        # Here the file itself has a group "all", and a part of it: the union has each cell once.
        whole = block_case(MIXED.name).replace('"body"', '"all"')
        union = block_case(MIXED.name).replace('"body"', '["left half", "all"]')
        self.expect_same(self.history_of("union", union), self.history_of("whole", whole))

    def test_boundary_is_every_facet(self):
        # The parallelogram's sides and bottom lack the top, so that the force on the closed boundary is 0 in any
        # direction.
        probes = """
[[probe]]
name = "skin"
boundary = "boundary"
[[probe]]
name = "cells"
group = "all"
[[probe]]
name = "body"
group = "body"
[[probe]]
name = "facets"
group = ["bottom", "sides"]
[[traction]]
group = "boundary"
value = ["7.0", "-3.0"]
"""
        output = self.simulate(self.write("case.toml", block_case() + probes), "out", {"time.end": 0.05})
        history = History(output / "history.csv")
        self.assertEqual(history["cells.displacement_average_y"], history["body.displacement_average_y"])
        self.assertIn("facets.displacement_average_y", history.names)
        # Supports and obstacles act on the boundary only.
        for force, contact in zip(history["skin.force_y"], history["contact_force_y"]):
            self.assertAlmostEqual(force, contact, delta=1e-9 * max(map(abs, history["contact_force_y"])) + 1e-12)
        # Momentum: the traction on the closed outline of length L over a time, and the weight.
        corners = numpy.array([[0.1, 0.2], [1.3, 0.1], [1.5, 1.2], [0.3, 1.3]])
        sides = numpy.roll(corners, -1, axis=0) - corners
        length = numpy.hypot(sides[:, 0], sides[:, 1]).sum()
        self.assertAlmostEqual(history["momentum_x"][-1], 7.0 * length * 0.05, delta=1e-9)
        parameters = summary_of(output)["parameters"]
        self.assertEqual(parameters["probe.4.group"], "[bottom, sides]")

    def test_lists_on_the_command_line_and_in_conditions(self):
        expectation = """
[[expect]]
quantity = "summary.dofs"
value = {value}
absolute = 0.0
when = {{ "contact.0.group" = ["bottom", "sides"] }}
"""
        good = self.write("good.toml", block_case() + expectation.format(value=24))
        wrong = self.write("wrong.toml", block_case() + expectation.format(value=25))
        change = ["--set", 'contact.0.group=["bottom", "sides"]']
        self.expect_status(0, run("run", good, "-o", self.folder / "a", *change))
        self.expect_status(5, run("run", wrong, "-o", self.folder / "b", *change))
        self.expect_status(0, run("run", wrong, "-o", self.folder / "c"))  # the condition does not hold

    def test_a_group_of_the_file_keeps_its_meaning(self):
        text = (MESHES / "quadrilateral_o1_msh41_ascii.msh").read_text()
        self.write("named.msh", text.replace('"bottom"', '"boundary"').replace('"body"', '"all"'))
        case = block_case().replace(str(MESHES / "quadrilateral_o1_msh41_ascii.msh"), str(self.folder / "named.msh"))
        history = self.history_of("named", case.replace('"bottom"', '"boundary"').replace('"body"', '"all"'))
        self.expect_same(history, self.history_of("reference", block_case()))

    def test_wrong_groups_are_explained(self):
        def message(text, *arguments):
            return self.expect_status(2, run("validate", self.write("case.toml", text), *arguments)).stderr

        contact = message(block_case().replace('"bottom"', '"all"'))
        self.assertIn('"boundary" means all boundary facets', contact)
        self.assertIn('there is no group "botom"', message(block_case().replace('"bottom"', '["sides", "botom"]')))
        self.assertIn('repeats "sides"', message(block_case().replace('"bottom"', '["sides", "sides"]')))
        self.assertIn("must be the name of a group; found the integer 3",
                      message(block_case().replace('"bottom"', '["sides", 3]')))
        self.assertIn('"group" must be the name of a group, or a list of them; found an empty list',
                      message(block_case().replace('"bottom"', "[]")))
        overlap = message(block_case(MIXED.name).replace('"body"', '["left half"]')
                          + '[[material]]\ngroup = "all"\ndensity = 1.0\nlambda = 1.0\nmu = 1.0\n')
        self.assertIn("overlap: they share cells", overlap)

    def test_resume_knows_the_list(self):
        text = block_case().replace('"bottom"', '["bottom", "sides"]') + "[output]\ncheckpoint_every = 10\n"
        case = self.write("case.toml", text)
        self.simulate(case, "out")
        other = self.write("case.toml", text.replace('["bottom", "sides"]', '["sides", "bottom"]'))
        process = run("run", other, "-o", self.folder / "out", "--resume")
        self.assertNotEqual(process.returncode, 0)

    # --- placement

    def test_a_turned_problem_has_the_turned_solution(self):
        reference = self.history_of("reference", block_case())
        placement = "turn = { angle = 90.0, about = [1.0, 0.0] }\nmove = [2.0, 3.0]\n[[material]]"
        text = block_case().replace("[[material]]", placement)
        # (x, y) -> (1 - y, x - 1) + (2, 3)
        text = text.replace("point = [0.0, 0.0]\nnormal = [0.0, 1.0]", "point = [3.0, 2.0]\nnormal = [-1.0, 0.0]")
        text = text.replace("gravity = [0.0, -10.0]", "gravity = [10.0, 0.0]").replace("at = [1.3, 0.1]", "at = [2.9, 3.3]")
        turned = self.history_of("turned", text)
        for name, other, sign in (("total_energy", "total_energy", 1), ("contact_force_x", "contact_force_y", -1),
                                  ("momentum_y", "momentum_x", 1), ("foot.displacement_x", "foot.displacement_y", -1)):
            scale = max(map(abs, reference[other]))
            for one, two in zip(turned[name], reference[other]):
                self.assertAlmostEqual(one, sign * two, delta=1e-9 * scale + 1e-12, msg=name)
        self.assertGreater(max(map(abs, reference["contact_force_y"])), 1.0)

    def test_scale_comes_before_turn_and_move(self):
        text = block_case().replace("[[material]]", "scale = 2.0\nmove = [10.0, 0.0]\n[[material]]")
        text = text.replace("at = [1.3, 0.1]", "at = [12.6, 0.2]")
        output = self.simulate(self.write("case.toml", text), "out", {"time.end": 0.01})
        foot = summary_of(output)["probes"][0]
        numpy.testing.assert_allclose(foot["position"], [2 * 1.3 + 10.0, 2 * 0.1], rtol=1e-15)

    def test_placements_that_make_no_sense(self):
        def message(more, mesh="quadrilateral_o1_msh41_ascii.msh", text=None):
            text = (text or block_case(mesh)).replace("[[material]]", more + "\n[[material]]", 1)
            return self.expect_status(2, run("validate", self.write("case.toml", text))).stderr

        self.assertIn('has no "angle"', message("turn = { about = [0.0, 0.0] }"))
        self.assertIn("remove the axis", message("turn = { angle = 3.0, axis = [0.0, 1.0] }"))
        self.assertIn("all vectors must have as many", message("move = [0.0, 0.0, 1.0]"))
        solid = block_case("tetrahedron_o1_msh41_ascii.msh").replace("0.0, 0.0]", "0.0, 0.0, 0.0]").replace(
            "[0.0, 1.0]", "[0.0, 0.0, 1.0]").replace("[0.0, -10.0]", "[0.0, 0.0, -10.0]").replace(
            "[1.3, 0.1]", "[1.3, 0.1, 0.0]")
        self.assertIn("add an axis to \"turn\"", message("turn = { angle = 3.0 }", text=solid))
        self.assertIn("must not be zero", message("turn = { angle = 3.0, axis = [0.0, 0.0, 0.0] }", text=solid))

    # --- reversed cells

    def reversed_mesh(self, name, orders, stride):
        """Returns the 2.2 file with the nodes of every stride-th cell in another order."""
        lines, seen = (MESHES / name).read_text().split("\n"), 0
        for i in range(lines.index("$Elements") + 2, lines.index("$EndElements")):
            words = lines[i].split()
            order = orders.get(int(words[1]))
            if order is None:
                continue
            if seen % stride == 0:
                nodes = words[-len(order):]
                lines[i] = " ".join(words[:-len(order)] + [nodes[k] for k in order])
            seen += 1
        return self.write(f"reversed_{stride}_{name}", "\n".join(lines))

    def test_reversed_cells_give_the_same_results(self):
        # Gmsh's quadrilaterals with 4 and 9 nodes, mirrored by exchanging the first two vertices.
        orders = {3: [1, 0, 3, 2], 10: [1, 0, 3, 2, 4, 7, 6, 5, 8]}
        for name in ("quadrilateral_o1_msh22_ascii.msh", "quadrilateral_o2_msh22_ascii.msh"):
            reference = self.history_of(f"reference_{name}", block_case(name))
            for stride, note in ((1, "all 6 cells were reversed"), (2, "of 6 cells, 3 elements")):
                mesh = self.reversed_mesh(name, orders, stride)
                case = self.write(f"{stride}_{name}.toml", block_case(mesh))
                output = self.folder / f"{stride}_{name}"
                process = self.expect_status(0, run("run", case, "-o", output))
                self.assertEqual(process.stderr.count(note), 1, process.stderr)
                with meshio.xdmf.TimeSeriesReader(output / "results.xdmf") as results:
                    points, cells = results.read_points_cells()
                for block in cells:
                    corners = points[block.data[:, :4], :2]
                    x, y = corners[:, :, 0], corners[:, :, 1]
                    area = (x * numpy.roll(y, -1, axis=1) - y * numpy.roll(x, -1, axis=1)).sum(axis=1) / 2
                    self.assertGreater(area.min(), 0.0)
                # The same operators, summed in another order of nodes: rounding.
                self.expect_same(History(output / "history.csv"), reference, 1e-11)
