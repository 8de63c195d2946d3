"""A ball falls on the border of an open surface, its centre on either side of it."""

from harness import History, TestCase

BALL = """SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 0.1};
Mesh.MeshSizeMax = 0.04;
Mesh.MeshSizeMin = 0.04;
Physical Volume("all") = {1};
Physical Surface("skin") = {1};
"""
PLATE = """solid plate
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 1 1 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 1 0
vertex 0 1 0
endloop
endfacet
endsolid plate
"""
CASE = """[mesh]
file = "ball.geo"
move = [0.5, 1.0, 0.13]
[[material]]
group = "all"
density = 1000.0
young = 1e5
poisson = 0.3
[obstacle.plate]
type = "surface"
file = "plate.stl"
[[contact]]
group = "skin"
obstacle = "plate"
[initial]
velocity = [0.0, 0.0, -1.0]
[time]
step = 1e-3
end = 0.15
[output]
fields_every = 0
"""


class OpenBorder(TestCase):
    def test_a_ball_runs_to_the_end_wherever_it_meets_the_border(self):
        (self.folder / "ball.geo").write_text(BALL)
        (self.folder / "plate.stl").write_text(PLATE)
        case = self.write("case.toml", CASE)
        sideways = []
        for across in (0.97, 1.0, 1.02, 1.05, 1.08):
            folder = self.simulate(case, f"at{across}", values={"mesh.move": f"[0.5, {across}, 0.13]"})
            history = History(folder / "history.csv")
            self.assertLess(max(history["total_energy"]), history["total_energy"][0] * (1.0 + 1e-12))
            self.assertGreater(max(history["active_contacts"]), 0)
            self.assertEqual(history["active_contacts"][-1], 0)
            sideways.append(history["momentum_y"][-1])
        # Above the plate the ball is thrown back, beyond the border it is turned off it.
        self.assertLess(abs(sideways[0]), 0.2 * sideways[3])
        self.assertGreater(min(sideways[2:]), 0.2)
