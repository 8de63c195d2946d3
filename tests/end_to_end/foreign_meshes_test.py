"""Meshes in the formats of other programs: the same volume, groups and history as their twins in Gmsh's format.

The twins are those of tests/data/meshes. Abaqus' files are written here by hand, with the numbering of nodes and faces of
Abaqus' manual (Elements > Continuum elements); the others by meshio, h5py and netCDF4.
"""

import os

import meshio
import numpy

from harness import MESHES, History, TestCase, body_case, initial_velocity, run

# Faces S1, S2, … by the numbers of an element's nodes.
FACES = {
    "triangle": [(1, 2), (2, 3), (3, 1)],
    "quad": [(1, 2), (2, 3), (3, 4), (4, 1)],
    "tetra": [(1, 2, 3), (1, 4, 2), (2, 4, 3), (3, 4, 1)],
    "hexahedron": [(1, 2, 3, 4), (5, 8, 7, 6), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 8, 4), (4, 8, 5, 1)],
}
# Sides 1, 2, … in Exodus' manual (Exodus II: A Finite Element Data Model, table of side set node ordering).
EXODUS_SIDES = {
    "tetra": [(1, 2, 4), (2, 3, 4), (1, 4, 3), (1, 3, 2)],
    "hexahedron": [(1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (1, 5, 8, 4), (1, 4, 3, 2), (5, 6, 7, 8)],
}
NAMES = {"triangle": "CPS3", "triangle6": "CPE6M", "quad": "CPE4R", "tetra": "C3D4", "tetra10": "C3D10M",
         "hexahedron": "C3D8R"}
TWINS = {"triangle_o1": ("CPS3", "sides"), "triangle_o2": ("CPE6M", "sides"), "quadrilateral_o1": ("CPE4R", "sides"),
         "tetrahedron_o1": ("C3D4", "top"), "tetrahedron_o2": ("C3D10M", "top"), "hexahedron_o1": ("C3D8R", "top")}


class Twin:
    """A mesh of tests/data, with its original groups."""

    def __init__(self, name):
        self.path = MESHES / f"{name}_msh22_ascii.msh"
        mesh = meshio.read(self.path)
        self.points = mesh.points
        self.dimension = 3 if any(block.type[:5] in ("tetra", "hexah") for block in mesh.cells) else 2
        self.groups = {}
        names = {(int(tag), int(dimension)): name for name, (tag, dimension) in mesh.field_data.items()}
        facets = ("line", "line3") if self.dimension == 2 else ("triangle", "triangle6", "quad")
        for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
            if block.type in facets:
                for tag in set(tags.tolist()):
                    name = names.get((tag, self.dimension - 1), str(tag))
                    self.groups.setdefault(name, []).extend(block.data[tags == tag].tolist())
            elif block.type in NAMES:
                self.kind, self.cells = block.type, block.data
        self.facet_kind = {2: "line", 3: "triangle", 4: "quad"}[len(FACES[self.base][0])]
        if self.kind[-1].isdigit():
            self.facet_kind = {"line": "line3", "triangle": "triangle6"}[self.facet_kind]

    @property
    def base(self):
        return self.kind.rstrip("0123456789")

    def sides(self, group, faces=None):
        """Returns (cell, face) of each facet of a group, counted from 0."""
        faces = (faces or FACES)[self.base]
        wanted = {frozenset(facet[:len(faces[0])]) for facet in self.groups[group]}
        return [(cell, face) for cell, nodes in enumerate(self.cells)
                for face, numbers in enumerate(faces)
                if frozenset(int(nodes[k - 1]) for k in numbers) in wanted]


def rows(numbers, per_line=8):
    numbers = list(numbers)
    return "".join(", ".join(map(str, numbers[i:i + per_line])) + ",\n" for i in range(0, len(numbers), per_line))


def node_lines(twin, offset=0):
    return "".join(f"  {i + 1 + offset}, {x!r}, {y!r}, {z!r}\n" for i, (x, y, z) in enumerate(twin.points.tolist()))


def element_lines(twin, offset=0):
    # Long elements continue in the next line, as Abaqus writes them.
    text = ""
    for i, nodes in enumerate(twin.cells.tolist()):
        numbers = [i + 1 + offset] + [node + 1 + offset for node in nodes]
        text += ", ".join(map(str, numbers[:8])) + (",\n    " + ", ".join(map(str, numbers[8:])) if numbers[8:] else "")
        text += "\n"
    return text


def surface_lines(twin, group, offset=0, prefix=""):
    """Returns a surface by sets of elements, one for each of its faces."""
    text, data = "", ""
    for face in range(len(FACES[twin.base])):
        cells = [cell + 1 + offset for cell, number in twin.sides(group) if number == face]
        if cells:
            text += f"*Elset, elset=_{group}_S{face + 1}, internal\n{rows(cells)}"
            data += f"{prefix}_{group}_S{face + 1}, S{face + 1}\n"
    return text + f"*Surface, type=ELEMENT, name={group}\n{data}"


def nodes_of(twin, group):
    return sorted({node for facet in twin.groups[group] for node in facet})


def abaqus_text(twin, top):
    """Returns text as Abaqus/CAE writes a job: a part, an instance, a step."""
    offset = 1000
    return f"""*Heading
** Job name: block, a comment
*Preprint, echo=NO
*Part, name=Block
*Node
{node_lines(twin, offset)}*Element, type={NAMES[twin.kind]}
{element_lines(twin, offset)}*Elset, elset=Body, generate
 {offset + 1}, {offset + len(twin.cells)}, 1
*Solid Section, elset=Body, material=Rubber
,
*End Part
*Assembly, name=Assembly
*Instance, name=Block-1, part=Block
*End Instance
*Nset, nset={top}, instance=Block-1
{rows((node + 1 + offset for node in nodes_of(twin, top)), 16)}{surface_lines(twin, "bottom", offset)}*End Assembly
*Material, name=Rubber
*Elastic
 130., 0.33
*Step, name=Step-1
*Dynamic
*End Step
"""


class ForeignMeshes(TestCase):
    def setUp(self):
        super().setUp()
        os.environ["RICOCHET_CACHE"] = str(self.folder / "cache")

    def case(self, name, file, dimension, top, body="body", bottom="bottom"):
        # The bodies' lowest points are 0.1 high in the plane; in space 0 for the prism and 0.05 for the hexahedra.
        floor = 0.09 if dimension == 2 else 0.04 if "hexahedron" in str(file) else -0.01
        up = [0.0] * (dimension - 1) + [1.0]
        drive = (f'[[support]]\ngroup = "{top}"\ncomponents = ["x"]\n'
                 + initial_velocity(0.1, *(-component for component in up[1:])))
        return self.write(f"{name}.toml", body_case(file, [floor * component for component in up], up, drive, body=body,
                                                    bottom=bottom, step=0.002, end=0.02))

    def history_of(self, name, *arguments, **more):
        return History(self.simulate(self.case(name, *arguments, **more), f"out-{name}") / "history.csv")

    def expect_same(self, history, reference):
        self.assertEqual(history.names, reference.names)
        self.assertGreater(max(map(abs, reference["contact_force_y" if "contact_force_z" not in reference.names else
                                                  "contact_force_z"])), 0.0)
        scale = {name: max(map(abs, reference[name])) for name in reference.names}
        energy, force = reference.largest_energy(), max(value for key, value in scale.items() if "force" in key)
        for name in reference.names:
            size = max(scale[name], energy if "energy" in name or "work" in name else 0.0, force if "force" in name else 0.0)
            for one, other in zip(history[name], reference[name]):
                # The same numbers in another order of cells: rounding, over 10 steps.
                self.assertLessEqual(abs(one - other), 1e-9 * size + 1e-300, name)

    def refusal(self, file, *parts, status=2):
        process = self.expect_status(status, run("info", file))
        for part in parts:
            self.assertIn(part, process.stderr)
        return process.stderr

    # --- Abaqus

    def test_abaqus_jobs_run_as_their_twins(self):
        for name, (element, top) in TWINS.items():
            with self.subTest(name):
                twin = Twin(name)
                self.assertEqual(NAMES[twin.kind], element)
                reference = self.history_of(f"{name}-msh", twin.path, twin.dimension, top)
                file = self.write(f"{name}.inp", abaqus_text(twin, top))
                # Abaqus' names are case-insensitive; those of groups are spelt as in the file.
                self.expect_same(self.history_of(f"{name}-inp", file, twin.dimension, top, body="Body"), reference)

    def test_what_is_left_aside_is_said_also_when_the_mesh_is_kept(self):
        twin = Twin("tetrahedron_o1")
        text = abaqus_text(twin, "top") + "*Element, type=MASS, elset=point\n 9001, 1001\n"
        file = self.write("job.inp", text)
        for _ in range(2):
            errors = self.expect_status(0, run("info", file)).stderr
            self.assertIn("ignored: *DYNAMIC, *ELASTIC, *END STEP, *MATERIAL, *SOLID SECTION, *STEP", errors)
            self.assertIn("1 of type MASS", errors)
        self.assertEqual(len(list((self.folder / "cache").glob("job-*.msh"))), 1)

    def test_abaqus_rigid_surfaces_are_left_aside(self):
        twin = Twin("tetrahedron_o1")
        reference = self.history_of("msh", twin.path, 3, "top")
        rigid = ("*NODE, NSET=NREF\n9999, 0., 0., -5.\n*SURFACE, TYPE=CYLINDER, NAME=FLOOR\n0., 0., 0., 1., 0., 0.\n0., 0., 1.\n"
                 "START, 4., 0.\nLINE, -4., 0.\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=9999\n")
        file = self.write("job.inp", rigid + abaqus_text(twin, "top"))
        self.assertIn("*SURFACE of type CYLINDER, which an [obstacle.NAME]", self.expect_status(0, run("info", file)).stderr)
        self.expect_same(self.history_of("inp", file, 3, "top", body="Body"), reference)

    def test_calculix_files_with_an_include(self):
        twin = Twin("hexahedron_o1")
        reference = self.history_of("msh", twin.path, 3, "top")
        self.write("mesh.nam", f"*NODE, NSET=Nall\n{node_lines(twin)}")
        bottom = "".join(f"{cell + 1}, S{face + 1}\n" for cell, face in twin.sides("bottom"))
        top = nodes_of(twin, "top")
        text = (f"** CalculiX\n*INCLUDE, INPUT=mesh.nam\n*ELEMENT,TYPE=C3D8,\nELSET=body\n{element_lines(twin)}"
                f"*SURFACE, NAME=bottom\n{bottom}*NSET,NSET=half\n{rows(node + 1 for node in top[:3])}"
                f"*NSET,NSET=top\nhalf,\n{rows((node + 1 for node in top[3:]), 2)}")
        file = self.write("hexahedron.inp", text)
        self.expect_same(self.history_of("inp", file, 3, "top"), reference)
        # A changed included file is another mesh.
        shifted = twin.points[0] + [0.0, 0.0, 1e-3]
        changed = node_lines(twin).split("\n", 1)[1]
        self.write("mesh.nam", f"*NODE, NSET=Nall\n 1, {shifted[0]!r}, {shifted[1]!r}, {shifted[2]!r}\n{changed}")
        after = self.history_of("changed", file, 3, "top")
        self.assertNotEqual(after["total_energy"][0], reference["total_energy"][0])

    def test_surfaces_of_nodes_and_of_free_faces(self):
        twin = Twin("tetrahedron_o1")
        reference = self.history_of("msh", twin.path, 3, "top", bottom="boundary")
        nodes = "".join(f"{node + 1}, 1.0\n" for node in nodes_of(twin, "top"))
        file = self.write("job.inp", f"*NODE\n{node_lines(twin)}*ELEMENT, TYPE=C3D4, ELSET=body\n{element_lines(twin)}"
                                     f"*SURFACE, NAME=skin\nbody,\n*SURFACE, NAME=top, TYPE=NODE\n{nodes}")
        self.expect_same(self.history_of("inp", file, 3, "top", bottom="skin"), reference)

    def test_gmshs_own_export(self):
        # With elements of the surfaces, under the names that Gmsh gives them.
        twin = Twin("tetrahedron_o1")
        text = f"*Heading\n x.inp\n*NODE\n{node_lines(twin)}******* E L E M E N T S *************\n"
        number = 1
        for group in ("bottom", "top"):
            text += f"*ELEMENT, type=CPS3, ELSET=Surface{number}\n"
            for facet in twin.groups[group]:
                text += f"{number}, " + ", ".join(str(node + 1) for node in facet) + "\n"
                number += 1
        text += "*ELEMENT, type=C3D4, ELSET=body\n"
        for i, nodes in enumerate(twin.cells.tolist()):
            text += f"{number + i}, " + ", ".join(str(node + 1) for node in nodes) + "\n"
        count = len(twin.groups["bottom"])
        text += (f"*ELSET,ELSET=bottom\n{rows(range(1, count + 1))}*ELSET,ELSET=top\n{rows(range(count + 1, number))}")
        reference = self.history_of("msh", twin.path, 3, "top")
        self.expect_same(self.history_of("inp", self.write("gmsh.inp", text), 3, "top"), reference)

    def test_what_abaqus_has_and_ricochet_has_not(self):
        twin = Twin("tetrahedron_o1")
        nodes, elements = f"*NODE\n{node_lines(twin)}", f"*ELEMENT, TYPE=C3D4, ELSET=body\n{element_lines(twin)}"
        part = f"*PART, NAME=a\n{nodes}{elements}*END PART\n"
        refused = {
            "second part": (f"{part}*PART, NAME=b\n", ('a second part, "b"', "merge them into one part")),
            "placement": (f"{part}*ASSEMBLY\n*INSTANCE, NAME=i, PART=a\n 1.0, 0., 0.\n*END INSTANCE\n",
                          ("an instance that is moved or rotated", "`move` and `turn` in [mesh]")),
            "generation": (f"{nodes}*NGEN\n1, 5, 1\n{elements}", ("*NGEN is not supported", "Write Input")),
            "cylinder": (f"*NODE, SYSTEM=C\n1, 1., 90., 0.\n{elements}", ("Cartesian",)),
            "axisymmetry": (f"{nodes}*ELEMENT, TYPE=CAX4R\n1, 1, 2, 3, 4\n", ("CAX4R", "axisymmetric")),
            "serendipity": (f"{nodes}*ELEMENT, TYPE=C3D20R\n1, " + ", ".join(map(str, range(1, 16))) + ",\n"
                            + "1, 2, 3, 4, 5\n", ("1 of type C3D20R", "C3D10")),
            "plane serendipity": (f"{nodes}*ELEMENT, TYPE=CPS8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n", ("type CPS8", "CPS6")),
            "wedge": (f"{nodes}{elements}*ELEMENT, TYPE=C3D6\n99, 1, 2, 3, 4, 5, 6\n", ("type C3D6",)),
            "unknown set": (f"{nodes}{elements}*SURFACE, NAME=s\nnothing, S1\n", ('"nothing"',)),
            "no such face": (f"{nodes}{elements}*SURFACE, NAME=s\nbody, S5\n", ("S5 is not a face",)),
            "no such node": (f"{nodes}*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 7777\n", ("element 1 refers to node 7777",)),
            "set of strangers": (f"{nodes}{elements}*NSET, NSET=s\n7777\n", ("names node 7777",)),
            "bad number": (f"*NODE\n1, 0.0, zero, 0.0\n", ("bad_number.inp:2: the coordinates of a node",)),
            "not a number": ("*NODE\n1, 0.0, nan, 0.0\n", ("not_a_number.inp:2: the coordinates of a node",)),
            "digits parted": ("*NODE\n1_0, 0.0, 0.0, 0.0\n", ("digits_parted.inp:2: the number of a node",)),
            "no keyword": (f"NODE\n{nodes[6:]}", ("no_keyword.inp:1: data before any keyword: NODE",)),
            "twice": (f"{nodes}{elements}{elements}", ("element 1 is defined twice",)),
            "short element": (f"{nodes}*ELEMENT, TYPE=C3D4\n1, 1, 2, 3\n", ("has 4 nodes, this one has 3",)),
            "lost include": ("*INCLUDE, INPUT=gone.inp\n", ("gone.inp", "No such file")),
            "device": ("*INCLUDE, INPUT=/dev/zero\n", ("device.inp:1", "/dev/zero", "not a regular file")),
            "long number": (f"{nodes}12345678901234567890123, 0., 0., 0.\n{elements}",
                            (f"long_number.inp:{len(twin.points) + 2}: ", "more than 18 digits")),
            "long member": (f"{nodes}{elements}*NSET, NSET=s\n12345678901234567890123\n", ("more than 18 digits",)),
            "nothing": ("*HEADING\n", ("there is no *NODE",)),
        }
        for name, (text, parts) in refused.items():
            with self.subTest(name):
                file = self.write(name.replace(" ", "_") + ".inp", text)
                message = self.refusal(file, file.name, *parts)
                self.assertNotIn("Traceback", message)

    def test_generated_sets_may_go_beyond_the_mesh(self):
        twin = Twin("tetrahedron_o1")
        reference = self.history_of("msh", twin.path, 3, "top")
        file = self.write("job.inp", f"*NODE\n{node_lines(twin)}*ELEMENT, TYPE=C3D4\n{element_lines(twin)}"
                                     "*ELSET, ELSET=body, GENERATE\n1, 999999999999, 1\n"
                                     f"*NSET, NSET=top\n{rows(node + 1 for node in nodes_of(twin, 'top'))}"
                                     "*NSET, NSET=all, GENERATE\n1, 999999999999, 1\n"
                                     f"{surface_lines(twin, 'bottom')}")
        self.expect_same(self.history_of("inp", file, 3, "top"), reference)

    # --- formats read through meshio

    def arrays(self, twin, top):
        """Returns blocks of cells and, per block, the number of its group."""
        blocks = [(twin.kind, twin.cells)]
        numbers = [numpy.full(len(twin.cells), 5)]
        parts = [numpy.array(twin.groups[group]) for group in ("bottom", top)]
        blocks.append((twin.facet_kind, numpy.concatenate(parts)))
        numbers.append(numpy.repeat([7, 8], [len(part) for part in parts]))
        return blocks, numbers

    def test_arrays_of_integers_are_groups(self):
        for name, extensions in (("quadrilateral_o1", (".vtu", ".vtk", ".xdmf")), ("tetrahedron_o2", (".vtu", ".vtk"))):
            twin, top = Twin(name), TWINS[name][1]
            reference = self.history_of(f"{name}-msh", twin.path, twin.dimension, top)
            blocks, numbers = self.arrays(twin, top)
            many = [numpy.arange(len(array)) * 1000 for array in numbers]
            for extension in extensions:
                with self.subTest(name + extension):
                    file = self.folder / (name + extension)
                    meshio.Mesh(twin.points, blocks, cell_data={"part": numbers, "weight": [0.5 * many[0], 0.5 * many[1]]}
                                ).write(file)
                    self.expect_same(self.history_of(f"{name}{extension[1:]}", file, twin.dimension, "part 8",
                                                     body="part 5", bottom="part 7"), reference)

    def test_groups_of_med(self):
        for name in ("tetrahedron_o2", "quadrilateral_o1"):
            with self.subTest(name):
                twin, top = Twin(name), TWINS[name][1]
                reference = self.history_of(f"{name}-msh", twin.path, twin.dimension, top)
                blocks, numbers = self.arrays(twin, top)
                mesh = meshio.Mesh(twin.points, blocks, cell_data={"cell_tags": [-array for array in numbers]})
                mesh.cell_tags = {-5: ["body"], -7: ["bottom"], -8: [top, "another"]}
                mesh.point_tags = {}
                file = self.folder / f"{name}.med"
                mesh.write(file)
                self.expect_same(self.history_of(f"{name}-med", file, twin.dimension, top), reference)

    def test_blocks_sides_and_nodes_of_exodus(self):
        import netCDF4

        for name in ("tetrahedron_o1", "hexahedron_o1"):
            with self.subTest(name):
                twin = Twin(name)
                reference = self.history_of(f"{name}-msh", twin.path, 3, "top")
                file = self.folder / f"{name}.exo"
                meshio.Mesh(twin.points, [(twin.kind, twin.cells)],
                            point_sets={"top": numpy.array(nodes_of(twin, "top"))}).write(file)
                bottom = twin.sides("bottom", EXODUS_SIDES)
                with netCDF4.Dataset(file, "a") as out:
                    out.createDimension("num_side_sets", 1)
                    out.createDimension("num_side_ss1", len(bottom))
                    out.createVariable("ss_prop1", "i4", ("num_side_sets",))[:] = [40]
                    out.createVariable("elem_ss1", "i4", ("num_side_ss1",))[:] = [cell + 1 for cell, _ in bottom]
                    out.createVariable("side_ss1", "i4", ("num_side_ss1",))[:] = [face + 1 for _, face in bottom]
                self.expect_same(self.history_of(f"{name}-exo", file, 3, "top", body="all", bottom="side set 40"),
                                 reference)

    def test_files_that_meshio_cannot_read(self):
        self.refusal(self.write("broken.vtu", "<VTKFile"), "broken.vtu: meshio could not read this file")
        message = self.refusal(self.write("from_gmsh.bdf", "$ nothing\n"), "meshio could not read", "gmsh from_gmsh.bdf -save")
        self.assertNotIn("Traceback", message)
        file = self.folder / "skin.vtu"
        meshio.Mesh(numpy.eye(3), [("line", numpy.array([[0, 1], [1, 2]]))]).write(file)
        self.refusal(file, "no cells of dimension 2 or 3")
        file = self.folder / "prism.vtu"
        meshio.Mesh(numpy.random.default_rng(1).random((6, 3)), [("wedge", numpy.arange(6).reshape(1, 6))]).write(file)
        self.refusal(file, "1 of type wedge")
        self.refusal(self.folder / "absent.inp", "absent.inp", status=4)

    def test_missing_packages_are_named(self):
        file = self.folder / "block.med"
        twin = Twin("tetrahedron_o1")
        mesh = meshio.Mesh(twin.points, [(twin.kind, twin.cells)])
        mesh.write(file)
        # A module of that name that fails as a missing one does.
        for module, package in (("meshio", "python3-meshio"), ("h5py", "python3-h5py")):
            folder = self.folder / f"without-{module}"
            folder.mkdir()
            (folder / f"{module}.py").write_text(f"raise ModuleNotFoundError('none', name='{module}')\n")
            environment = dict(os.environ, PYTHONPATH=str(folder))
            process = self.expect_status(2, run("info", file, environment=environment))
            self.assertIn(f"apt-get install {package}", process.stderr)
