"""Initial positions of bodies: ordered rotations, on an obstacle, dropped from a height. Positions and velocities are
closed forms."""

import math

import meshio
import numpy

from harness import MESHES, History, TestCase, run
from results_frames import frames

MESH = MESHES / "tetrahedron_o1_msh41_binary.msh"
REST = """[[material]]
group = "all"
density = 3.0
young = 1e4
poisson = 0.3
[time]
step = 1e-3
end = 1e-3
[output]
fields_every = 1
"""
PLANE_NORMAL = numpy.array([1.0, 2.0, 3.0]) / math.sqrt(14.0)


def rotation(axis, degrees):
    """Rodrigues' formula."""
    x, y, z = numpy.array(axis) / numpy.linalg.norm(axis)
    across = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = math.radians(degrees)
    return numpy.eye(3) + math.sin(angle) * across + (1 - math.cos(angle)) * across @ across


class Placement(TestCase):
    def place(self, keys, rest="", name="case", status=0, mesh=MESH):
        """Returns the nodes at the start of the run, or the message if it is refused."""
        case = self.write(f"{name}.toml", f'[part.body]\nfile = "{mesh}"\n{keys}\n{rest}{REST}')
        process = self.expect_status(status, run("run", case, "-o", self.folder / name, "--quiet"))
        return frames(self.folder / name)[0] if status == 0 else process.stderr

    def test_turns_in_their_order(self):
        as_it_is = self.place("", name="plain")
        found = self.place("turn = [{ angle = 50, axis = [1, 0, 1] }, { angle = -70, axis = [0, 1, 0], about = [2, 1, 0] }]\n"
                           "move = [0, 0, 5]")
        centre = numpy.array([2.0, 1.0, 0.0])
        wanted = as_it_is @ rotation([1, 0, 1], 50).T
        wanted = (wanted - centre) @ rotation([0, 1, 0], -70).T + centre + [0, 0, 5]
        numpy.testing.assert_allclose(found, wanted, rtol=0, atol=1e-12)

    def test_on_a_plane_along_its_normal(self):
        plane = f'[obstacle.ramp]\ntype = "plane"\npoint = [0.3, 0.1, -0.4]\nnormal = {PLANE_NORMAL.tolist()}\n'
        moved = self.place("move = [3, 0, 0]", name="plain")
        for name, gap in (("touching", 0.0), ("above", 0.125)):
            found = self.place(f'move = [3, 0, 0]\nrest_on = "ramp"\nrest_gap = {gap}', plane + "[load]\ngravity = [0, 0, -9.81]\n",
                               name)
            gaps = (found - [0.3, 0.1, -0.4]) @ PLANE_NORMAL
            self.assertAlmostEqual(gaps.min(), gap, delta=1e-14)
            # A translation along the normal, for any direction of gravity.
            way = found - moved
            numpy.testing.assert_allclose(way - (way @ PLANE_NORMAL)[:, None] * PLANE_NORMAL, 0, atol=1e-14)
            numpy.testing.assert_allclose(way - way[0], 0, atol=1e-14)

    def test_on_a_ball_along_gravity_from_wherever_it_is(self):
        centre = numpy.array([0.6, 0.5, -3.0])
        ball = f'[obstacle.ball]\ntype = "sphere"\ncentre = {centre.tolist()}\nradius = 1.5\n[load]\ngravity = [0, 0, -2]\n'
        plain = self.place("", name="plain")
        places = []
        for name, height in (("high", 4.0), ("inside", -2.5)):  # it falls, or is lifted
            found = self.place(f'move = [0, 0, {height}]\nrest_on = "ball"\nrest_gap = 0.01', ball, name)
            gaps = numpy.linalg.norm(found - centre, axis=1) - 1.5
            self.assertAlmostEqual(gaps.min(), 0.01, delta=1e-13)
            numpy.testing.assert_allclose((found - plain)[:, :2], 0, atol=1e-14)
            places.append(found)
        numpy.testing.assert_allclose(places[0], places[1], rtol=0, atol=1e-12)
        # Without gravity along the normal at the nearest node: the line from the ball's centre.
        start = plain + [0, 0, 4.0]
        nearest = start[numpy.linalg.norm(start - centre, axis=1).argmin()]
        found = self.place('move = [0, 0, 4.0]\nrest_on = "ball"', ball.split("[load]")[0], "free")
        self.assertAlmostEqual(numpy.linalg.norm(numpy.cross((found - start)[0], nearest - centre)), 0, delta=1e-12)
        self.assertAlmostEqual(numpy.linalg.norm(found - centre, axis=1).min(), 1.5, delta=1e-13)

    def test_what_passes_by_is_refused(self):
        ball = '[obstacle.ball]\ntype = "sphere"\ncentre = [0, 0, 0]\nradius = 1\n[load]\ngravity = [0, 0, -2]\n'
        message = self.place('move = [10, 0, 10]\nrest_on = "ball"', ball, status=2)
        self.assertRegex(message, r'case.toml:4:11: .*does not come to rest on obstacle "ball".*use "move"')

    def test_dropped_from_a_height(self):
        """Kinetic energy m g H, and momentum m sqrt(2 g H) along gravity."""
        gravity, height = numpy.array([3.0, 0.0, -4.0]), 0.7
        self.place(f"drop_height = {height}", f"[load]\ngravity = {gravity.tolist()}\n", "drop")
        history = History(self.folder / "drop" / "history.csv")
        mesh = meshio.read(MESH)
        corners = mesh.points[mesh.cells_dict["tetra"]]
        mass = 3.0 * sum(abs(numpy.linalg.det(cell[1:] - cell[0])) for cell in corners) / 6.0
        self.assertAlmostEqual(history["kinetic_energy"][0] / (mass * 5.0 * height), 1.0, delta=1e-12)
        for axis, part in (("x", 0.6), ("z", -0.8)):
            self.assertAlmostEqual(history[f"momentum_{axis}"][0] / (part * mass * math.sqrt(2 * 5.0 * height)), 1.0, delta=1e-12)

    def test_the_whole_mesh(self):
        case = self.write("whole.toml", f'[mesh]\nfile = "{MESH}"\nrest_on = "floor"\nrest_gap = 0.2\ndrop_height = 1.0\n'
                          '[obstacle.floor]\ntype = "plane"\npoint = [0, 0, -7]\nnormal = [0, 0, 1]\n[load]\ngravity = [0, 0, -2]\n'
                          + REST)
        process = self.expect_status(0, run("validate", case))
        self.assertIn('0.2 above "floor", dropped from a height of 1', process.stdout)
        self.assertIn("the mesh is 0.2 away from obstacle \"floor\"", process.stdout)
        results = self.simulate(case)
        self.assertAlmostEqual(frames(results)[0][:, 2].min(), -6.8, delta=1e-14)
        history = History(results / "history.csv")
        self.assertAlmostEqual(history["momentum_z"][0] ** 2 / (2 * history["kinetic_energy"][0]), 3.0 * self.volume(), delta=1e-9)

    def volume(self):
        mesh = meshio.read(MESH)
        return sum(abs(numpy.linalg.det(cell[1:] - cell[0])) for cell in mesh.points[mesh.cells_dict["tetra"]]) / 6.0
