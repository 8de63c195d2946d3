"""`ricochet report`: the data in the page are those of history.csv and results.h5, unpacked here by other means; what is
thinned is said; wrong use is explained. The page itself is tested in a browser by viewer/test."""

import base64
import hashlib
import json
import os
import re
import shutil
import subprocess
import unittest
import zlib

import h5py
import numpy

from harness import DISC, PROGRAM, SOURCE, History, TestCase, block_case, run

VIEWER = ("<!doctype html><!-- ricochet report --><!-- data format 3 --><html><body><p>a viewer</p><!--RICOCHET-DATA--><script>$&\\1</script>"
          "</body></html>\n")
SHORT = {"time.end": 0.02, "output.fields_every": 10}


class Page:
    """The data of a report, read as the description of the format says."""

    def __init__(self, path):
        self.text = path.read_text(encoding="utf-8")
        scripts = dict(re.findall(r'<script type="[^"]*" id="([^"]*)">(.*?)</script>', self.text, re.DOTALL))
        self.runs = json.loads(scripts["ricochet-runs"])["runs"]
        self.blobs = [zlib.decompress(base64.b64decode(scripts[f"ricochet-blob-{i}"], validate=True))
                      for i in range(len(scripts) - 1)]

    def reals(self, array):
        raw = numpy.frombuffer(self.blobs[array["blob"]], dtype=numpy.uint8).reshape(8, -1).T
        words = numpy.bitwise_xor.accumulate(numpy.ascontiguousarray(raw).view("<u8").ravel())
        return words.view(numpy.float64).reshape(array["rows"], array["columns"])

    def indices(self, array):
        raw = numpy.frombuffer(self.blobs[array["blob"]], dtype=numpy.uint8).reshape(4, -1).T
        code = numpy.ascontiguousarray(raw).view("<u4").ravel().astype(numpy.int64)
        return numpy.cumsum(numpy.where(code & 1, -(code >> 1) - 1, code >> 1))

    def levels(self, array):
        rows, columns, bits = array["rows"], array["columns"], array["bits"]
        planes = 2 if bits > 8 else 1
        raw = numpy.frombuffer(self.blobs[array["blob"]], dtype=numpy.uint8).reshape(rows, planes, columns)
        code = raw[:, 0].astype(numpy.int64) + (raw[:, 1].astype(numpy.int64) << 8 if planes == 2 else 0)
        change = numpy.where(code & 1, -(code >> 1) - 1, code >> 1)
        levels = numpy.zeros((rows, columns), dtype=numpy.int64)
        for r in range(rows):
            own = numpy.cumsum(change[r]) if r == 0 or array["prediction"] == 2 else change[r]
            levels[r] = ((levels[r - 1] if r > 0 else 0) + own) % (1 << bits)
        values = array["low"] + array["step"] * levels
        values[levels == (1 << bits) - 1] = numpy.nan
        return values


class Report(TestCase):
    def setUp(self):
        super().setUp()
        # A program with a viewer of its own, as an installation has it.
        (self.folder / "bin").mkdir()
        (self.folder / "share" / "ricochet").mkdir(parents=True)
        self.program = shutil.copy2(PROGRAM, self.folder / "bin" / "ricochet")
        self.viewer = self.write("share/ricochet/viewer.html", VIEWER)

    def simulate(self, case, name, values):
        settings = [part for key, value in values.items() for part in ("--set", f"{key}={value}")]
        process = run("run", case, "-o", self.folder / name, "--quiet", "--log-level", "error", *settings)
        self.assertEqual(process.returncode, 0, process.stderr)
        return self.folder / name

    def report(self, *arguments, status=0):
        process = subprocess.run([self.program, "report", *map(str, arguments)], cwd=self.folder, text=True,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=500)
        self.assertEqual(process.returncode, status, process.stderr)
        return process

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
        # The nodes are those of the file in another order: found by where they are.
        order = [int(numpy.argmin(numpy.sum((nodes[:, :dimension] - place) ** 2, axis=1))) for place in positions.T]
        self.assertEqual(len(set(order)), body["nodes"])
        moved = numpy.stack([page.levels(array) for array in body["deviations"]], axis=2)
        moved += page.reals(body["mean"])[:, None, :dimension]
        wanted = read["displacement"][:, order, :dimension]
        self.assertLess(numpy.abs(moved - wanted).max(), 0.51 * max(a["step"] for a in body["deviations"]) + 1e-7)
        # Triangles are made of nodes of the cell that they are said to be of; there every cell is a triangle.
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
        """All cells of a solid of tetrahedra are there once, with their values, as far as steps go."""
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
        self.assertEqual(data["summary"], json.loads((results / "summary.json").read_text()))
        self.check_history(page, data, results)
        self.check_frames(page, data, results)
        # The obstacle does not move: its surface is there once, on the line y = 0.
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
        # The resultant is what is judged, and its size is that of all components together.
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
        for scheme, mass in (("midpoint", "consistent"), ("newmark", "equivalent")):
            values = {"time.end": 0.08, "output.fields_every": 50, "time.scheme": scheme, "mass.type": mass}
            self.simulate(DISC, f"runs/{scheme}", values)
        self.report("runs/midpoint/", "runs/newmark")
        page = Page(self.folder / "runs" / "report.html")
        self.assertEqual([data["name"] for data in page.runs], ["midpoint", "newmark"])
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
        heights = page.reals(data["obstacles"]["positions"])[:, 1]
        numpy.testing.assert_allclose(heights, 0.5 * numpy.array(data["obstacles"]["times"]), atol=1e-12)

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
        self.assertTrue(any(f"in {2 ** 11 - 2} steps" in sentence for sentence in data["thinned"]), data["thinned"])
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

    def test_a_run_that_goes_on(self):
        """Again and again while frames are written."""
        command = [str(PROGRAM), "run", str(DISC), "-o", str(self.folder / "disc"), "--quiet", "--log-level", "error",
                   "--set", "time.end=4", "--set", "output.fields_every=10"]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            frames, reports = 0, 0
            while process.poll() is None and reports < 6:
                results = self.folder / "disc" / "results.xdmf"
                if not results.exists() or results.stat().st_size < 20_000:
                    continue
                self.report("disc")
                (data,) = (page := Page(self.folder / "disc" / "report.html")).runs
                self.assertGreaterEqual(len(data["body"]["times"]), frames)
                frames = len(data["body"]["times"])
                page.levels(data["body"]["deviations"][0])
                reports += 1
            self.assertGreater(reports, 2)
        finally:
            process.terminate()
            process.wait()

    def test_runs_that_are_not_complete(self):
        results = self.simulate(DISC, "disc", SHORT)
        history = results / "history.csv"
        text = history.read_text()
        summary = json.loads((results / "summary.json").read_text())
        summary["status"] = "interrupted"
        (results / "summary.json").write_text(json.dumps(summary))
        history.write_text(text[:-9])  # the last row is being written
        self.report(results)
        (data,) = Page(results / "report.html").runs
        self.assertEqual(data["history"]["columns"], text.count("\n") - 2)
        summary["status"] = "done"
        (results / "summary.json").write_text(json.dumps(summary))
        self.assertIn("history.csv:", self.report(results, status=2).stderr)

    def test_a_report_of_other_runs_is_not_replaced_unasked(self):
        for name in ("a", "a/b"):
            self.simulate(DISC, name, SHORT)
        self.report("a")
        self.report("a/")  # the same run again
        shutil.copy(self.folder / "a" / "report.html", self.folder / "a" / "b")
        process = self.report("a/b", status=4)
        self.assertIn("a/b/report.html: is there and shows other runs", process.stderr)
        self.report("a/b", "-o", "a/b/report.html")
        self.report("a/b")

    def test_a_viewer_of_another_version(self):
        results = self.simulate(DISC, "disc", SHORT)
        self.viewer.write_text(VIEWER.replace("format 3", "format 1"))
        self.assertIn("is not the viewer of this version: build or install", self.report(results, status=4).stderr)

    def test_titles_end_nothing(self):
        case = self.write("case.toml", block_case().replace('"A block falls"', '"</script><b>bold & \\"quoted\\""'))
        results = self.simulate(case, "out", {"time.end": 0.02})
        self.report(results)
        self.assertEqual(Page(results / "report.html").runs[0]["summary"]["title"], '</script><b>bold & "quoted"')

    def test_wrong_use(self):
        results = self.simulate(DISC, "disc", SHORT)
        self.assertIn("summary.json", self.report(self.folder / "bin", status=4).stderr)
        self.assertIn("no such directory", self.report(self.folder / "nowhere", status=4).stderr)
        self.report(status=1)
        self.assertIn("--size-limit", self.report(results, "--size-limit", "0.5", status=1).stderr)
        other = self.write("notes.html", "<p>my notes</p>")
        self.assertIn("no report", self.report(results, "-o", other, status=4).stderr)
        self.assertEqual(other.read_text(), "<p>my notes</p>")
        self.report(results, "-o", self.folder / "page.html")
        self.report(results, "-o", self.folder / "page.html")  # one's own is written over
        missing = self.folder / "missing"
        process = self.report(results, "-o", missing / "page.html", status=4)
        self.assertIn(f"{missing}/page.html: cannot write: {missing} does not exist", process.stderr)
        self.assertNotIn(".new", process.stderr)
        process = self.report(results, "-o", other / "page.html", status=4)
        self.assertIn(f"{other}/page.html: cannot write: {other} is no directory", process.stderr)
        os.truncate(results / "results.h5", 3000)
        self.assertIn("results.h5", self.report(results, status=2).stderr)
        self.viewer.unlink()
        process = self.report(results, status=4)
        self.assertIn("share/ricochet/viewer.html", process.stderr)
        self.assertIn("build or install Ricochet again", process.stderr)

    def test_runs_without_displacements_stand_still(self):
        for field in ("von_mises", "contact_pressure", "stress"):
            with self.subTest(field):
                results = self.simulate(DISC, field, SHORT | {"output.fields": f'["{field}"]'})
                self.report(results)
                (data,) = (page := Page(results / "report.html")).runs
                self.assertEqual(data["body"]["deviations"], [])
                self.assertFalse(page.reals(data["body"]["mean"]).any())
                self.assertTrue(any("no displacements" in sentence for sentence in data["thinned"]))

    def test_what_is_missing_is_said(self):
        results = self.simulate(DISC, "disc", SHORT)

        def sentences(name, content):
            whole = (results / name).read_bytes()
            (results / name).write_bytes(content(whole))
            self.report(results)
            (results / name).write_bytes(whole)
            return " ".join(Page(results / "report.html").runs[0]["thinned"])

        self.assertIn("history.csv ends at step", sentences("history.csv", lambda text: b"".join(text.splitlines(True)[:99])))
        self.assertIn("of the 21 frames", sentences("results.xdmf", lambda text: text[:len(text) // 2]))
        self.assertIn("have 0 of the 21 frames", sentences("results.xdmf", lambda text: b""))
        self.assertIn("obstacles.xdmf has 0 of 21 frames", sentences("obstacles.xdmf", lambda text: b""))
        (results / "results.h5").unlink()
        self.report(results)
        self.assertIn("missing", " ".join(Page(results / "report.html").runs[0]["thinned"]))
        text = (results / "history.csv").read_text()
        for wrong in ("nan", "0"):
            rows = text.splitlines()
            fields = rows[50].split(",")
            rows[50] = ",".join([fields[0], wrong, *fields[2:]])
            (results / "history.csv").write_text("\n".join(rows) + "\n")
            self.assertIn("history.csv:51: the time", self.report(results, status=2).stderr)

    def test_numbers_that_are_none_are_judged(self):
        results = self.simulate(DISC, "disc", SHORT)
        path = results / "history.csv"
        header, *rows = path.read_text().splitlines()
        names = header.split(",")
        for column, judged in (("total_energy", "energy"), ("contact_work", "energy"), ("max_penetration", "penetration"),
                               ("contact_force_y", "force"), ("lowest.reaction_normal", "force")):
            with self.subTest(column):
                fields = [row.split(",") for row in rows]
                for row in fields[100:]:
                    row[names.index(column)] = "inf"
                path.write_text("\n".join([header, *(",".join(row) for row in fields)]) + "\n")
                self.report(results)
                judgement = Page(results / "report.html").runs[0]["judgement"]
                self.assertAlmostEqual(judgement[f"{judged}_broken_at"], 0.01, delta=1e-12)
                others = {"energy", "penetration", "force"} - {judged}
                self.assertEqual([judgement[f"{other}_broken_at"] for other in others], [None, None])

    def test_an_infinite_depth_is_not_left_out(self):
        results = self.simulate(DISC, "disc", SHORT)
        summary = json.loads((results / "summary.json").read_text())
        summary["unwatched_penetration"]["found"] = [
            {"obstacle": "floor", "bodies": ["body 0"], "depth": "inf", "relative_depth": "inf", "time": 0.005,
             "place": [0.0, 0.0], "first_time": 0.005, "groups": []}]
        (results / "summary.json").write_text(json.dumps(summary))
        self.report(results)
        judgement = Page(results / "report.html").runs[0]["judgement"]
        self.assertEqual([judgement["penetration"], judgement["relative_penetration"]], ["inf", "inf"])
        # What is not known is another thing.
        self.report(self.simulate(DISC, "without", SHORT | {"output.fields_every": 0}))
        self.assertIsNone(Page(self.folder / "without" / "report.html").runs[0]["judgement"]["relative_penetration"])

    def test_judgements(self):
        """A rattling force is found in short and in sparsely written histories, rounding is not one, an explosion is told
        by its size, and without fields nothing is said of the body's size."""
        rattling = {"time.scheme": "klr-conserving", "mass.type": "consistent", "output.fields_every": 0}
        for name, values in (("short", {"time.end": 0.03}), ("sparse", {"output.history_every": 7})):
            self.report(self.simulate(DISC, name, rattling | values))
            judgement = Page(self.folder / name / "report.html").runs[0]["judgement"]
            self.assertGreater(judgement["roughness"], 6, name)
            self.assertIsNone(judgement["relative_penetration"])
            self.assertGreater(judgement["penetration"], 0)
        case = DISC.parents[1] / "hertz" / "cylinder.toml"
        self.report(self.simulate(case, "static", {}))
        self.assertEqual(Page(self.folder / "static" / "report.html").runs[0]["judgement"]["roughness"], 1)
        self.report(self.simulate(DISC, "explosion", {"time.beta": 0.25, "time.gamma": 0.2, "time.end": 0.2}))
        judgement = Page(self.folder / "explosion" / "report.html").runs[0]["judgement"]
        self.assertGreater(judgement["energy_gain"], 1e12 * judgement["energy_scale"])

    def test_damaged_frames_are_named(self):
        results = self.simulate(DISC, "disc", SHORT)
        with h5py.File(results / "results.h5", "r+") as file:
            del file["frames/000003/displacement"]
        self.assertIn("/frames/000003/displacement", self.report(results, status=2).stderr)
        (results / "obstacles.xdmf").write_text('<Grid Name="obstacles" GridType="Uniform"><Time Value="x"/></Grid>')
        self.assertIn("obstacles.xdmf:1: 'x' is not a number", self.report(results, status=2).stderr)


class BuiltViewer(TestCase):
    def test_the_page_in_the_repository_is_made_from_these_sources(self):
        """Users need no Node.js. Whether the bytes are those that the sources give is compared by `./dev viewer --test`."""
        viewer = SOURCE / "viewer"
        files = [path for path in (viewer / "src").rglob("*") if path.is_file()]
        total = hashlib.sha256()
        for name in sorted(str(path.relative_to(viewer)) for path in [*files, viewer / "build.mjs", viewer / "package-lock.json"]):
            total.update(f"{name}\n".encode() + (viewer / name).read_bytes())
        page = (viewer / "built" / "viewer.html").read_text(encoding="utf-8")
        self.assertEqual(re.search(r"^<!-- sources (\w+) -->$", page, re.MULTILINE)[1], total.hexdigest(),
                         "viewer/ has changed: run ./dev viewer and commit viewer/built/viewer.html")
        self.assertEqual((PROGRAM.parent / "share" / "ricochet" / "viewer.html").read_text(encoding="utf-8"), page)


if __name__ == "__main__":
    unittest.main()
