"""`ricochet plot --what animation`: pictures show the body at its position in the results; files, formats, refusals."""

import os
import re
import xml.etree.ElementTree

import meshio
import numpy
from PIL import Image

from harness import DISC, SOURCE, TestCase, run

SVG = "{http://www.w3.org/2000/svg}"
AXISYMMETRIC = SOURCE / "cases/ball-axisymmetric/ball-axisymmetric.toml"


def triangles(path):
    """Returns the polygons with three corners in an SVG: count x 3 x 2, upwards."""
    result = []
    for element in xml.etree.ElementTree.parse(path).iter(f"{SVG}path"):
        points = re.findall(r"[ML] (-?[\d.]+) (-?[\d.]+)", element.get("d", ""))
        if len(points) in (3, 4) and "clip-path" in element.attrib and not re.search("fill: (none|#ededed)", element.get("style", "")):
            result.append(points[:3])
    corners = numpy.array([points for points in result if len(points) == 3], dtype=float)
    return corners * [1, -1]


def extents(points):
    return points.reshape(-1, 2).max(axis=0) - points.reshape(-1, 2).min(axis=0)


class Animation(TestCase):
    def plot(self, *arguments, status=0, environment=None):
        process = run("plot", *arguments, directory=self.folder, environment=environment)
        self.assertEqual(process.returncode, status, process.stderr)
        return process

    def disc(self, name="disc", **values):
        return self.simulate(DISC, name, {"time.end": 0.02, "output.fields_every": 40, "time.scheme": "reduced-kane"} | values,
                             ("--quiet", "--log-level", "error"))

    def test_a_picture_shows_the_body_where_it_is(self):
        results = self.disc()
        self.plot(results, "--what", "animation", "--at", "0.0199", "-o", "frame.svg")
        with meshio.xdmf.TimeSeriesReader(results / "results.xdmf") as reader:
            points, cells = reader.read_points_cells()
            time, fields, _ = reader.read_data(reader.num_steps - 1)
        self.assertEqual(time, 0.02)
        places = (points + fields["displacement"])[:, :2][cells[0].data[:, :3]]
        drawn = triangles(self.folder / "frame.svg")
        self.assertEqual(drawn.shape, places.shape)
        scale, high = extents(drawn) / extents(places)
        self.assertAlmostEqual(high / scale, 1.0, delta=1e-4)  # as wide as it is high
        offset = drawn.reshape(-1, 2).min(axis=0) - scale * places.reshape(-1, 2).min(axis=0)
        # Every triangle is present, in hundredths of a point; their order is up to the surface.
        wanted, found = ((scale * places + offset).mean(axis=1), drawn.mean(axis=1))
        distances = numpy.abs(wanted[:, None, :] - found[None, :, :]).max(axis=2)
        self.assertLess(distances.min(axis=0).max(), 1e-2)
        self.assertLess(distances.min(axis=1).max(), 1e-2)
        self.assertIn("<!-- t = 0.02 -->", (self.folder / "frame.svg").read_text())

    def test_an_animation_has_a_picture_of_each_frame(self):
        results = self.disc()
        for name in ("one.gif", "two.gif"):
            self.plot(results, "--what", "animation", "-o", name, "--size", "8x7", "--title", "A disc")
        self.assertEqual((self.folder / "one.gif").read_bytes(), (self.folder / "two.gif").read_bytes())
        with Image.open(self.folder / "one.gif") as image:
            self.assertEqual(image.n_frames, 6)
            self.assertLess(abs(image.width / image.height - 8 / 7), 0.02)
            pictures = []
            for frame in range(image.n_frames):
                image.seek(frame)
                pictures.append(numpy.asarray(image.convert("RGB"), dtype=int))
        # It falls: its middle is lower in each picture than in the one before. Everything except the body is black,
        # grey or white.
        coloured = [numpy.ptp(picture[:, :int(0.7 * picture.shape[1])], axis=2) > 40 for picture in pictures]
        middles = [numpy.nonzero(picture)[0].mean() for picture in coloured]
        self.assertEqual(middles, sorted(middles))
        self.assertGreater(middles[-1], middles[0] + 2)
        part = self.plot(results, "--what", "animation", "-o", "part.gif", "--time", "0.005:0.015", "--field", "velocity")
        self.assertEqual(part.stdout, "part.gif\n")
        with Image.open(self.folder / "part.gif") as image:
            self.assertEqual(image.n_frames, 2)

    def test_axisymmetric_bodies_are_whole(self):
        results = self.simulate(AXISYMMETRIC, "ball", {"time.end": 1e-3, "output.fields_every": 20}, ("--quiet", "--log-level", "error"))
        self.plot(results, "--what", "animation", "--at", "0", "-o", "whole.svg")
        self.plot(results, "--what", "animation", "--at", "0", "-o", "half.svg", "--half")
        whole, half = triangles(self.folder / "whole.svg"), triangles(self.folder / "half.svg")
        self.assertEqual(len(whole), 2 * len(half))
        middle = whole[..., 0].min() + whole[..., 0].max()
        image = whole[len(half):] * [-1, 1] + [middle, 0]
        numpy.testing.assert_allclose(image, whole[:len(half)], atol=2e-2)
        wide, high = extents(whole)
        self.assertAlmostEqual(wide / high, 1.0, delta=0.02)  # a ball

    def test_a_film_needs_a_program(self):
        results = self.disc()
        bare = os.environ | {"PATH": str(self.folder), "RICOCHET_PYTHON": "/usr/bin/python3"}
        message = self.plot(results, "--what", "animation", "-o", "run.mp4", status=4, environment=bare).stderr
        self.assertIn("apt-get install ffmpeg, or write a .gif", message)
        self.assertFalse((self.folder / "run.mp4").exists())
        # A stand-in that stores its input: six pictures of four bytes for each point.
        self.write("ffmpeg", '#!/bin/sh\nfor last; do :; done\nexec /bin/cat > "$last"\n').chmod(0o755)
        self.plot(results, "--what", "animation", "-o", "run.mp4", "--size", "8x7", environment=bare)
        self.assertEqual((self.folder / "run.mp4").stat().st_size, 6 * 316 * 276 * 4)

    def test_wrong_use(self):
        results = self.disc()
        for arguments, message in (
                (("-o", "a.png"), "an animation must be a .gif or .mp4 file; with --at T a .png, .svg or .pdf file of one frame"),
                (("-o", "a.gif", "--at", "0.01"), "a picture must be a .png, .svg or .pdf file"),
                (("-o", "a.png", "--at", "7"), "--at 7: the frames of"),
                (("-o", "a.gif", "--field", "von_miss"), 'did you mean "von_mises"?'),
                (("-o", "a.gif", "--field", "stress"), "has no such field"),
                (("-o", "a.gif", "--what", "energy"), "an animation shows one run and nothing else"),
                (("-o", "a.gif", "--time", "0.001:0.002"), "there are fewer than two frames in this time interval"),
                ((results, "-o", "a.gif"), "name one directory")):
            process = run("plot", results, "--what", "animation", *arguments, directory=self.folder)
            self.assertNotEqual(process.returncode, 0)
            self.assertIn(message, process.stderr)
        process = self.plot(results, "--what", "energy", "-o", "a.svg", "--zoom", status=1)
        self.assertIn("--half require --what animation", process.stderr)
        blind = self.disc("blind", **{"output.fields_every": 0})
        process = run("plot", blind, "--what", "animation", "-o", "a.gif", directory=self.folder)
        self.assertIn("wrote no fields", process.stderr)
