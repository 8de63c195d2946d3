"""Fields as VTKHDF (`output.format = "vtkhdf"`): to the bit those of results.h5, for VTK's reader and by the published
description, whatever happens to the run.

    vtkhdf_test.py [KILLS]     # by default 20 kills, as in ./dev test
"""

import contextlib
import random
import resource
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree

import h5py
import numpy

from harness import DISC, MESHES, TestCase, block_case, run, settings, summary_of, with_more, with_sphere
from interrupted_runs import ResumeTestCase, busy, start
from obstacle_files_test import surfaces
from report_page import Page
from results_files_test import SHAPES
from results_frames import falling, frames
from vtk_cells import volumes
from vtkhdf_reading import Grid, check_steps, view

KILLS = 20
VTKHDF = {"output.format": "vtkhdf"}
ALL = {"output.fields": "[\"all\"]"}
# VTK's numbers of cells (vtkCellType.h), and meshio's names of them.
TYPES = {5: "triangle", 22: "triangle6", 9: "quad", 28: "quad9", 10: "tetra", 24: "tetra10", 12: "hexahedron",
         29: "hexahedron27"}
# results.h5 has xx, xy, xz, yy, yz, zz; VTK calls the components of six xx, yy, zz, xy, yz, xz.
VTK_TENSOR = [0, 3, 5, 1, 4, 2]


def as_vtk(values):
    return values[:, VTK_TENSOR] if values.ndim == 2 and values.shape[1] == 6 else values


class VtkHdf(TestCase):
    def both(self, text, values=None):
        """Runs a case in both formats."""
        case = self.write("case.toml", text)
        options = ("--quiet", "--force")
        return (self.simulate(case, "xdmf", values, options),
                self.simulate(case, "vtkhdf", {**VTKHDF, **(values or {})}, options))

    def expect_same_bits(self, found, expected, what):
        self.assertEqual(found.dtype, expected.dtype, what)
        self.assertEqual(found.shape, expected.shape, what)
        self.assertEqual(found.tobytes(), expected.tobytes(), what)

    def check_fields(self, xdmf, vtkhdf):
        """Checks all frames by the description. Returns their number."""
        side = xml.etree.ElementTree.parse(xdmf / "results.xdmf")
        times = [float(at.get("Value")) for at in side.iter("Time")]
        with h5py.File(xdmf / "results.h5") as old, h5py.File(vtkhdf / "results.vtkhdf") as new:
            root = new["VTKHDF"]
            steps = check_steps(root)
            self.assertEqual([step.time for step in steps], times)
            for name in old["mesh"]:
                self.expect_same_bits(new["mesh"][name][()], old["mesh"][name][()], name)
            for step, frame in zip(steps, old["frames"].values()):
                self.assertEqual(set(step.fields), {*frame, "element"})
                self.expect_same_bits(step.read(root, "Points"), old["mesh/nodes"][()], "Points")
                self.expect_same_bits(step.read(root, "element"), old["mesh/element"][()], "element")
                for name, values in frame.items():
                    self.expect_same_bits(step.read(root, name), as_vtk(values[()]), f"{name} at {step.time}")
        self.assertEqual(summary_of(vtkhdf)["frames"], len(times))
        return len(times)

    def check_grid(self, grid, xdmf, frame):
        """Checks the data of this frame as read by VTK's reader."""
        self.check_mesh(grid, *frames(xdmf)[:2])
        self.check_values(grid, xdmf, frame)

    def check_mesh(self, grid, points, cells):
        self.expect_same_bits(grid.points, points, "points")
        begin, at = 0, 0
        for kind, nodes in cells:
            self.assertEqual({TYPES[number] for number in grid.types[begin:begin + len(nodes)]}, {kind})
            self.assertEqual(grid.offsets[begin:begin + len(nodes) + 1].tolist(),
                             list(range(at, at + nodes.size + 1, nodes.shape[1])))
            self.assertEqual(grid.connectivity[at:at + nodes.size].tolist(), nodes.ravel().tolist())
            begin, at = begin + len(nodes), at + nodes.size
        self.assertEqual((begin, at), (len(grid.types), len(grid.connectivity)))

    def check_values(self, grid, xdmf, frame):
        with h5py.File(xdmf / "results.h5") as file:
            fields = file[f"frames/{frame:06d}"]
            self.assertEqual(set(grid.fields), {*fields, "element"})
            for name, values in fields.items():
                self.expect_same_bits(grid.fields[name], as_vtk(values[()]), f"{name} of frame {frame} in VTK")

    def check_shape(self, shape, order, degree, values=None):
        about = {key: value for key, value in SHAPES[shape].items() if key != "volume"}
        text = falling(MESHES / f"{shape}_o{order}_msh41_binary.msh", degree=degree, scheme="klr-conserving", **about)
        xdmf, vtkhdf = self.both(text, {**ALL, **(values or {})})
        count = self.check_fields(xdmf, vtkhdf)
        self.assertEqual(count, 31)
        # meshio 5.3 does not support triangles of degree 2 beside other cells: only the volume is checked there.
        check = self.check_values if shape == "mixed" and degree == 2 else self.check_grid
        grid = Grid(vtkhdf / "results.vtkhdf")
        check(grid, xdmf, 0)
        for frame in (0, 1, 17, count - 1):
            check(Grid(view(vtkhdf / "results.vtkhdf", frame, self.folder / f"{frame}.vtkhdf")), xdmf, frame)
        total = sum(volumes(TYPES[grid.types[i]], grid.points, grid.connectivity[None, begin:end])[0][0]
                    for i, (begin, end) in enumerate(zip(grid.offsets, grid.offsets[1:])))
        self.assertAlmostEqual(total, SHAPES[shape]["volume"], delta=1e-10)
        self.assertGreater(grid.fields["element"].min(), 0)

    def test_cells_in_the_plane(self):
        for shape, order, degree in (("triangle", 1, 1), ("triangle", 2, 2), ("triangle", 1, 2), ("quadrilateral", 1, 1),
                                     ("quadrilateral", 2, 2), ("mixed", 1, 1), ("mixed", 1, 2)):
            with self.subTest(shape=shape, order=order, degree=degree):
                self.check_shape(shape, order, degree)

    def test_cells_in_space(self):
        for shape, order, degree in (("tetrahedron", 1, 1), ("tetrahedron", 2, 2), ("hexahedron", 1, 1),
                                     ("hexahedron", 2, 2)):
            with self.subTest(shape=shape, order=order, degree=degree):
                self.check_shape(shape, order, degree)

    def test_single_precision_and_compression(self):
        """The fields of the disc are large enough to be compressed."""
        text = with_more(DISC, "")
        for k, values in enumerate(({"output.fields_precision": "single"}, {"output.compression": 4},
                                    {"output.fields_precision": "single", "output.compression": 1})):
            values = {**ALL, **values, "time.end": 0.02, "output.fields_every": 2, "mesh.degree": 2}
            with self.subTest(k):
                xdmf, vtkhdf = self.both(text, values)
                self.assertEqual(self.check_fields(xdmf, vtkhdf), 101)
                self.check_grid(Grid(view(vtkhdf / "results.vtkhdf", 88, self.folder / "88.vtkhdf")), xdmf, 88)
                with h5py.File(vtkhdf / "results.vtkhdf") as file:
                    stress = file["VTKHDF/PointData/nodal_stress"]
                    self.assertEqual(stress.compression, "gzip" if "output.compression" in values else None)

    def check_obstacles(self, xdmf, vtkhdf, corners):
        shown = list(surfaces(xdmf, corners))
        with h5py.File(vtkhdf / "obstacles.vtkhdf") as file:
            root = file["VTKHDF"]
            steps = check_steps(root)
            self.assertEqual([step.time for step in steps], [at for at, _, _ in shown])
            for step, (_, points, cells) in zip(steps, shown):
                numpy.testing.assert_allclose(step.read(root, "Points"), points, rtol=1e-8, atol=1e-300)
                self.assertEqual(step.read(root, "Connectivity").tolist(), cells.ravel().tolist())
        for k in (0, len(steps) - 1):
            grid = Grid(view(vtkhdf / "obstacles.vtkhdf", k, self.folder / f"obstacles-{k}.vtkhdf"))
            self.assertEqual(set(grid.types), {3 if corners == 2 else 9})
            numpy.testing.assert_allclose(grid.points, shown[k][1], rtol=1e-8, atol=1e-300)
            self.assertEqual(set(grid.fields), {"obstacle"})
        return grid

    def test_obstacles_in_the_plane(self):
        text = block_case().replace("normal = [0.0, 1.0]", "normal = [0.0, 1.0]\nvelocity = [0.3, -0.05]")
        text += '[obstacle.wall]\ntype = "plane"\npoint = [2.0, 0.0]\nnormal = [-1.0, 0.0]\n[[contact]]\ngroup = "bottom"\nobstacle = "wall"\n'
        grid = self.check_obstacles(*self.both(text), 2)
        self.assertEqual(grid.fields["obstacle"].tolist(), [0, 1])

    def test_obstacles_in_space(self):
        text = falling(MESHES / "tetrahedron_o1_msh41_binary.msh", lowest=[1.3, 0.1, 0.0], highest=[0.3, 1.4, 1.2])
        text = with_sphere(text, [0.7, 0.5, -1.5], 1.2, [0.5, -0.25, 2.0])
        self.check_obstacles(*self.both(text, {"output.compression": 1, "output.fields_precision": "double"}), 4)

    def test_without_contact(self):
        text = block_case().split("[obstacle.floor]")[0] + "[load]" + block_case().split("[load]")[1]
        xdmf, vtkhdf = self.both(text)
        self.assertGreater(self.check_fields(xdmf, vtkhdf), 9)
        self.assertEqual(sorted(path.name for path in vtkhdf.glob("*.vtkhdf")), ["results.vtkhdf"])

    def test_without_frames(self):
        output = self.simulate(self.write("case.toml", block_case()), "out", {**VTKHDF, "output.fields_every": 0})
        self.assertEqual(list(output.glob("*.vtkhdf*")), [])
        self.expect_status(0, run("info", output))
        self.expect_status(0, run("report", output, "-o", self.folder / "report.html"))

    def test_reports_and_figures(self):
        """The same pages except for names and times, and the same figures, from either format."""
        values = {**ALL, "time.end": 0.02, "output.fields_every": 10}
        xdmf, vtkhdf = self.both(with_more(DISC, ""), values)
        pages = []
        for output in (xdmf, vtkhdf):
            self.assertIn("Elastic disc", self.expect_status(0, run("info", output)).stdout)
            page = self.folder / f"{output.name}.html"
            self.expect_status(0, run("report", output, "-o", page))
            pages.append(Page(page))
            self.expect_status(0, run("plot", output, "--what", "pressure-map", "--label", "disc", "-o", self.folder / f"{output.name}.svg"))
        figures = [(self.folder / f"{name}.svg").read_text() for name in ("xdmf", "vtkhdf")]
        self.assertTrue(figures[0] == figures[1])
        self.assertIn("fields that are only in results.vtkhdf: stress", " ".join(pages[1].runs[0]["thinned"]))
        one, other = ({key: value for key, value in page.runs[0]["body"].items()} for page in pages)
        self.assertEqual(one, other)
        self.assertEqual(pages[0].runs[0]["obstacles"]["times"], pages[1].runs[0]["obstacles"]["times"])
        (vtkhdf / "obstacles.vtkhdf").unlink()
        (vtkhdf / "results.vtkhdf").write_bytes((vtkhdf / "results.vtkhdf").read_bytes()[:20000])
        self.assertIn("results.vtkhdf", self.expect_status(2, run("report", vtkhdf)).stderr)
        (vtkhdf / "results.vtkhdf").unlink()
        self.expect_status(0, run("report", vtkhdf, "-o", self.folder / "missing.html"))
        self.assertIn("have 0 of the 21 frames", " ".join(Page(self.folder / "missing.html").runs[0]["thinned"]))

    def test_misuse(self):
        case = self.write("case.toml", block_case())
        said = self.expect_status(2, run("run", case, "-o", self.folder / "out", "--set", "output.format=vtk")).stderr
        self.assertIn("output.format", said)
        for word in ("xdmf", "vtkhdf"):
            self.assertIn(word, said)
        self.assertFalse((self.folder / "out").exists())
        # An existing run in another format is not lost unless this is requested.
        output = self.simulate(case, "out", {"output.checkpoint_every": 10})
        before = (output / "results.h5").read_bytes()
        more = ("--set", "output.checkpoint_every=10", *settings(VTKHDF))
        said = self.expect_status(2, run("run", case, "-o", output, "--resume", "--set", "time.end=0.4", *more)).stderr
        self.assertIn("output.format", said)
        self.assertEqual((output / "results.h5").read_bytes(), before)
        self.expect_status(0, run("run", case, "-o", output, "--force", "--quiet", *more))
        self.assertEqual(sorted(path.name for path in output.glob("*s.*") if path.suffix != ".json"),
                         ["obstacles.vtkhdf", "results.vtkhdf"])


class InterruptedVtkHdf(ResumeTestCase):
    def readable(self, output):
        """Reads every step of the results so far, each complete. Returns their number."""
        with h5py.File(output / "results.vtkhdf") as file:
            root = file["VTKHDF"]
            steps = check_steps(root, killed=True)
            for step in steps:
                self.assertTrue(all(numpy.isfinite(step.read(root, name)).all() for name in step.fields if name != "gap"))
                # The moving disc: a step whose numbers had not been written would have the fill value.
                self.assertTrue(step.read(root, "velocity").any())
        if not steps:
            return 0
        with h5py.File(output / "obstacles.vtkhdf") as file:
            self.assertGreaterEqual(len(check_steps(file["VTKHDF"], killed=True)), len(steps))
        last = len(steps) - 1
        Grid(view(output / "results.vtkhdf", last, self.folder / "last.vtkhdf"))
        return len(steps)

    def test_killed_at_random_moments(self):
        """kill -9 while frames are written, then --resume: existing results can be read, and the end is the same."""
        seed = random.randrange(2**32)
        chance = random.Random(seed)
        kills, seen, completed = 0, 0, 0
        variants = [{}, {"output.compression": 2, "output.fields_precision": "single"}]
        durations = [0.0, 0.0]
        while kills < KILLS or seen == 0 or completed < 2:
            variant = completed % 2
            values = {**busy("newmark"), **VTKHDF, "output.fields_every": 2, **variants[variant]}
            begun = time.monotonic()
            expected = self.reference(values)
            durations[variant] = duration = max(durations[variant], time.monotonic() - begun)
            output = self.folder / f"killed-{completed}"
            while True:
                process = start(self.disc, output, values, "--resume")
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(chance.uniform(0.0, max(duration, 0.15)))
                alive = process.poll() is None
                process.kill()
                _, errors = process.communicate()
                if not alive:
                    break
                kills += 1
                if (output / "history.csv").exists():
                    seen += self.readable(output)
                    run("info", output)
            self.assertEqual(process.returncode, 0, f"seed {seed}: {errors}")
            self.expect_same(expected, output)
            completed += 1
        print(f"{kills} kills, {seen} frames read after them", file=sys.stderr)

    def test_full_disk(self):
        """No part of a frame is written unless there is space for all of it."""
        values = {**busy("newmark"), **VTKHDF}
        expected = self.reference(values)
        size = (expected / "results.vtkhdf").stat().st_size
        for k in range(4):
            output = self.folder / f"full-{k}"
            limit = size * (k + 2) // 6
            process = start(self.disc, output, values, preexec_fn=lambda limit=limit: resource.setrlimit(
                resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY)))
            _, errors = process.communicate()
            self.assertEqual(process.returncode, 4, errors)
            self.assertIn("results.vtkhdf: cannot write: File too large", errors)
            self.readable(output)
            self.expect_status(0, run("run", self.disc, "-o", output, "--resume", "--quiet", *settings(values)))
            self.expect_same(expected, output)

    def test_what_was_changed_is_refused(self):
        values = {**busy("newmark"), **VTKHDF}
        expected = self.reference(values)
        with h5py.File(expected / "results.vtkhdf") as file:
            chunk = file["VTKHDF/PointData/displacement"].id.get_chunk_info(5)
            at = chunk.byte_offset + chunk.size // 2
        for k, (name, change, message) in enumerate((
                ("results.vtkhdf", lambda data: data[:at] + bytes([data[at] ^ 1]) + data[at + 1:],
                 "step 5 of /VTKHDF differs from"),
                ("results.vtkhdf", lambda data: data[:len(data) // 2], "results.vtkhdf: "),
                ("obstacles.vtkhdf", lambda data: data[:len(data) // 2], "obstacles.vtkhdf: "))):
            output = self.interrupted(values, f"changed-{k}")
            (output / name).write_bytes(change((output / name).read_bytes()))
            before = {path.name: path.read_bytes() for path in output.iterdir()}
            process = run("run", self.disc, "-o", output, "--resume", "--quiet", *settings(values))
            self.assertIn(message, self.expect_status(4, process).stderr)
            after = {path.name: path.read_bytes() for path in output.iterdir()}
            self.assertEqual([name for name in before | after if after.get(name) != before.get(name)], [])

    def test_a_later_end(self):
        values = {**busy("newmark"), **VTKHDF}
        expected = self.reference({**values, "time.end": 0.1})
        output = self.simulate(self.disc, "later", values)
        self.expect_status(0, run("run", "--resume", output, "--quiet", "--set", "time.end=0.1"))
        self.expect_same(expected, output)


if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1].isdigit():
        KILLS = int(sys.argv.pop(1))
    unittest.main()
