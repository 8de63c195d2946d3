"""obstacles.xdmf: the surfaces of the obstacles, at their positions at the time of each frame."""

import re
import xml.etree.ElementTree

import numpy

from harness import MESHES, TestCase, block_case, with_sphere
from results_frames import falling, frames


def surfaces(results, corners):
    """Returns (time, points, cells) of each frame."""
    for grid in xml.etree.ElementTree.parse(results / "obstacles.xdmf").iter("Grid"):
        if grid.get("GridType") == "Uniform":
            points = numpy.array(grid.find("Geometry/DataItem").text.split(), dtype=float).reshape(-1, 3)
            cells = numpy.array(grid.find("Topology/DataItem").text.split(), dtype=int).reshape(-1, corners)
            yield float(grid.find("Time").get("Value")), points, cells


class ObstacleFiles(TestCase):
    def test_a_plane(self):
        """Its surface reaches as far as the body."""
        text = block_case().replace("normal = [0.0, 1.0]", "normal = [0.0, 1.0]\nvelocity = [0.3, -0.05]")
        results = self.simulate(self.write("case.toml", text))
        side = (results / "results.xdmf").read_text()
        self.assertLess(side.index('xi:include href="obstacles.xdmf"'), side.index('Grid Name="body" GridType="Coll'))
        times = [at for at, _ in frames(results)[2]]
        shown = []
        for at, points, cells in surfaces(results, 2):
            shown.append(at)
            numpy.testing.assert_allclose(points[:, 1], -0.05 * at, rtol=1e-8, atol=1e-15)
            self.assertLess(points[:, 0].min(), 0.1)
            self.assertGreater(points[:, 0].max(), 1.5)
            self.assertFalse(points[:, 2].any())
            self.assertEqual(cells.tolist(), [[0, 1]])
        self.assertEqual(shown, times)

    def test_a_sphere_in_space(self):
        """A surface of quadrilaterals that share their points, the same in every frame except for its position."""
        centre, radius, velocity = [0.7, 0.5, -1.5], 1.2, [0.5, -0.25, 2.0]
        text = falling(MESHES / "tetrahedron_o1_msh41_binary.msh", lowest=[1.3, 0.1, 0.0], highest=[0.3, 1.4, 1.2])
        results = self.simulate(self.write("case.toml", with_sphere(text, centre, radius, velocity)))
        shown = list(surfaces(results, 4))
        self.assertEqual(len(shown), 31)
        _, first, cells = shown[0]
        self.assertEqual(sorted(set(cells.ravel())), list(range(len(first))))
        self.assertLess(len(first), len(cells) + 2)
        for at, points, now in shown:
            moved = numpy.array(velocity) * at
            numpy.testing.assert_allclose(points, first + moved, rtol=0, atol=1e-8)
            numpy.testing.assert_allclose(numpy.linalg.norm(points - centre - moved, axis=1), radius, rtol=1e-8)
            self.assertEqual(now.tolist(), cells.tolist())
        self.assertLess((results / "obstacles.xdmf").stat().st_size / len(shown), 80_000)

    def test_a_surface_of_many_triangles_keeps_its_shape(self):
        """A plate with a bump, 9,800 triangles: a picture of 6,000 covers all of it, and lies on it."""
        count, half = 70, 1.5
        steps = numpy.linspace(-half, half, count + 1)

        def height(x, y):
            return 0.3 * numpy.exp(-(x * x + y * y) / 0.1)

        def corner(i, j):
            return f"vertex {steps[i]:.9g} {steps[j]:.9g} {height(steps[i], steps[j]):.9g}\n"

        triangles = []
        for i in range(count):
            for j in range(count):
                corners = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
                triangles += [corners[0] + corners[1] + corners[2], corners[0] + corners[2] + corners[3]]
        self.write("plate.stl", "solid plate\n" + "".join(
            f"facet normal 0 0 0\nouter loop\n{triangle}endloop\nendfacet\n" for triangle in triangles) + "endsolid plate\n")
        text = falling(MESHES / "tetrahedron_o1_msh41_binary.msh", lowest=[1.3, 0.1, 0.0], highest=[0.3, 1.4, 1.2])
        text = re.sub(r'type = "plane"\npoint = .*\nnormal = .*\n', 'type = "surface"\nfile = "plate.stl"\n', text)
        results = self.simulate(self.write("case.toml", text), values={"mesh.move": "[-0.5, -0.5, 0.5]", "time.end": 0.002})
        _, points, cells = next(surfaces(results, 4))
        self.assertLessEqual(len(cells), 6000)
        self.assertGreater(len(cells), 4000)  # no coarser than necessary
        a, b, c = (points[cells[:, k]] for k in range(3))
        covered = 0.5 * numpy.cross((b - a)[:, :2], (c - a)[:, :2])
        self.assertAlmostEqual(covered.sum() / (2 * half) ** 2, 1.0, delta=0.05)  # means of corners draw its rim inwards
        self.assertGreater(covered.min(), -1e-12)  # no triangle is flipped
        middle = (a + b + c) / 3
        self.assertLess(numpy.abs(middle[:, 2] - height(middle[:, 0], middle[:, 1])).max(), 0.02)
