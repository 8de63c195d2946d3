"""Random obstacles below a body: their shape, their motion, and a position with a given gap at the start."""

import math
import pathlib
import sys

from quantities import Course, DENSITY, LENGTH, Level, Quantity, RATE, SPEED, axial, point, scalar, steady, vector
from scene import Surface, Table

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "throws"))
import shapes  # noqa: E402

KINDS = {2: ("plane", "circle", "hollow", "waves", "polygon", "ball as expression"),
         3: ("plane", "circle", "hollow", "cylinder", "bore", "torus", "waves", "rock", "ball as expression")}
ROUND = ("circle", "hollow", "cylinder", "bore", "torus")


def unit(values):
    length = math.hypot(*values)
    return tuple(v / length for v in values)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Shape:
    """Keys of an obstacle's shape, its distance function in a standard position at the origin, and its own centre."""

    def __init__(self, random, kind, dimension, size):
        self.random, self.kind, self.d, self.size = random, kind, dimension, size
        self.radius = size * random.uniform(0.4, 1.5)
        self.sign = -1.0 if kind in ("hollow", "bore") else 1.0
        if self.sign < 0:
            self.radius = size * random.uniform(1.2, 3)
        self.tilt = unit((*(random.uniform(-0.2, 0.2) for _ in range(dimension - 1)), 1.0))
        self.axis = unit((1.0, random.uniform(-0.5, 0.5), random.uniform(-0.1, 0.1))) if dimension == 3 else ()
        self.ring, self.height = size * random.uniform(0.5, 1), size * random.uniform(0.01, 0.08)
        self.wave = (random.uniform(1, 5) / size, *(random.uniform(-2, 2) / size for _ in range(dimension - 2)), 0.0)
        if kind in ("polygon", "rock"):
            self.vertices, self.facets = self.polygon() if dimension == 2 else self.rock()

    def distance(self, x):
        """Returns the distance of x from the shape at the origin; for a polyhedron the height above its highest
        corner."""
        if self.kind in ("circle", "hollow", "ball as expression"):
            return self.sign * (math.hypot(*x) - self.radius)
        if self.kind in ("cylinder", "bore"):
            return self.sign * (math.sqrt(max(dot(x, x) - dot(x, self.axis)**2, 0.0)) - self.radius)
        if self.kind == "torus":
            return math.hypot(math.hypot(x[0], x[1]) - self.ring, x[2]) - 0.4 * self.ring
        if self.kind == "waves":
            return x[-1] - self.height
        if self.kind in ("polygon", "rock"):
            return x[-1] - max(v[-1] for v in self.vertices)
        return dot(self.tilt, x)

    def place(self, points, gap):
        """Moves the shape vertically until the nearest of the points has the gap; sideways it is close to their
        middle."""
        d, random = self.d, self.random
        middle = [0.5 * (min(p[k] for p in points) + max(p[k] for p in points)) for k in range(d)]
        side = [m + 0.1 * self.size * random.uniform(-1, 1) for m in middle[:-1]]
        if self.kind == "torus":
            side[0] += self.ring
        nearest = lambda height: min(self.distance([x - s for x, s in zip(p, (*side, height))]) for p in points)
        far, near = (middle[-1] - 20 * self.size * self.sign, middle[-1])
        if self.sign < 0:  # the body is inside, above the lowest position
            far, near = middle[-1], middle[-1] + 20 * self.size
        for _ in range(100):
            half = 0.5 * (far + near)
            far, near = (half, near) if nearest(half) > gap else (far, half)
        self.centre = (*side, far)

    def keys(self):
        c, d = self.centre, self.d
        inside = {"side": "inside"} if self.sign < 0 else {}
        if self.kind == "plane":
            return {"type": "plane", "point": point(c), "normal": vector(self.tilt)}
        if self.kind in ("circle", "hollow"):
            return {"type": "sphere", "centre": point(c), "radius": scalar(self.radius, LENGTH), **inside}
        if self.kind in ("cylinder", "bore"):
            return {"type": "cylinder", "centre": point(c), "axis": vector(self.axis), "radius": scalar(self.radius, LENGTH), **inside}
        if self.kind == "torus":
            return {"type": "torus", "centre": point(c), "axis": vector((0.0, 0.0, 1.0)), "ring_radius": scalar(self.ring, LENGTH),
                    "tube_radius": scalar(0.4 * self.ring, LENGTH)}
        if self.kind == "ball as expression":
            return {"type": "implicit", "expression": Level("ball", c, size=self.radius)}
        if self.kind == "waves":
            normal = (0.0,) * (d - 1) + (1.0,)
            return {"type": "implicit", "expression": Level("waves", c, normal, self.height, self.wave)}
        moved = tuple(tuple(a + b for a, b in zip(v, c)) for v in self.vertices)
        rounding = {"edge_radius": scalar(0.05 * self.size, LENGTH)} if self.random.random() < 0.5 else {}
        return {"type": "surface", "file": Surface(moved, self.facets), **rounding}

    def polygon(self):
        random, corners = self.random, self.random.choice([3, 4, 5, 8])
        phase, sizes = random.uniform(0, 2 * math.pi), [self.radius * random.uniform(0.8, 1) for _ in range(corners)]
        vertices = tuple((r * math.cos(phase + 2 * math.pi * k / corners), r * math.sin(phase + 2 * math.pi * k / corners))
                         for k, r in enumerate(sizes))
        return vertices, ((*range(corners), 0),)

    def rock(self):
        vertices, triangles = shapes.icosahedron()
        if self.random.random() < 0.5:
            vertices, triangles = shapes.refine(vertices, triangles)
        return tuple(tuple(self.radius * self.random.uniform(0.9, 1) * x for x in v) for v in vertices), tuple(map(tuple, triangles))


def motion(random, shape, speed, time, axisymmetric):
    """Returns the keys of a motion: none, a velocity, a course, a rotation, its own rotation, a table. Its path is that
    of `speed` in `time`."""
    d, kind = shape.d, random.choice(("rest", "velocity", "course", "turning", "turning", "turning", "table", "rate"))
    rate = random.uniform(0.5, 4) / time
    velocity = [speed * random.uniform(-0.5, 0.5) for _ in range(d)]
    if axisymmetric:
        velocity[0] = 0.0
    course = Course(((vector([v / rate for v in velocity], LENGTH), random.choice(("sine", "swing")), rate),))
    if kind == "rest":
        return {}
    if kind == "velocity":
        return {"velocity": vector(velocity, SPEED)}
    if kind == "course" or axisymmetric:
        return {"motion": course}
    spin = speed / (shape.radius if shape.kind != "plane" else shape.size) * random.uniform(0.2, 2) * random.choice((-1, 1))
    if d == 3:
        spin = tuple(spin * x for x in unit([random.uniform(-1, 1) for _ in range(3)]))
    if kind == "rate" and (shape.kind in ROUND and (d == 2 or shape.kind not in ("circle", "hollow")) or shape.kind == "plane" and d == 3):
        value = spin if d == 2 else math.hypot(*spin)
        return {"rotation_rate": axial(value, RATE) if d == 2 else Turn(value)}
    about = {"about": point(shape.centre)} if shape.kind not in ("plane", *ROUND) else {}
    amplitude = lambda r: tuple(s / r for s in spin) if d == 3 else spin / r
    if kind == "table":
        times = [time * k / 4 for k in range(6)]
        return {"table": Table(tuple(times), tuple(tuple(v * math.sin(t / time) * time for v in velocity) for t in times),
                               tuple(tuple(s * t for s in spin) if d == 3 else spin * t for t in times)), **about}
    steadily = random.random() < 0.6
    terms = Course(((axial(amplitude(rate)), "linear" if steadily else "sine", rate),))
    moves = {}
    if random.random() < 0.4:
        moves = {"motion": steady(velocity, rate) if steadily else course}
    return {"rotation": terms, **moves, **about}


class Turn(Quantity):
    """A rate about an axis of the obstacle: right-handed, so that a reflection, which keeps the axis as a vector,
    reverses it."""

    def __init__(self, value):
        super().__init__(value, "scalar", RATE)

    def seen(self, frame):
        return Turn(frame.apply(self.values, "scalar", RATE) * frame.handedness())


def freedom(random, shape, speed, mass):
    """Returns the keys of a rigid body that moves freely and approaches."""
    d = shape.d
    spin = [speed / shape.radius * random.uniform(-1, 1) for _ in range(3)]
    velocity = [speed * random.uniform(-0.3, 0.3) for _ in range(d - 1)] + [0.5 * speed * random.random()]
    area = math.pi * shape.radius**2 if d == 2 else 4 / 3 * math.pi * shape.radius**3
    return {"density": scalar(mass * 10**random.uniform(-0.5, 1) / area, DENSITY), "velocity": vector(velocity, SPEED),
            "spin": axial(spin[0], RATE) if d == 2 else axial(spin, RATE)}
