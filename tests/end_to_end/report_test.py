"""`ricochet report`: the data in the page are those of history.csv and results.h5, unpacked here independently;
thinning is reported. viewer/test tests the page itself in a browser."""

import hashlib
import re

import h5py
import numpy

from harness import DISC, MESHES, PROGRAM, SOURCE, History, TestCase, block_case, body_case, method, summary_of, with_sphere
from report_page import SHORT, VIEWER, Page, ReportTestCase


class Report(ReportTestCase):
    def check_history(self, page, data, results):
        history = History(results / "history.csv")
        self.assertEqual(data["columns"], history.names)
        table = page.reals(data["history"])
        for name, column in zip(history.names, table):
            self.assertEqual(list(column), history[name], name)

    def check_frames(self, page, data, results):
        body, contact = data["body"], data["contact"]
        with h5py.File(results / "results.h5") as file:
            frames = [file["frames"][name] for name in sorted(file["frames"])]
            read = {name: numpy.array([frame[name][()] for frame in frames]) for name in frames[0]}
            nodes, cells = file["mesh/nodes"][()], file["mesh/cells"][()]
        self.assertEqual(len(body["times"]), len(frames))
        dimension = data["summary"]["dimension"]
        positions = page.levels(body["positions"])
        # The nodes are those of the file in another order: matched by position.
        order = [int(numpy.argmin(numpy.sum((nodes[:, :dimension] - place) ** 2, axis=1))) for place in positions.T]
        self.assertEqual(len(set(order)), body["nodes"])
        moved = numpy.stack([page.levels(array) for array in body["deviations"]], axis=2)
        moved += page.reals(body["mean"])[:, None, :dimension]
        wanted = read["displacement"][:, order, :dimension]
        self.assertLess(numpy.abs(moved - wanted).max(), 0.51 * max(a["step"] for a in body["deviations"]) + 1e-7)
        # Each triangle consists of nodes of its stated cell; here every cell is a triangle.
        corners = page.indices(body["corners"]).reshape(-1, 3)
        for field in body["fields"]:
            values = page.levels(field["values"])
            if field["on_nodes"]:
                wanted = read[field["name"]][:, order]
                if wanted.ndim == 3:
                    wanted = numpy.linalg.norm(wanted, axis=2)
            elif cells.shape[1] == 3:
                numbers = {tuple(sorted(cell)): i for i, cell in enumerate(cells)}
                own = page.indices(body["triangle_cells"])
                triangles = [numbers[tuple(sorted(order[c] for c in triangle))] for triangle in corners]
                values, wanted = values[:, own], read[field["name"]][:, triangles]
            else:
                continue
            scale = numpy.abs(wanted).max()
            self.assertLess(numpy.abs(values - wanted).max(), 0.51 * field["values"]["step"] + 1e-6 * scale, field["name"])
        line = [order[i] for i in page.indices(contact["nodes"])]
        on_boundary = numpy.flatnonzero(read["contact_status"][0] >= 0)
        self.assertEqual(sorted(line), list(on_boundary))
        for quantity in contact["quantities"]:
            values, wanted = page.levels(quantity["values"]), read[quantity["name"]][:, line]
            if wanted.ndim == 3:
                wanted = numpy.linalg.norm(wanted, axis=2)
            scale = numpy.abs(wanted).max()
            self.assertLess(numpy.abs(values - wanted).max(), 0.51 * quantity["values"]["step"] + 1e-6 * scale + 1e-30,
                            quantity["name"])
            if quantity["name"] == "contact_status":
                self.assertTrue((values == wanted).all())
        if dimension == 2:
            position = page.reals(contact["position"])[0]
            steps = numpy.linalg.norm(numpy.diff(nodes[line], axis=0), axis=1)
            numpy.testing.assert_allclose(numpy.diff(position), steps, rtol=1e-12)

    def check_inside(self, page, data, results):
        """All cells of a solid of tetrahedra occur once, with their values, up to the quantization."""
        body, volume = data["body"], data["body"]["volume"]
        with h5py.File(results / "results.h5") as file:
            frames = [file["frames"][name] for name in sorted(file["frames"])]
            read = {name: numpy.array([frame[name][()] for frame in frames]) for name in frames[0]}
            nodes, cells = file["mesh/nodes"][()], file["mesh/cells"][()]
        places = page.levels(volume["positions"]).T
        order = [int(numpy.argmin(numpy.sum((nodes - place) ** 2, axis=1))) for place in places]
        self.assertEqual(sorted(order), sorted(set(cells.ravel())))
        corners = numpy.array(order)[page.indices(volume["corners"])].reshape(-1, 4)
        numbers = {tuple(sorted(cell)): i for i, cell in enumerate(cells)}
        own = [numbers.pop(tuple(sorted(corner))) for corner in corners]
        self.assertEqual(numbers, {}, "cells that are not there")
        moved = numpy.stack([page.levels(array) for array in volume["deviations"]], axis=2)
        moved += page.reals(body["mean"])[:, None, :]
        error = numpy.abs(moved - read["displacement"][:, order]).max()
        self.assertLess(error, 0.51 * max(array["step"] for array in volume["deviations"]) + 1e-7)
        fields = {field["name"]: field for field in volume["fields"]}
        self.assertEqual(set(fields), {field["name"] for field in body["fields"]})
        values = page.levels(fields["von_mises"]["values"])[:, page.indices(volume["cells"])]
        wanted = read["von_mises"][:, own]
        self.assertLess(numpy.abs(values - wanted).max(), 0.51 * fields["von_mises"]["values"]["step"] + 1e-6 * wanted.max())

    def test_one_run_in_the_plane(self):
        results = self.simulate(DISC, "disc", SHORT)
        process = self.report(results)
        path = results / "report.html"
        self.assertIn(str(path), process.stdout)
        page = Page(path)
        before, after = VIEWER.split("<!--RICOCHET-DATA-->")
        self.assertTrue(page.text.startswith(before) and page.text.endswith(after), "the viewer is there, to the letter")
        self.assertNotRegex(page.text, r"(src|href)\s*=\s*[\"']?http")
        (data,) = page.runs
        self.assertEqual(data["name"], "disc")
        self.assertEqual(data["thinned"], [])
        self.assertEqual(data["summary"], summary_of(results))
        self.check_history(page, data, results)
        self.check_frames(page, data, results)
        # The obstacle does not move: its surface occurs once, on the line y = 0.
        self.assertEqual(len(data["obstacles"]["times"]), 1)
        self.assertEqual(page.reals(data["obstacles"]["positions"])[0][1::3].tolist(), [0.0, 0.0])

    def test_friction_and_degree_2(self):
        values = SHORT | {"contact.0.friction": 0.4, "initial.velocity": "[0.2, -0.1]", "mesh.degree": 2}
        results = self.simulate(DISC, "disc", values)
        self.report(results, "-o", self.folder / "page.html")
        (data,) = (page := Page(self.folder / "page.html")).runs
        self.assertIn("friction_traction", [q["name"] for q in data["contact"]["quantities"]])
        self.assertEqual(data["body"]["triangles"], 4 * data["summary"]["cells"])
        self.check_history(page, data, results)
        self.check_frames(page, data, results)

    def test_a_ball_is_its_boundary(self):
        case = DISC.parents[1] / "ball" / "ball.toml"
        results = self.simulate(case, "ball", {"time.end": 0.034, "output.fields": '["all"]'})
        self.report(results)
        (data,) = (page := Page(results / "report.html")).runs
        self.assertLess(data["body"]["nodes"], 0.7 * data["summary"]["nodes"])
        self.assertNotIn("position", data["contact"])
        self.assertTrue(any("stress" in sentence for sentence in data["thinned"]), data["thinned"])
        self.check_history(page, data, results)
        self.check_frames(page, data, results)
        self.check_inside(page, data, results)
        # The resultant is judged, and its magnitude includes all components.
        judgement, history = data["judgement"], History(results / "history.csv")
        self.assertEqual(judgement["force"], "contact_force_z")
        sizes = numpy.sqrt(sum(numpy.array(history[f"contact_force_{axis}"]) ** 2 for axis in "xyz"))
        self.assertAlmostEqual(judgement["force_largest"], sizes.max(), delta=1e-12 * sizes.max())
        self.assertAlmostEqual(judgement["force_largest_at"], history["time"][sizes.argmax()], delta=1e-12)

    def test_the_inside_of_a_solid_is_made_to_fit(self):
        case = DISC.parents[1] / "ball" / "ball.toml"
        results = self.simulate(case, "ball", {"time.end": 0.034, "output.fields_every": 1})
        self.report(results, "--size-limit", 1)
        (data,) = (page := Page(results / "report.html")).runs
        self.assertLess((results / "report.html").stat().st_size, 1_000_000)
        volume = data["body"]["volume"]
        if volume is None:
            self.assertTrue(any("there are no cuts" in sentence for sentence in data["thinned"]), data["thinned"])
        else:
            self.assertLess(volume["tetrahedra"], data["summary"]["cells"])
            self.assertTrue(any(f"{volume['tetrahedra']} tetrahedra" in sentence for sentence in data["thinned"]), data["thinned"])
            self.assertLess(page.indices(volume["corners"]).max(), volume["nodes"])

    def test_several_runs_are_told_apart(self):
        for scheme in ("midpoint", "reduced-kane"):
            self.simulate(DISC, f"runs/{scheme}", method(scheme) | {"time.end": 0.08, "output.fields_every": 50})
        self.report("runs/midpoint/", "runs/reduced-kane")
        page = Page(self.folder / "runs" / "report.html")
        self.assertEqual([data["name"] for data in page.runs], ["midpoint", "reduced-kane"])
        for data in page.runs:
            self.check_history(page, data, self.folder / "runs" / data["name"])
            self.check_frames(page, data, self.folder / "runs" / data["name"])
        judgements = [data["judgement"] for data in page.runs]
        self.assertGreater(judgements[0]["energy_gain"], 0.1 * judgements[0]["energy_scale"])
        self.assertLess(judgements[1]["energy_gain"], 1e-6 * judgements[1]["energy_scale"])
        self.assertGreater(judgements[0]["roughness"], 6)
        self.assertLess(judgements[1]["roughness"], 2)
        # One mesh: its nodes, triangles and edges are in the page once.
        for part in ("positions", "corners", "edges"):
            self.assertEqual(page.runs[0]["body"][part]["blob"], page.runs[1]["body"][part]["blob"])
        self.assertEqual(self.report("runs/midpoint", "runs/../runs/midpoint", status=1).stderr.count("named twice"), 1)

    def test_a_moving_obstacle(self):
        case = self.write("case.toml", block_case().replace("normal = [0.0, 1.0]", "normal = [0.0, 1.0]\nvelocity = [0.0, 0.5]"))
        results = self.simulate(case, "out", {"time.end": 0.1, "output.fields_every": 2})
        self.report(results)
        (data,) = (page := Page(results / "report.html")).runs
        obstacles = data["obstacles"]
        times = numpy.array(obstacles["times"])
        self.assertGreater(len(times), 2)
        numpy.testing.assert_allclose(page.reals(obstacles["positions"])[:, 1::3], [[0.0, 0.0]], atol=1e-12)
        offsets = page.reals(obstacles["offsets"])
        numpy.testing.assert_allclose(offsets, numpy.outer(times, [0.0, 0.5, 0.0]), atol=1e-9)

    def test_a_sphere_in_space_that_moves(self):
        """Its surface is in the page once, with its offset in each frame."""
        velocity = [0.5, -0.25, 2.0]
        text = with_sphere(body_case(MESHES / "tetrahedron_o1_msh41_binary.msh", [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], ""),
                           [0.7, 0.5, -1.5], 1.2, velocity)
        results = self.simulate(self.write("case.toml", text), "out", {"time.end": 0.1, "output.fields_every": 1})
        self.report(results)
        (data,) = (page := Page(results / "report.html")).runs
        obstacles = data["obstacles"]
        frames = len(data["body"]["times"])
        self.assertGreater(frames, 10)
        self.assertEqual(obstacles["times"], data["body"]["times"])
        positions = page.reals(obstacles["positions"])
        self.assertEqual(len(positions), 1)
        distances = numpy.linalg.norm(positions.reshape(-1, 3) - [0.7, 0.5, -1.5], axis=1)
        numpy.testing.assert_allclose(distances, 1.2, rtol=1e-8)
        cells = page.indices(obstacles["cells"])
        self.assertEqual((cells.min(), cells.max()), (0, positions.size // 3 - 1))
        self.assertEqual(page.indices(obstacles["obstacle"]).tolist(), [0] * (len(cells) // 4))
        numpy.testing.assert_allclose(page.reals(obstacles["offsets"]), numpy.outer(obstacles["times"], velocity), atol=1e-8)
        packed = sum(len(page.blobs[obstacles[part]["blob"]]) for part in ("positions", "cells", "obstacle", "offsets"))
        self.assertLess(packed, 80_000, "unpacked, of all frames")

    def test_a_turntable(self):
        """A rotating surface has other positions in each frame."""
        text = body_case(MESHES / "tetrahedron_o1_msh41_binary.msh", [0.0, 0.0, -0.1], [0.0, 0.0, 1.0], "").replace(
            "normal = [0.0, 0.0, 1.0]", "normal = [0.0, 0.0, 1.0]\nrotation_rate = 3.0")
        results = self.simulate(self.write("case.toml", text), "out", {"time.end": 0.1, "output.fields_every": 2})
        self.report(results)
        (data,) = (page := Page(results / "report.html")).runs
        obstacles = data["obstacles"]
        self.assertIsNone(obstacles["offsets"])
        corners = page.reals(obstacles["positions"]).reshape(len(obstacles["times"]), 4, 3)
        directions = corners - corners.mean(axis=1, keepdims=True)
        numpy.testing.assert_allclose(corners[:, :, 2], -0.1, rtol=1e-8)
        angles = numpy.unwrap(numpy.arctan2(directions[:, 0, 1], directions[:, 0, 0]))
        numpy.testing.assert_allclose(angles - angles[0], 3.0 * numpy.array(obstacles["times"]), atol=1e-7)

    def test_large_runs_are_thinned_and_it_is_said(self):
        results = self.simulate(DISC, "disc", {"output.fields_every": 1})
        self.report(results)
        whole = Page(results / "report.html")
        self.assertEqual(whole.runs[0]["thinned"], [])
        process = self.report(results, "--size-limit", 1, "-o", self.folder / "small.html")
        self.assertLess((self.folder / "small.html").stat().st_size, 1_000_000)
        (data,) = (small := Page(self.folder / "small.html")).runs
        frames = len(data["body"]["times"])
        self.assertLess(frames, 1501)
        self.assertTrue(any(f"{frames} of the 1501 frames" in sentence for sentence in data["thinned"]), data["thinned"])
        for sentence in data["thinned"]:
            self.assertIn(sentence, process.stderr)
        self.assertEqual(data["body"]["times"][-1], whole.runs[0]["body"]["times"][-1], "the last one stays")
        steps = [int(found[1]) for sentence in data["thinned"] if (found := re.search(r"displacements are stored in (\d+) steps", sentence))]
        self.assertIn(steps, [[2 ** bits - 2] for bits in range(8, 16)], data["thinned"])
        if data["rows_per_pair"] == 0:
            self.check_history(small, data, results)

    def test_a_long_history_keeps_its_extrema(self):
        case = self.write("case.toml", block_case())
        results = self.simulate(case, "out", {"time.step": 2e-5, "output.fields_every": 0})
        self.report(results, "--size-limit", 2)
        (data,) = (page := Page(results / "report.html")).runs
        history = History(results / "history.csv")
        self.assertGreater(len(history.rows), 15000)
        self.assertIsNone(data["body"])
        self.assertGreater(data["rows_per_pair"], 0)
        self.assertTrue(any(f"history.csv has all {len(history.rows)}" in sentence for sentence in data["thinned"]))
        table = page.reals(data["history"])
        for name, column in zip(history.names, table):
            whole = history[name]
            self.assertEqual((min(column), max(column)), (min(whole), max(whole)), name)
            self.assertEqual(set(column) - set(whole), set(), "no number that was not there")
        times = table[history.names.index("time")]
        self.assertTrue((numpy.diff(times) >= 0).all())

    def test_probes_with_rows_of_their_own(self):
        case = self.write("case.toml", block_case() + 'every = 4\n')
        results = self.simulate(case, "out", {"time.end": 0.1})
        self.report(results)
        (data,) = (page := Page(results / "report.html")).runs
        (table,) = data["tables"]
        self.assertEqual(table["file"], "probes-4.csv")
        history = History(results / "probes-4.csv")
        self.assertEqual(table["columns"], history.names)
        for name, column in zip(history.names, page.reals(table["values"])):
            self.assertEqual(list(column), history[name], name)


class BuiltViewer(TestCase):
    def test_the_page_in_the_repository_is_made_from_these_sources(self):
        """Users need no Node.js. `./dev viewer --test` checks that the bytes are those of the sources."""
        viewer = SOURCE / "viewer"
        files = [path for path in (viewer / "src").rglob("*") if path.is_file()]
        total = hashlib.sha256()
        for name in sorted(str(path.relative_to(viewer)) for path in [*files, viewer / "build.mjs", viewer / "package-lock.json"]):
            total.update(f"{name}\n".encode() + (viewer / name).read_bytes())
        page = (viewer / "built" / "viewer.html").read_text(encoding="utf-8")
        self.assertEqual(re.search(r"^<!-- sources (\w+) -->$", page, re.MULTILINE)[1], total.hexdigest(),
                         "viewer/ has changed: run ./dev viewer and commit viewer/built/viewer.html")
        self.assertEqual((PROGRAM.parent / "share" / "ricochet" / "viewer.html").read_text(encoding="utf-8"), page)
