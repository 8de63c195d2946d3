"""`ricochet plot`: the curves of a figure are those of history.csv, read back from the SVG; wrong use is explained."""

import os
import re
import shutil
import struct
import xml.etree.ElementTree

import h5py
import numpy

from harness import DISC, History, TestCase, run, settings

SVG = "{http://www.w3.org/2000/svg}"


def curves(path):
    """Returns the long lines of an SVG as arrays of points. Grid lines and ticks have two."""
    result = []
    for element in xml.etree.ElementTree.parse(path).iter(f"{SVG}path"):
        points = re.findall(r"[ML] (-?[\d.]+) (-?[\d.]+)", element.get("d", ""))
        if len(points) > 50 and "clip-path" in element.attrib:
            result.append(numpy.array(points, dtype=float))
    return result


def texts(path):
    """Returns the positions of the texts of an SVG, from the top, in points: matplotlib draws letters and leaves the
    text in a comment."""
    return {text: float(height) for text, height in
            re.findall(r"<!-- (.*?) -->\s*<g [^>]*translate\([-\d.]+ ([-\d.]+)\)", path.read_text(encoding="utf-8"))}


def width_of_axes(path):
    """Returns the width of the first panel relative to the figure's width."""
    root = xml.etree.ElementTree.parse(path)
    (box,) = [group for group in root.iter(f"{SVG}g") if group.get("id") == "patch_2"]
    across = [float(x) for x in re.findall(r"[ML] (-?[\d.]+) ", box.find(f"{SVG}path").get("d"))]
    return (max(across) - min(across)) / float(root.getroot().get("width").removesuffix("pt"))


class Plot(TestCase):
    def simulate(self, name, case=DISC, **values):
        process = run("run", case, "-o", self.folder / name, "--quiet", "--log-level", "error",
                      *settings({"time.end": 0.02, "output.fields_every": 10} | values))
        self.assertEqual(process.returncode, 0, process.stderr)
        return self.folder / name

    def plot(self, *arguments, status=0, environment=None):
        process = run("plot", *arguments, directory=self.folder, environment=environment)
        self.assertEqual(process.returncode, status, process.stderr)
        return process

    def check_curve(self, points, times, values):
        """Checks that points are an affine image of the numbers, with SVG's downward axis."""
        self.assertEqual(len(points), len(times))
        for coordinate, wanted, sign in ((points[:, 0], times, 1), (points[:, 1], values, -1)):
            wanted = numpy.array(wanted)
            slope, offset = numpy.polyfit(wanted, coordinate, 1)
            self.assertGreater(sign * slope, 0)
            self.assertLess(numpy.abs(slope * wanted + offset - coordinate).max(), 2e-3, "hundredths of a point")

    def test_curves_are_those_of_the_history(self):
        results = self.simulate("run")
        history = History(results / "history.csv")
        for what, column in (("force", "contact_force_y"), ("momentum", "momentum_y"), ("pressure", "lowest.pressure"),
                             ("probe:lowest.displacement_y", "lowest.displacement_y"),
                             ("elastic_energy", "elastic_energy")):
            with self.subTest(what):
                process = self.plot(results, "--what", what, "-o", "figure.svg")
                self.assertEqual(process.stdout, "figure.svg\n")
                (points,) = curves(self.folder / "figure.svg")
                self.check_curve(points, history["time"], history[column])

    def test_instants_are_those_of_the_scheme(self):
        """Energies of klr-conserving are those half a step later: its curve is shifted to the right by that much."""
        runs = [self.simulate("klr", **{"time.scheme": "klr-conserving", "mass.type": "consistent"}), self.simulate("default")]
        self.plot(*runs, "--what", "kinetic_energy", "-o", "figure.svg")
        first, second = curves(self.folder / "figure.svg")
        step = (first[-1, 0] - first[0, 0]) / (len(first) - 1)
        self.assertAlmostEqual(first[0, 0] - second[0, 0], 0.5 * step, delta=2e-4)

    def test_panels_and_parts_of_the_time(self):
        runs = [self.simulate("a"), self.simulate("b", **{"time.step": 2e-4})]
        self.plot(*runs, "--what", "energy", "--what", "force", "-o", "figure.svg", "--title", "Two <runs> & more",
                  "--label", "fine", "--label", "coarse", "--time", "0.005:0.01")
        lengths = sorted(len(re.findall(r"[ML] ", element.get("d", "")))
                         for element in xml.etree.ElementTree.parse(self.folder / "figure.svg").iter(f"{SVG}path")
                         if "clip-path" in element.attrib)
        self.assertEqual(lengths[-4:], [26, 26, 51, 51])

    def test_forms_and_sizes(self):
        results = self.simulate("run")
        for form in ("svg", "pdf", "png"):
            with self.subTest(form):
                output = self.folder / f"figure.{form}"
                self.plot(results, "--what", "energy", "--what", "pressure-map", "-o", output, "--size", "12x5")
                first = output.read_bytes()
                self.plot(results, "--what", "energy", "--what", "pressure-map", "-o", output, "--size", "12x5")
                self.assertEqual(output.read_bytes(), first, "the same figure again")
                if form == "png":
                    self.assertEqual(first[:4], b"\x89PNG")
                    width, height = struct.unpack(">II", first[16:24])
                    self.assertAlmostEqual(width, 12 / 2.54 * 200, delta=1)
                    self.assertAlmostEqual(height, 5 / 2.54 * 200, delta=1)
                elif form == "pdf":
                    self.assertTrue(first.startswith(b"%PDF") and first.rstrip().endswith(b"%%EOF"))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["figure.pdf", "figure.png", "figure.svg", "run"])

    def test_runs_of_a_study_are_called_by_what_differs(self):
        """For any length of the names, axes keep their width and the title stands above the names."""
        study = self.folder / "study"
        values = settings({"time.end": 0.01, "output.fields_every": 0})
        self.expect_status(0, run("study", DISC, "--vary", "time.scheme,mass.type=reduced-kane/equivalent,midpoint/consistent",
                                  "--vary", "time.step=2e-4,1e-4", *values, "-o", study, "--quiet"))
        runs = sorted((study / "runs").iterdir())
        figure = self.folder / "figure.svg"
        self.plot(*runs[::2], "--what", "energy", "-o", figure)
        self.assertLessEqual({"reduced-kane", "midpoint"}, set(texts(figure)))
        self.plot(*runs, "--what", "energy", "-o", figure)
        self.assertIn("midpoint, step 1e-4", texts(figure))
        elsewhere = [shutil.copytree(folder, self.folder / folder.name) for folder in runs]
        for folders in (runs, elsewhere):
            self.plot(*folders, "--what", "energy", "-o", figure, "--title", "All of them")
            self.assertGreater(width_of_axes(figure), 0.7)
            names = [height for text, height in texts(figure).items() if "midpoint" in text]
            self.assertTrue(names)
            self.assertLess(texts(figure)["All of them"] + 5, min(names))
        self.plot(study, "--what", "peak_von_mises-against-time.step",
                  "-o", figure, "--title", "All of them")
        self.assertLess(texts(figure)["All of them"] + 5, texts(figure)["midpoint"])

    def test_keys_that_are_vectors(self):
        """The axis is the component that differs, else the length: 5, 10 and 13 of Pythagorean triangles."""
        def study(name, values):
            process = run("study", DISC, "--vary", f"initial.velocity={values}", "-o", self.folder / name, "--quiet", "--jobs", "1",
                          "--log-level", "error", *settings({"time.end": 0.0005, "output.fields_every": 0}))
            self.assertEqual(process.returncode, 0, process.stderr)
            return self.folder / name

        one = study("one", "[0,-0.1],[0,-0.2],[0,-0.4]")
        self.plot(one, "--what", "steps-against-initial.velocity", "-o", "one.svg")
        self.assertIn("initial.velocity, y", texts(self.folder / "one.svg"))
        both = study("both", "[0.03,-0.04],[0.06,-0.08],[0.05,-0.12]")
        for part, name, wanted in (("", "length of initial.velocity", [0.05, 0.1, 0.13]), (".x", "initial.velocity, x", [0.03, 0.06, 0.05])):
            self.plot(both, "--what", f"steps-against-initial.velocity{part}", "-o", "both.svg")
            self.assertIn(name, texts(self.folder / "both.svg"))
            places = sorted(float(x) for x in re.findall(r'<use xlink:href="#m\w+" x="([\d.]+)" y="[\d.]+" style="fill: #1b1f24',
                                                         (self.folder / "both.svg").read_text(encoding="utf-8")))
            self.assertEqual(len(places), 3)
            wanted = sorted(wanted)
            self.assertAlmostEqual((places[1] - places[0]) / (places[2] - places[0]), (wanted[1] - wanted[0]) / (wanted[2] - wanted[0]),
                                   delta=1e-4)
        process = self.plot(both, "--what", "steps-against-initial.velocity.z", "-o", "a.svg", status=1)
        self.assertIn('no column "initial.velocity.z"', process.stderr)

    def test_names_of_ticks_do_not_touch(self):
        study = self.folder / "study"
        names = ",".join(f"a-rather-long-name-{i}" for i in range(6))
        self.expect_status(0, run("study", DISC, "--vary", f"title={names}", *settings({"time.end": 1e-3}), "-o", study, "--quiet"))
        self.plot(study, "--what", "steps-against-title", "-o", "figure.svg")
        text = (self.folder / "figure.svg").read_text(encoding="utf-8")
        self.assertRegex(text, r"a-rather-long-name-3 -->\s*<g [^>]*rotate\(")

    def test_a_run_that_grows_does_not_hide_the_others(self):
        values = {"time.end": 0.06}
        runs = [self.simulate("midpoint", **values, **{"time.scheme": "midpoint", "mass.type": "consistent"}),
                self.simulate("default", **values)]
        self.plot(*runs, "--what", "energy", "-o", "figure.svg")
        # Matplotlib clips curves at the picture: most of the midpoint scheme's curve is outside.
        lengths = sorted(len(points) for points in curves(self.folder / "figure.svg"))
        self.assertEqual(lengths[1], 601)
        self.assertLess(lengths[0], 300)
        self.plot(*runs, "--what", "energy", "-o", "logarithmic.svg", "--log")
        self.assertEqual([len(points) for points in curves(self.folder / "logarithmic.svg")], [601, 601])

    def test_a_logarithm_leaves_out_what_it_cannot_show(self):
        """The force is zero until the disc touches at 7.35 ms: no line leads there."""
        results = self.simulate("run")
        self.plot(results, "--what", "force", "-o", "figure.svg", "--log")
        (points,) = curves(self.folder / "figure.svg")
        positive = sum(value > 0 for value in History(results / "history.csv")["contact_force_y"])
        self.assertEqual(len(points), positive)
        self.plot(results, "--what", "energy", "-o", "energy.svg")
        (energy,) = curves(self.folder / "energy.svg")
        self.assertGreater(points[0, 0] - energy[0, 0], 0.3 * (energy[-1, 0] - energy[0, 0]), "the axis is that of all times")

    def test_long_histories_are_thinned_to_what_can_be_seen(self):
        results = self.simulate("run", **{"time.step": 1e-6, "output.fields_every": 0, "time.end": 0.021})
        history = History(results / "history.csv")
        self.assertGreater(len(history.rows), 20_001)
        self.plot(results, "--what", "force", "-o", "figure.svg")
        (points,) = curves(self.folder / "figure.svg")
        self.assertLessEqual(len(points), 20_000)
        self.assertGreater(len(points), 10_000)

    def test_more_runs_than_colours_are_told_apart(self):
        results = self.simulate("run", **{"time.end": 0.012, "time.step": 2e-4})
        others = [self.folder / f"run{i}" for i in range(17)]
        for folder in others:
            shutil.copytree(results, folder)
        for what in ("force", "energy"):
            self.plot(*others, "--what", what, "-o", "figure.svg")
            lines = []
            for element in xml.etree.ElementTree.parse(self.folder / "figure.svg").iter(f"{SVG}path"):
                if "clip-path" in element.attrib and len(re.findall(r"[ML] ", element.get("d", ""))) > 50:
                    lines.append(dict(entry.strip().split(": ", 1) for entry in element.get("style").split(";") if entry))
            self.assertEqual(len(lines), 17)
            self.assertEqual(len({(line["stroke"], line.get("stroke-dasharray")) for line in lines}), 17, what)
            self.assertEqual(len({line["stroke-width"] for line in lines}), 1, "widths would mean nothing")

    def test_wrong_use(self):
        results = self.simulate("run")
        for arguments, status, message in (
                (["--what", "energy", "-o", "figure.eps"], 1, "an .svg, .pdf or .png file"),
                (["--what", "enrgy", "-o", "f.svg"], 1, 'has no column "enrgy"'),
                (["--what", "total_enrgy", "-o", "f.svg"], 1, 'did you mean "total_energy"?'),
                (["--what", "probe:lowest.speed", "-o", "f.svg"], 1, "probe:NAME.COLUMN"),
                (["--what", "energy", "-o", "f.svg", "--time", "1:2"], 1, "nothing to draw in this time interval"),
                (["--what", "energy", "-o", "f.svg", "--time", "2:1"], 1, "for example 0.02:0.05"),
                (["--what", "energy", "-o", "f.svg", "--time", "now"], 1, "for example 0.02:0.05"),
                (["--what", "energy", "-o", "f.svg", "--size", "17xbig"], 1, "for example 17x6"),
                (["--what", "energy", "-o", "f.svg", "--size", "1x900"], 1, "from 2 to 200"),
                (["--what", "energy", "-o", "f.svg", "--label", "a", "--label", "b"], 1, "2 times for 1 runs"),
                (["--what", "friction_work", "-o", "f.svg", "--log"], 1, "shows only positive values"),
                (["-o", "f.svg"], 1, "--what"),
                (["--what", "energy", "-o", "missing/f.svg"], 4, "missing/f.svg: cannot be written")):
            with self.subTest(arguments):
                process = self.plot(results, *arguments, status=status)
                self.assertIn(message, process.stderr)
                self.assertFalse((self.folder / "f.svg").exists())
        self.assertIn("no such directory", self.plot("nowhere", "--what", "energy", "-o", "f.svg", status=4).stderr)
        without = self.simulate("without", **{"output.fields_every": 0})
        self.assertIn("wrote no contact pressures",
                      self.plot(without, "--what", "pressure-map", "-o", "f.svg", status=1).stderr)
        ball = self.simulate("ball", DISC.parents[1] / "ball" / "ball.toml", **{"time.end": 0.001})
        self.assertIn("in the plane", self.plot(ball, "--what", "pressure-map", "-o", "f.svg", status=1).stderr)
        case = self.write("case.toml", DISC.read_text().split("[[probe]]")[0].replace(
            '"disc.msh"', f'"{DISC.parent}/disc.msh"'))
        blind = self.simulate("blind", case)
        self.assertIn("add a [[probe]]", self.plot(blind, "--what", "pressure", "-o", "f.svg", status=1).stderr)

    def test_names_are_shown_as_they_are(self):
        runs = [self.simulate("_under"), self.simulate("cost 5$ & 7$")]
        self.plot(*runs, "--what", "energy", "-o", "a.svg", "--title", "$\\frac{$ 1$")
        self.plot(*runs, "--what", "energy", "-o", "b.svg", "--label", "", "--label", "$\\foo{$")
        self.plot(runs[0], "--what", "energy", "-o", "c.svg")
        self.write("matplotlibrc", "axes.facecolor: red\n")
        self.plot(runs[0], "--what", "energy", "-o", "d.svg")
        self.assertEqual((self.folder / "c.svg").read_bytes(), (self.folder / "d.svg").read_bytes())

    def test_numbers_that_are_none(self):
        results = self.simulate("run")
        with h5py.File(results / "results.h5", "r+") as file:
            for frame in ("000005", "000006"):
                file[f"frames/{frame}/contact_pressure"][...] = numpy.nan
        self.plot(results, "--what", "pressure-map", "-o", "map.svg")

    def test_without_matplotlib(self):
        results = self.simulate("run")
        self.write("matplotlib.py", "raise ImportError('not here')")
        process = self.plot(results, "--what", "energy", "-o", "f.svg", status=4,
                            environment=os.environ | {"PYTHONPATH": str(self.folder)})
        self.assertIn("apt-get install python3-matplotlib", process.stderr)
        self.write("matplotlib.py", "raise KeyError('odd')")
        process = self.plot(results, "--what", "energy", "-o", "f.svg", status=4,
                            environment=os.environ | {"PYTHONPATH": str(self.folder)})
        self.assertIn("KeyError: 'odd'", process.stderr)

    def test_python_of_the_environment(self):
        results = self.simulate("run")
        named = self.write("python", f'#!/bin/sh\ntouch {self.folder}/used\nexec /usr/bin/python3 "$@"\n')
        named.chmod(0o755)
        self.plot(results, "--what", "energy", "-o", "f.svg", environment=os.environ | {"RICOCHET_PYTHON": str(named)})
        self.assertTrue((self.folder / "used").is_file())
        process = self.plot(results, "--what", "energy", "-o", "f.svg", status=4,
                            environment=os.environ | {"RICOCHET_PYTHON": str(self.folder / "none")})
        self.assertIn("which is not installed", process.stderr)
