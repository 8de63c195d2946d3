"""Steps at finite strain that iterations with a kept factor do not solve: rubber pressed hard, a corner that slides over
kinks, a tip the size of a cell."""

import math
import re
import statistics

from harness import History, TestCase, between_plates, run

RING = """SetFactory("OpenCASCADE");
Disk(1) = {0, 2.5, 0, 2.5};
Physical Surface("ring") = {1};
Physical Curve("skin") = {1};
Mesh.MeshSizeMax = 0.7;
Mesh.MeshSizeMin = 0.7;
"""
SQUEEZED = """[mesh]
file = "ring.geo"
plane = "strain"
degree = 2
[[material]]
group = "ring"
density = 1.1e-9
law = "neo-hookean"
young = 3.0
poisson = 0.49
""" + between_plates("-1.5*min(t/1.65,1)") + """[time]
step = 0.03
end = 1.65
[[probe]]
name = "top"
contact = 1
[output]
fields_every = 0
"""
TRACK = """Point(1)={0,0,0}; Point(2)={0.8,0,0}; Point(3)={1,0,0}; Point(4)={1.9,0,0};
Point(5)={1.9,.3,0}; Point(6)={1,.3,0}; Point(7)={.8,.25,0}; Point(8)={0,.25,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,5}; Line(5)={5,6}; Line(6)={6,7}; Line(7)={7,8}; Line(8)={8,1};
Line(9)={2,7}; Line(10)={3,6};
Curve Loop(1)={1,9,7,8}; Plane Surface(1)={1}; Curve Loop(2)={2,10,6,-9}; Plane Surface(2)={2};
Curve Loop(3)={3,4,5,-10}; Plane Surface(3)={3};
Transfinite Curve{1,7}=10; Transfinite Curve{2,6}=4; Transfinite Curve{3,5}=7; Transfinite Curve{8,9,10,4}=4;
Transfinite Surface{1,2,3}; Recombine Surface{1,2,3};
Physical Curve("foot")={1,2,3}; Physical Curve("track")={5,6,7}; Physical Surface("base")={1,2,3};
"""
BLOCK = """Point(1)={0,0.25,0}; Point(2)={0.45,0.25,0}; Point(3)={0.45,0.45,0}; Point(4)={0,0.45,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1};
Transfinite Curve{1,3}=9; Transfinite Curve{2,4}=5; Transfinite Surface{1}; Recombine Surface{1};
Physical Curve("bottom")={1}; Physical Curve("top")={3}; Physical Surface("block")={1};
"""
RAMP = """[mesh]
plane = "strain"
[part.block]
file = "block.geo"
[part.base]
file = "track.geo"
[[material]]
group = "base.base"
law = "neo-hookean"
density = 7850.0
young = 21.0e9
poisson = 0.3
[[material]]
group = "block.block"
law = "neo-hookean"
density = 7850.0
young = 1.0e9
poisson = 0.47
[[contact]]
group = "block.bottom"
against = "base.track"
sliding = "large"
[[support]]
group = "base.foot"
components = ["x", "y"]
[[support]]
group = "block.top"
components = ["y"]
value = "-0.1*min(t, 0.01)"
[[support]]
group = "block.top"
components = ["x"]
value = "max(t - 0.01, 0)"
[time]
step = 5.0e-3
end = 0.65
[[probe]]
name = "force"
contact = 0
[output]
fields_every = 0
"""
TIP_BLOCK = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.7, 0.35};
Mesh.MeshSizeMax = 0.05; Mesh.MeshSizeMin = 0.05;
Physical Surface("block") = {1};
Physical Curve("foot") = {1}; Physical Curve("top") = {3};
"""
TIP = """[mesh]
file = "tip.geo"
plane = "strain"
[[material]]
group = "block"
density = 1.0
law = "neo-hookean"
young = 1000.0
poisson = 0.3
[obstacle.tip]
type = "sphere"
centre = [0.36, 0.4]
radius = 0.05
motion = ["0", "-0.15*t/0.6"]
[[contact]]
group = "top"
obstacle = "tip"
[[support]]
group = "foot"
components = ["x", "y"]
[time]
step = 0.02
end = 0.6
[[probe]]
name = "tip"
contact = 0
[output]
fields_every = 0
"""


class HardSteps(TestCase):
    def solved(self, text, geometries, values=(), name="case"):
        for file, geometry in geometries.items():
            (self.folder / file).write_text(geometry)
        folder = self.simulate(self.write(f"{name}.toml", text), name, values=dict(values))
        history = History(folder / "history.csv")
        size = max(abs(value) for name in ("kinetic_energy", "elastic_energy") for value in history[name])
        self.assertLess(max(map(abs, history["energy_residual"])), 1e-9 * size)
        self.assertGreater(min(history["numerical_dissipation"]), -1e-12 * size)
        return history

    def test_a_ring_squeezed_by_30_percent(self):
        """Nearly incompressible, of second order, with friction, in steps of 1300 times the time of a wave."""
        one = self.solved(SQUEEZED, {"ring.geo": RING})
        rounds = one["newton_rounds"][1:]
        self.assertLess(statistics.mean(rounds), 15.0)
        self.assertLess(max(rounds), 60)
        half = self.solved(SQUEEZED, {"ring.geo": RING}, {"time.step": 0.015}, "half")
        self.assertLess(abs(half["top.force_y"][-1] / one["top.force_y"][-1] - 1.0), 0.01)

    def test_the_exact_tangent_converges_quadratically(self):
        (self.folder / "ring.geo").write_text(RING)
        case = self.write("ring.toml", SQUEEZED)
        log = self.expect_status(0, run("run", case, "-o", self.folder / "log", "--log-level", "debug", "--set",
                                        "time.end=1.2")).stderr
        orders = []
        for part in log.split("exact tangent: begins")[1:]:
            own = re.split(r"debug: (?:step|kept factor|exact tangent)", part)[0]
            corrections = [float(value) for value in re.findall(r"Newton: iteration \d+, correction (\S+) of", own)]
            small = next((i for i, value in enumerate(corrections) if value < 1e-7), 0)  # the ones after it are rounding
            if small >= 2:
                first, second, third = corrections[small - 2:small + 1]
                orders.append(math.log(third / second) / math.log(second / first))
        self.assertGreater(len(orders), 3)
        self.assertGreater(statistics.median(orders), 1.8)

    def test_a_corner_over_two_kinks(self):
        """A block pressed on a track climbs a ramp: its corner passes a concave and a convex kink."""
        history = self.solved(RAMP, {"track.geo": TRACK, "block.geo": BLOCK})
        self.assertLess(max(history["unsettled_gap"]), 1e-9)
        self.assertLess(statistics.mean(history["newton_rounds"][1:]), 20.0)
        self.assertLess(max(history["contact_work"]), 1e-9 * max(history["elastic_energy"]))
        forces = dict(zip(history["time"], history["force.force_y"]))
        # Of cells half as large at half the step.
        for time, right in ((0.45, 1.439e7), (0.55, 5.271e7), (0.65, 9.830e7)):
            found = min(forces, key=lambda at: abs(at - time))
            self.assertLess(abs(forces[found] / right - 1.0), 0.03, time)

    def test_a_tip_the_size_of_a_cell(self):
        history = self.solved(TIP, {"tip.geo": TIP_BLOCK})
        self.assertLess(statistics.mean(history["newton_rounds"][1:]), 25.0)
