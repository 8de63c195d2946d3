"""results.xdmf and results.h5, read by meshio and h5py, agree with history.csv on every kind of cell."""

import os
import signal
import subprocess
import time
import xml.etree.ElementTree

import h5py
import meshio
import numpy

from harness import DISC, MESHES, PROGRAM, SOURCE, History, TestCase, block_case, method, run, summary_of
from results_frames import falling, frames
from vtk_cells import middles, volumes

# Four squares in a row, of two alternating materials, with descending numbers.
STRIP = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 3 "bottom"
2 1 "light"
2 2 "heavy"
$EndPhysicalNames
$Nodes
10
1 0 0 0
2 1 0 0
3 2 0 0
4 3 0 0
5 4 0 0
6 0 1 0
7 1 1 0
8 2 1 0
9 3 1 0
10 4 1 0
$EndNodes
$Elements
5
90 1 2 3 1 1 2
70 3 2 1 1 1 2 7 6
50 3 2 2 2 2 3 8 7
30 3 2 1 1 3 4 9 8
10 3 2 2 2 4 5 10 9
$EndElements
"""

# Bodies of tests/data/meshes: their volume from the corners in the .geo files, and two points to watch.
SHAPES = {
    "triangle": dict(volume=0.5 * ((1.5 - 0.1) * (0.9 - 0.1) - (-0.1 - 1.3) * (1.2 - 0.2)), lowest=[1.3, 0.1],
                     highest=[1.5, 1.2]),
    "quadrilateral": dict(volume=1.2 * 1.1 - (-0.1) * 0.2, lowest=[1.3, 0.1], highest=[0.3, 1.3]),
    "mixed": dict(volume=2.0, lowest=[1.5, 0.0], highest=[2.0, 1.0], group="all"),
    "tetrahedron": dict(volume=0.5 * numpy.linalg.det([[1.2, -0.1, -0.05], [0.1, 1.0, 0.05], [0.1, 0.2, 1.1]]),
                        lowest=[1.3, 0.1, 0.0], highest=[0.3, 1.4, 1.2]),
    "hexahedron": dict(volume=numpy.linalg.det([[1.2, 0.1, 0.05], [0.1, 1.1, 0.02], [0.05, 0.1, 0.9]]),
                       lowest=[0.1, 0.2, 0.05], highest=[1.45, 1.5, 1.02]),
    "disc": dict(volume=None, lowest=[0.0, -1.0], highest=[0.0, 1.0], bottom="boundary"),
}


class ResultsFiles(TestCase):
    def simulate_shape(self, shape, order, degree, scheme="klr-conserving"):
        about = SHAPES[shape]
        shape_of = {key: value for key, value in about.items() if key != "volume"}
        text = falling(MESHES / f"{shape}_o{order}_msh41_binary.msh", degree=degree, scheme=scheme, **shape_of)
        return self.simulate(self.write("case.toml", text), f"{shape}-{order}-{degree}")

    def check_probes(self, results, points, read):
        """Checks that every frame equals the row of the history at its time, bit for bit. Returns how many saw
        contact."""
        history = History(results / "history.csv")
        summary = summary_of(results)
        dimension = summary["dimension"]
        self.assertEqual(len(read), summary["frames"])
        in_contact = 0
        rows = {row[history.names.index("time")]: i for i, row in enumerate(history.rows)}
        for probe in summary["probes"]:
            node, name = probe["node"], probe["name"]
            self.assertEqual(list(points[node][:dimension]), probe["position"])
            for at, fields in read:
                row = rows[at]  # the same double, or there is no such key
                for field in ("displacement", "velocity"):
                    wanted = [history[f"{name}.{field}_{axis}"][row] for axis in "xyz"[:dimension]]
                    self.assertEqual(list(fields[field][node]), wanted + [0.0] * (3 - dimension))
                if probe["in_contact_boundary"]:
                    self.assertEqual(fields["contact_pressure"][node], history[f"{name}.pressure"][row])
                    self.assertEqual(fields["gap"][node], history[f"{name}.gap"][row])
                    touching = history[f"{name}.reaction_normal"][row] > 0.0
                    self.assertEqual(fields["contact_status"][node], 1 if touching else 0)
                    in_contact += touching
                else:
                    self.assertEqual(fields["contact_status"][node], -1)
                    self.assertTrue(numpy.isnan(fields["gap"][node]))
                    self.assertEqual(fields["contact_pressure"][node], 0.0)
        return in_contact

    def check_cells(self, points, cells, volume, straight):
        # gmsh places second-order nodes by their parameter on a curve: accurate to 1e-12 of the body, no better.
        tolerance = 1e-11 if any(middles(kind) for kind, _ in cells) else 1e-14
        total = 0.0
        for kind, nodes in cells:
            each, smallest = volumes(kind, points, nodes)
            self.assertGreater(smallest.min(), 0.0, f"a {kind} is turned inside out: its nodes are in another order")
            total += each.sum()
            if straight:
                for i, between in enumerate(middles(kind), start=nodes.shape[1] - len(middles(kind))):
                    numpy.testing.assert_allclose(points[nodes[:, i]], points[nodes[:, list(between)]].mean(axis=1),
                                                  rtol=0, atol=tolerance)
        self.assertAlmostEqual(total, volume, delta=10 * tolerance * volume)
        self.assertEqual(sorted(set(numpy.concatenate([nodes.ravel() for _, nodes in cells]))),
                         list(range(len(points))), "every node belongs to a cell")

    def check_shape(self, shape, order, degree, kinds):
        results = self.simulate_shape(shape, order, degree)
        points, cells, read = frames(results)
        self.assertEqual(sorted({kind for kind, _ in cells}), sorted(kinds))
        self.check_cells(points, cells, SHAPES[shape]["volume"], straight=True)
        self.assertGreater(self.check_probes(results, points, read), 0, "the lowest node never touched in a frame")

    def test_shapes(self):
        """Shape, order of the mesh, degree of the displacement, kinds of cells."""
        for shape, order, degree, kinds in (
                ("triangle", 1, 1, ["triangle"]), ("triangle", 2, 2, ["triangle6"]), ("triangle", 1, 2, ["triangle6"]),
                ("quadrilateral", 1, 1, ["quad"]), ("quadrilateral", 2, 2, ["quad9"]), ("mixed", 1, 1, ["triangle", "quad"]),
                ("tetrahedron", 1, 1, ["tetra"]), ("tetrahedron", 2, 2, ["tetra10"]),
                ("hexahedron", 1, 1, ["hexahedron"]), ("hexahedron", 2, 2, ["hexahedron27"])):
            with self.subTest(shape=shape, order=order, degree=degree):
                self.check_shape(shape, order, degree, kinds)

    def test_triangles_and_quadrilaterals_of_degree_2(self):
        """meshio 5.0 does not support second-order cells in mixed topologies: read by h5py, with the numbers from
        XDMF."""
        results = self.simulate_shape("mixed", 2, 2)
        kinds = {36: ("triangle6", 6), 35: ("quad9", 9)}
        with h5py.File(results / "results.h5", "r") as file:
            points, numbers = file["/mesh/nodes"][()], list(file["/mesh/cells"][()])
            read = [{name: field[()] for name, field in file[f"/frames/{name}"].items()} for name in file["/frames"]]
        found = {}
        while numbers:
            kind, count = kinds[numbers[0]]
            found.setdefault(kind, []).append(numbers[1:1 + count])
            numbers = numbers[1 + count:]
        self.check_cells(points, [(kind, numpy.array(nodes)) for kind, nodes in found.items()], 2.0, straight=True)
        tree = xml.etree.ElementTree.parse(results / "results.xdmf")
        times = [float(element.get("Value")) for element in tree.iter("Time")]
        self.assertEqual(len(times), len(read))
        self.check_probes(results, points, list(zip(times, read)))

    def test_cells_have_the_numbers_of_the_mesh_file(self):
        text = falling(self.write("strip.msh", STRIP), [0.0, 0.0], [0.0, 1.0], group="light")
        text += '[[material]]\ngroup = "heavy"\ndensity = 2.0\nlambda = 100.0\nmu = 50.0\n'
        results = self.simulate(self.write("case.toml", text))
        elements = [list(map(int, line.split())) for line in STRIP.split("$Elements")[1].splitlines()[2:-1]]
        nodes_of = {element[0]: element[5:] for element in elements}
        with h5py.File(results / "results.h5", "r") as file:
            numbers, cells = list(file["/mesh/element"][()]), file["/mesh/cells"][()]
        self.assertEqual(numbers, [70, 30, 50, 10])  # by group, in the order of the file
        for number, cell in zip(numbers, cells):
            self.assertEqual(sorted(cell + 1), sorted(nodes_of[number]))

    def test_curved_triangles(self):
        """The body as meshio reads it from the mesh file."""
        results = self.simulate_shape("disc", 2, 2)
        points, cells, read = frames(results)
        mesh = meshio.read(MESHES / "disc_o2_msh41_binary.msh")
        area = volumes("triangle6", mesh.points, mesh.cells_dict["triangle6"])[0].sum()
        self.assertAlmostEqual(area, numpy.pi, delta=0.01 * numpy.pi)
        self.check_cells(points, cells, area, straight=False)
        self.assertGreater(self.check_probes(results, points, read), 0)
        # Nodes have other numbers in memory; in files they have those of the mesh.
        numpy.testing.assert_array_equal(points, mesh.points)
        numpy.testing.assert_array_equal(dict(cells)["triangle6"], mesh.cells_dict["triangle6"])

    def test_schemes_on_the_disc(self):
        for scheme in ("reduced-kane", "newmark", "klr-conserving", "midpoint"):
            with self.subTest(scheme):
                values = method(scheme) | {"time.end": 0.01, "output.fields_every": 3}
                results = self.simulate(DISC, scheme, values)
                points, _, read = frames(results)
                self.assertEqual([t for t, _ in read][:2], [0.0, 3 * 1e-4])
                self.assertAlmostEqual(read[-1][0], 0.01, delta=1e-15, msg="the last step has its frame")
                self.assertGreater(self.check_probes(results, points, read), 0)
                with h5py.File(results / "results.h5", "r") as file:
                    self.assertEqual(len(file["/frames"]), len(read))
                    last = file["/frames"][f"{len(read) - 1:06d}"]
                    for name, field in read[-1][1].items():
                        self.assertEqual(last[name][()].tobytes(), field.tobytes(), name)

    def test_no_fields(self):
        results = self.simulate(DISC, values={"time.end": 0.001, "output.fields_every": 0})
        self.assertEqual(sorted(path.name for path in results.iterdir() if path.suffix != ".ckpt"),
                         ["history.csv", "summary.json"])

    def test_the_same_run_gives_the_same_bytes(self):
        """Run again later: nothing in the files depends on the time of writing."""
        case = self.write("block.toml", block_case())
        first = self.simulate(case, "first")
        time.sleep(1.1)  # file formats keep times in seconds
        second = self.simulate(case, "second")
        for name in ("history.csv", "results.h5", "results.xdmf"):
            self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)

    def test_well_formed_after_every_frame(self):
        """The run is stopped again and again: the files written by then are complete documents."""
        case = self.write("case.toml", block_case() + "[output]\nfields_every = 1\n")
        process = subprocess.Popen([PROGRAM, "run", case, "-o", self.folder / "out", "--quiet", "--set",
                                    "time.end=1000"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        counts = set()
        deadline = time.monotonic() + 60
        while len(counts) < 20 and time.monotonic() < deadline:
            time.sleep(0.005)
            os.kill(process.pid, signal.SIGSTOP)
            _, status = os.waitpid(process.pid, os.WUNTRACED)
            self.assertTrue(os.WIFSTOPPED(status), "the run ended early")
            side = self.folder / "out" / "results.xdmf"
            # Made empty first: that is before its first frame.
            if side.exists() and side.stat().st_size > 0:
                xml.etree.ElementTree.parse(side.with_name("obstacles.xdmf"))
                tree = xml.etree.ElementTree.parse(side)
                counts.add(sum(1 for _ in tree.iter("Time")))
            os.kill(process.pid, signal.SIGCONT)
        self.assertGreaterEqual(len(counts), 20)

    def test_all_fields(self):
        """Derived fields are derived here once more, independently."""
        for case, values in ((DISC, {"time.end": 0.05}), (SOURCE / "cases/ball/ball.toml", {"time.end": 0.02}),
                             (SOURCE / "cases/ball-axisymmetric/ball-axisymmetric.toml", {"time.end": 0.036}),
                             (DISC, {"time.end": 0.05, "mesh.degree": 2, "mesh.plane": "\"stress\""})):
            results = self.simulate(case, f"all-{len(list(self.folder.iterdir()))}",
                                    {**values, "output.fields": "[\"all\"]", "output.fields_every": 50})
            history = History(results / "history.csv")
            rows = {row[history.names.index("time")]: i for i, row in enumerate(history.rows)}
            with meshio.xdmf.TimeSeriesReader(results / "results.xdmf") as reader:
                points, cells = reader.read_points_cells()
                each = numpy.concatenate([volumes(block.type, points, block.data)[0] for block in cells])
                if "axisymmetric" in case.name:  # those of rings, of triangles (Pappus and Guldin)
                    each *= 2 * numpy.pi * numpy.concatenate([points[block.data, 0].mean(axis=1) for block in cells])
                for k in range(reader.num_steps):
                    at, nodal, cell = reader.read_data(k)
                    cell = {name: numpy.concatenate(blocks) for name, blocks in cell.items()}
                    self.assertEqual(set(nodal), {"displacement", "velocity", "acceleration", "contact_pressure", "gap",
                                                  "contact_status", "nodal_stress", "nodal_von_mises",
                                                  "nodal_principal_stress"})
                    self.assertEqual(set(cell), {"stress", "von_mises", "principal_stress", "strain_energy_density"})
                    energy = history["elastic_energy"][rows[at]]
                    largest = history.largest_energy()
                    self.assertAlmostEqual(float(cell["strain_energy_density"] @ each), energy, delta=1e-12 * largest)
                    self.check_stress(cell["stress"], cell["von_mises"], cell["principal_stress"])
                    self.check_stress(nodal["nodal_stress"], nodal["nodal_von_mises"], nodal["nodal_principal_stress"])
                    if "stress" in values.get("mesh.plane", ""):
                        self.assertFalse(numpy.any(cell["stress"][:, 5]))

    def check_stress(self, stress, von_mises, principal):
        xx, xy, xz, yy, yz, zz = stress.T
        tensors = numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
        size = max(numpy.abs(stress).max(), 1e-300)
        numpy.testing.assert_allclose(principal, numpy.linalg.eigvalsh(tensors)[:, ::-1], rtol=0, atol=1e-13 * size)
        a, b, c = principal.T
        expected = numpy.sqrt(0.5 * ((a - b)**2 + (b - c)**2 + (c - a)**2))
        numpy.testing.assert_allclose(von_mises, expected, rtol=0, atol=1e-13 * size)

    def test_fields_that_are_asked_for_single_and_compressed(self):
        values = {"time.end": 0.02, "output.fields_every": 20, "output.fields": '["velocity", "stress", "contact_status"]'}
        exact = frames(self.simulate(DISC, "exact", values))[2]
        small = self.simulate(DISC, "small", {**values, "output.fields_precision": "\"single\"", "output.compression": 6})
        read = frames(small)[2]
        self.assertEqual([at for at, _ in read], [at for at, _ in exact])
        for (_, a), (_, b) in zip(exact, read):
            self.assertEqual(sorted(a), ["contact_status", "velocity"])  # at nodes
            self.assertEqual(b["velocity"].dtype, numpy.float32)
            self.assertEqual(a["velocity"].astype(numpy.float32).tobytes(), b["velocity"].tobytes())
            self.assertEqual(a["contact_status"].tobytes(), b["contact_status"].tobytes())
        with h5py.File(small / "results.h5", "r") as file:
            self.assertEqual(file["mesh/nodes"].dtype, numpy.float64)
            self.assertEqual(file["frames/000003/stress"].compression, "gzip")
            self.assertEqual(file["frames/000003/stress"].shape, (780, 6))
        # Small bodies are not compressed, as they would grow.
        case = self.write("case.toml", block_case())
        sizes = [(self.simulate(case, f"block{level}", {"output.compression": level}) / "results.h5").stat().st_size
                 for level in (0, 9)]
        self.assertEqual(sizes[0], sizes[1])

    def test_fields_by_time(self):
        results = self.simulate(DISC, values={"time.end": 0.0105, "output.fields_interval": 0.00225})
        times = [at for at, _ in frames(results)[2]]
        numpy.testing.assert_allclose(times, [0, 0.0023, 0.0045, 0.0068, 0.009, 0.0105], rtol=1e-12)
        for fields in ("fields_every = 3\nfields_interval = 0.1", "fields = []", "fields = [\"stres\"]"):
            case = self.write("bad.toml", block_case() + "[output]\n" + fields + "\n")
            self.expect_status(2, run("run", case, "-o", self.folder / "bad"))

    def test_ten_thousand_frames_stay_openable(self):
        case = self.write("case.toml", block_case() + "[output]\nfields_every = 1\n")
        results = self.simulate(case, values={"time.end": 100.0})
        begun = time.monotonic()
        with meshio.xdmf.TimeSeriesReader(results / "results.xdmf") as reader:
            reader.read_points_cells()
            self.assertEqual(reader.num_steps, 10001)
            self.assertEqual(reader.read_data(10000)[0], 100.0)
        self.assertLess(time.monotonic() - begun, 60.0)  # some seconds: no quadratic cost

    def test_friction(self):
        """Tractions stay in the cone, on it if nodes slip, and agree with the probe's reactions."""
        values = {"contact.0.friction": 0.3, "initial.velocity": "[0.08,-0.1]", "time.end": 0.05,
                  "output.fields_every": 1}
        results = self.simulate(DISC, values=values)
        history = History(results / "history.csv")
        points, _, read = frames(results)
        lowest = int(numpy.argmin(numpy.linalg.norm(points[:, :2] - [0.0, 0.001], axis=1)))
        seen = set()
        for row, (_, fields) in enumerate(read):
            pressure, traction = fields["contact_pressure"], fields["friction_traction"]
            status = fields["contact_status"]
            scale = max(pressure.max(), 1e-300)
            size = numpy.linalg.norm(traction, axis=1)
            self.assertTrue((size <= 0.3 * pressure * (1 + 1e-12)).all(), row)
            self.assertTrue((size[status < 2] == 0.0).all(), row)
            self.assertLessEqual(numpy.abs(size - 0.3 * pressure)[status == 3].max(initial=0.0), 1e-12 * scale, row)
            self.assertEqual(numpy.count_nonzero(status == 2), history["sticking"][row])
            self.assertEqual(numpy.count_nonzero(status == 3), history["slipping"][row])
            seen |= set(status)
            if history["lowest.reaction_normal"][row] > 0.0:
                ratio = history["lowest.reaction_tangential_x"][row] / history["lowest.reaction_normal"][row]
                self.assertAlmostEqual(traction[lowest, 0] / pressure[lowest], ratio, delta=1e-12)
        self.assertEqual(seen, {-1, 0, 2, 3}, "open, sticking and slipping nodes are seen")
