"""The cases from which the problems of the benchmark are exported: rubber bodies of at most 20 cm that strike, are
pressed, are dragged, and are pushed over rough planes. Units: m, kg, s."""

from dataclasses import dataclass, field

DENSITY, YOUNG, POISSON = 1100.0, 1.0e7, 0.3
WAVE_SPEED = 110.6  # of pressure waves, sqrt(E (1 - nu) / (rho (1 + nu) (1 - 2 nu)))

BLOCK_2D = """// Squares on a rectangle, 0.2 m wide and 0.1 m high, with {n} cells along its base.
Point(1) = {{-0.1, 0, 0}}; Point(2) = {{0.1, 0, 0}}; Point(3) = {{0.1, 0.1, 0}}; Point(4) = {{-0.1, 0.1, 0}};
Line(1) = {{1, 2}}; Line(2) = {{2, 3}}; Line(3) = {{3, 4}}; Line(4) = {{4, 1}};
Curve Loop(1) = {{1, 2, 3, 4}}; Plane Surface(1) = {{1}};
Transfinite Curve {{1, 3}} = {n} + 1; Transfinite Curve {{2, 4}} = {m} + 1;
Transfinite Surface {{1}}; Recombine Surface {{1}};
Physical Surface("body") = {{1}}; Physical Curve("base") = {{1}}; Physical Curve("top") = {{3}};
"""
BLOCK_3D = """// Bricks in a block of 0.2 m x 0.2 m x 0.1 m, {n} x {n} cells on its base.
Point(1) = {{-0.1, -0.1, 0}}; Point(2) = {{0.1, -0.1, 0}}; Point(3) = {{0.1, 0.1, 0}}; Point(4) = {{-0.1, 0.1, 0}};
Line(1) = {{1, 2}}; Line(2) = {{2, 3}}; Line(3) = {{3, 4}}; Line(4) = {{4, 1}};
Curve Loop(1) = {{1, 2, 3, 4}}; Plane Surface(1) = {{1}};
Transfinite Curve {{1, 2, 3, 4}} = {n} + 1; Transfinite Surface {{1}}; Recombine Surface {{1}};
out[] = Extrude {{0, 0, 0.1}} {{ Surface{{1}}; Layers{{{m}}}; Recombine; }};
Physical Volume("body") = {{out[1]}}; Physical Surface("base") = {{1}}; Physical Surface("top") = {{out[0]}};
"""
GROOVE = """// A disc of radius 2 cm that lies in a groove of two planes at 45 degrees: two arcs that may touch, "left" and "right".
SetFactory("OpenCASCADE");
r = 0.02; size = {size};
Mesh.MeshSizeMin = size; Mesh.MeshSizeMax = 8 * size; Mesh.MeshSizeExtendFromBoundary = 1;
centre = newp; Point(centre) = {{0, 0, 0, 8 * size}};
p[] = {{}}; angles[] = {{-153, -117, -63, -27}};
For k In {{0:3}}
  a = angles[k] * Pi / 180; q = newp; Point(q) = {{r * Cos(a), r * Sin(a), 0, size}}; p[] += q;
EndFor
top = newp; Point(top) = {{0, r, 0, 8 * size}};
Circle(1) = {{p[0], centre, p[1]}}; Circle(2) = {{p[1], centre, p[2]}}; Circle(3) = {{p[2], centre, p[3]}};
Circle(4) = {{p[3], centre, top}}; Circle(5) = {{top, centre, p[0]}};
Curve Loop(1) = {{1, 2, 3, 4, 5}}; Plane Surface(1) = {{1}};
Physical Surface("body") = {{1}}; Physical Curve("left") = {{1}}; Physical Curve("right") = {{3}}; Physical Curve("top") = {{4, 5}};
"""


@dataclass
class Case:
    name: str
    dimension: int
    mesh: str  # key of MESHES
    time: dict
    steps: list  # steps exported for the set
    friction: float = 0.3
    mass: str = "equivalent"
    degree: int = 1
    multipliers: str = "nodal"
    contacts: list = field(default_factory=list)  # (group, obstacle); default: base or lower on the floor
    top: list = None  # traction on "top"
    velocity: list = None  # initial velocity
    displacement: str = None  # "static"
    gravity: list = None
    belt: list = None  # velocity of the floor
    spin: float = 0.0  # of the floor about its normal
    sequence: tuple = None  # of consecutive steps
    rescaled: dict = field(default_factory=dict)  # suffix: (factor of q, factor of W)


# Meshes: a .geo file made from a template, or one of the cases.
MESHES = {
    "block-20": (BLOCK_2D, 2, {"n": 20, "m": 10}),
    "block-60": (BLOCK_2D, 2, {"n": 60, "m": 30}),
    "block-200": (BLOCK_2D, 2, {"n": 200, "m": 60}),
    "block-500": (BLOCK_2D, 2, {"n": 500, "m": 60}),
    "block-1000": (BLOCK_2D, 2, {"n": 1000, "m": 30}),
    "groove": (GROOVE, 2, {"size": 0.0002}),
    "box-5": (BLOCK_3D, 3, {"n": 5, "m": 3}),
    "box-11": (BLOCK_3D, 3, {"n": 11, "m": 6}),
    "box-15": (BLOCK_3D, 3, {"n": 15, "m": 7}),
    "box-19": (BLOCK_3D, 3, {"n": 19, "m": 8}),
    "box-27": (BLOCK_3D, 3, {"n": 27, "m": 7}),
    "box-44": (BLOCK_3D, 3, {"n": 44, "m": 4}),
    "disc": ("cases/oblique/disc.geo", 2, {"fine": 0.0004}),
    "disc-fine": ("cases/oblique/disc.geo", 2, {"fine": 0.00008}),
    "ball-coarse": ("cases/ball/ball.geo", 3, {"fine": 0.004}),
    "ball": ("cases/ball/ball.geo", 3, {"fine": 0.0018}),
    "ball-fine": ("cases/ball/ball.geo", 3, {"fine": 0.0011}),
}

SHORT = 0.1 / WAVE_SPEED / 60  # fraction of the transit time over the blocks' height
TRANSIT = 0.1 / WAVE_SPEED


def newmark(step, **more):
    return {"scheme": "newmark", "preset": "trapezoidal", "step": step, **more}


def damped(step):
    """Time section for steps of many transit times."""
    return {"scheme": "newmark", "beta": 0.6, "gamma": 1.0, "step": step}


def pushed_2d(name, mesh, friction, time, steps, push=1.4, **more):
    """A block pressed from above, more strongly on one side, and pushed with increasing force until it slides."""
    duration = time["step"] * max(max(steps), (more.get("sequence") or (0, 0))[1])
    traction = [f"{push * max(friction, 0.05)}*1e4*t/{duration!r}", "-1e4*(1 + 0.7*sin(25*x))"]
    return Case(name, 2, mesh, time, steps, friction, top=traction, displacement="static", **more)


def pushed_3d(name, mesh, friction, time, steps, push=1.4, **more):
    duration = time["step"] * max(max(steps), (more.get("sequence") or (0, 0))[1])
    shear = f"{push * max(friction, 0.05)}*1e4*t/{duration!r}"
    traction = [f"{shear}*(1 + 5*y)", f"-0.6*{shear}*(1 + 8*x)", "-1e4*(1 + 0.7*sin(25*x)*cos(15*y))"]
    return Case(name, 3, mesh, time, steps, friction, top=traction, displacement="static", **more)


def thrown_disc(name, friction, time, steps, mesh="disc", **more):
    return Case(name, 2, mesh, time, steps, friction, contacts=[("lower", "floor")], velocity=["1.5", "-1.5"], **more)


def thrown_ball(name, friction, time, steps, mesh="ball", velocity=("4", "3", "-5"), **more):
    return Case(name, 3, mesh, time, steps, friction, contacts=[("lower", "floor")], velocity=list(velocity), **more)


def struck_block(name, mesh, dimension, friction, time, steps, **more):
    """A block that flies into the floor, spinning and bent: contact spreads, opens and closes."""
    if dimension == 2:
        velocity = ["1 - 4*y", "-1 + 8*x"]
    else:
        velocity = ["1 - 5*y", "0.5 + 5*x", "-1 + 6*x - 4*y"]
    return Case(name, dimension, mesh, time, steps, friction, velocity=velocity, **more)


UNITS = {"in-millimetres": (1e3, 1e3), "in-meganewtons": (1.0, 1e6)}

CASES = [
    # Two dimensions.
    pushed_2d("2d-block21-pushed-F0.3-short", "block-20", 0.3, newmark(SHORT), [50, 90]),
    pushed_2d("2d-block21-pushed-F1-long", "block-20", 1.0, damped(5 * TRANSIT), [4, 10]),
    struck_block("2d-block61-struck-F0-short", "block-60", 2, 0.0, newmark(SHORT), [60, 200]),
    struck_block("2d-block61-struck-F0.3-short", "block-60", 2, 0.3, newmark(SHORT), [25, 60]),
    struck_block("2d-block61-struck-F0.6-klr", "block-60", 2, 0.6, {"scheme": "klr-conserving", "step": SHORT}, [15, 60],
                 mass="consistent"),
    struck_block("2d-block61-struck-F1-midpoint", "block-60", 2, 1.0, {"scheme": "midpoint", "step": SHORT}, [25, 60],
                 mass="consistent"),
    pushed_2d("2d-block61-pushed-F0.3-long", "block-60", 0.3, damped(3 * TRANSIT), [5, 15], rescaled=UNITS),
    pushed_2d("2d-block61-pushed-F0.6-very-long", "block-60", 0.6, damped(50 * TRANSIT), [5, 15]),
    pushed_2d("2d-block201-pushed-F0.5-long", "block-200", 0.5, damped(1.5 * TRANSIT), [4, 14], rescaled=UNITS,
              sequence=(11, 60)),
    pushed_2d("2d-block201-pushed-F0.8-consistent-long", "block-200", 0.8, damped(1.5 * TRANSIT), [10, 20], mass="consistent"),
    struck_block("2d-block201-struck-F0.3-short", "block-200", 2, 0.3, newmark(SHORT / 3), [40, 120], sequence=(61, 110)),
    pushed_2d("2d-block501-pushed-F0.3-long", "block-500", 0.3, damped(0.7 * TRANSIT), [6, 12]),
    struck_block("2d-block501-struck-F0.4-short", "block-500", 2, 0.4, newmark(SHORT / 6), [80]),
    pushed_2d("2d-block1001-pushed-F0.6-long", "block-1000", 0.6, damped(0.5 * TRANSIT), [8]),
    thrown_disc("2d-disc37-thrown-F0-short", 0.0, newmark(2e-6), [500]),
    thrown_disc("2d-disc37-thrown-F0.1-short", 0.1, newmark(2e-6), [350, 500]),
    thrown_disc("2d-disc37-thrown-F0.6-short", 0.6, newmark(2e-6), [350, 500], rescaled={"in-millimetres": (1e3, 1e3)}),
    thrown_disc("2d-disc37-thrown-F0.3-p1-degree2", 0.3, newmark(5e-6), [150, 200], degree=2, multipliers="p1"),
    thrown_disc("2d-disc177-thrown-F0.3-short", 0.3, newmark(4e-6), [150, 250, 310], mesh="disc-fine", sequence=(201, 250)),
    thrown_disc("2d-disc177-thrown-F0.3-half", 0.3, {"scheme": "newmark", "preset": "textbook-half", "step": 2e-5}, [30, 60],
                mesh="disc-fine"),
    Case("2d-groove-pressed-F0.4-long", 2, "groove", damped(5e-4), [3, 10], 0.4,
         contacts=[("left", "left"), ("right", "right")], top=["600*sin(400*t)", "-4e4"]),
    Case("2d-groove-pressed-F0.9-short", 2, "groove", newmark(1e-5), [60, 150], 0.9, sequence=(101, 150),
         contacts=[("left", "left"), ("right", "right")], top=["3e3", "-4e4"]),
    # Three dimensions.
    struck_block("3d-box36-struck-F0.3-short", "box-5", 3, 0.3, newmark(SHORT * 4), [6, 15]),
    pushed_3d("3d-box36-pushed-F0.8-long", "box-5", 0.8, damped(15 * TRANSIT), [4, 12], rescaled=UNITS),
    pushed_3d("3d-box144-pushed-F0-long", "box-11", 0.0, damped(10 * TRANSIT), [5]),
    pushed_3d("3d-box144-pushed-F0.3-long", "box-11", 0.3, damped(8 * TRANSIT), [4, 12], rescaled=UNITS, sequence=(11, 60)),
    pushed_3d("3d-box144-pushed-F0.6-very-long", "box-11", 0.6, damped(50 * TRANSIT), [4, 12]),
    pushed_3d("3d-box144-pushed-F1-consistent-short", "box-11", 1.0, newmark(SHORT * 3), [20, 60], mass="consistent"),
    struck_block("3d-box144-struck-F0.2-midpoint", "box-11", 3, 0.2, {"scheme": "midpoint", "step": SHORT * 3}, [8, 20],
                 mass="consistent"),
    struck_block("3d-box144-struck-F0.6-klr", "box-11", 3, 0.6, {"scheme": "klr-conserving", "step": SHORT * 3}, [8, 20],
                 mass="consistent"),
    Case("3d-box144-turntable-F0.4-long", 3, "box-11", damped(5 * TRANSIT), [2, 6, 15], 0.4,
         top=["0", "0", "-1e4*(1 + 4*x)"], displacement="static", spin=0.2),
    struck_block("3d-box256-struck-F0.3-short", "box-15", 3, 0.3, newmark(SHORT * 3), [10, 30], sequence=(11, 60)),
    struck_block("3d-box400-struck-F0.3-short", "box-19", 3, 0.3, newmark(SHORT * 2), [10, 25]),
    pushed_3d("3d-box400-pushed-F0.6-long", "box-19", 0.6, damped(6 * TRANSIT), [4, 10]),
    pushed_3d("3d-box784-pushed-F0.3-long", "box-27", 0.3, damped(4 * TRANSIT), [6]),
    struck_block("3d-box784-struck-F0.5-short", "box-27", 3, 0.5, newmark(SHORT), [25]),
    struck_block("3d-box2025-struck-F0.4-short", "box-44", 3, 0.4, newmark(SHORT * 2), [3]),
    thrown_ball("3d-ball53-thrown-F0.3-short", 0.3, newmark(2e-5), [60, 90], mesh="ball-coarse"),
    thrown_ball("3d-ball175-thrown-F0-short", 0.0, newmark(2e-5), [70]),
    thrown_ball("3d-ball175-thrown-F0.1-short", 0.1, newmark(2e-5), [60, 100]),
    thrown_ball("3d-ball175-thrown-F0.3-short", 0.3, newmark(2e-5), [60, 100, 130], sequence=(61, 110),
                rescaled={"in-millimetres": (1e3, 1e3)}),
    thrown_ball("3d-ball175-thrown-F1-half", 1.0, {"scheme": "newmark", "preset": "textbook-half", "step": 4e-5}, [35, 50]),
    thrown_ball("3d-ball175-thrown-F0.3-consistent", 0.3, newmark(4e-5), [30, 50], mass="consistent"),
    thrown_ball("3d-ball175-dropped-F0.5-long", 0.5, damped(3e-3), [3, 5], velocity=("0.1", "0.2", "-0.6")),
    thrown_ball("3d-ball415-thrown-F0.4-short", 0.4, newmark(2e-5), [60, 110], mesh="ball-fine"),
]
