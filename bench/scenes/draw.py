"""Scenes by their seeds."""

import math
import random as random_module

import meshes
from obstacles import KINDS, Shape, freedom, motion
from quantities import ACCELERATION, Course, DENSITY, LENGTH, Quantity, RATE, SPEED, STRESS, TIME, VelocityField, point, scalar, vector
from scene import Scene, Section, time_section

FAMILIES = ("obstacle", "obstacle", "pressed", "pressed", "free", "pair", "pair", "sliding", "itself", "axisymmetric")

LAWS = ("neo-hookean", "neo-hookean", "mooney-rivlin", "saint-venant-kirchhoff")


class Draw:
    """All random properties of a scene, decided by its seed."""

    def __init__(self, seed):
        self.random = random = random_module.Random(seed)
        self.seed, self.family = seed, random.choice(FAMILIES)
        self.axisymmetric = self.family == "axisymmetric"
        self.d = 2 if self.axisymmetric or self.family == "itself" else random.choice((2, 2, 3))
        self.degree = 2 if random.random() < 0.2 else 1
        self.finite = random.random() < 0.55
        self.plane = "axisymmetric" if self.axisymmetric else random.choice(("strain", "strain", "stress")) if self.d == 2 else "strain"
        self.friction = 0.0 if random.random() < 0.3 else random.uniform(0, 1)
        self.kinds = ("triangle", "quadrilateral") if self.d == 2 else ("tetrahedron", "hexahedron")
        self.density, self.young = 10**random.uniform(-0.5, 0.5), 10**random.uniform(1, 3)
        self.poisson = random.choice((0.0, 0.2, 0.3, 0.38, 0.45))  # the mean dilatation begins at 0.4
        self.wave = math.sqrt(self.young / self.density)
        self.speed = self.wave * 10**random.uniform(-2.5, -1.3)
        self.crossings, self.steps = 10**random.uniform(-1, 0.5), random.randint(24, 50)
        self.sections, self.tail, self.facts = [], [], {}
        self.law = random.choice(LAWS) if self.finite else "linear"
        if self.law == "saint-venant-kirchhoff":  # which softens under compression
            self.speed *= 0.3

    def set_step(self, cell):
        self.step = min(self.crossings * cell / self.wave, 0.1 * self.size / self.speed)
        self.time = self.step * self.steps
        self.cell = cell

    def cells(self, low, high):
        """Returns counts of cells and their size."""
        most = (4, 8) if self.d == 2 else (3, 4)
        if self.degree == 2:
            most = (3, 5) if self.d == 2 else (2, 3)
        counts = [self.random.randint(*most) for _ in range(self.d)]
        return counts, min((b - a) / c for a, b, c in zip(low, high, counts))

    def body(self, name, low, high, counts=None, form=None):
        random = self.random
        counts = counts or self.cells(low, high)[0]
        distortion = random.choice((0.0, 0.15))
        mesh = meshes.box(name, random, counts, low, high, random.choice(self.kinds), distortion, form)
        mesh.version = random.choice(("2.2", "4.1"))
        return mesh

    def material(self, group, factor=1.0):
        random, keys = self.random, {"group": group, "density": scalar(self.density, DENSITY)}
        young = self.young * factor
        law = keys["law"] = self.law
        if law == "mooney-rivlin":
            mu, bulk = young / (2 * (1 + self.poisson)), young / (3 * (1 - 2 * self.poisson))
            keys |= {"c10": scalar(0.4 * mu, STRESS), "c01": scalar(0.1 * mu, STRESS), "bulk_modulus": scalar(bulk, STRESS)}
        else:
            keys |= {"young": scalar(young, STRESS), "poisson": self.poisson}
        kind = random.random()
        if self.finite and kind < 0.2 and self.plane != "stress":
            keys["relaxation"] = Relaxation((0.5, 0.3), (3 * self.step, 0.3 * self.time))
        elif not self.finite and kind < 0.2:
            keys["damping.stiffness"] = scalar(self.step * random.uniform(0.05, 1), TIME)
        elif kind < 0.3:
            keys["damping.mass"] = scalar(random.uniform(0.1, 2) / self.time, RATE)
            self.facts["mass damping"] = True
        self.sections.append(Section("material", keys, many=True))

    def contact(self, group, **keys):
        random = self.random
        if self.friction > 0:
            keys["friction"] = self.friction
        if "obstacle" in keys and random.random() < 0.2:
            keys["multipliers"] = random.choice(("p1", "dual"))
        self.facts["pointwise"] = self.facts.get("pointwise", True) and "obstacle" in keys and "multipliers" not in keys
        self.sections.append(Section("contact", {"group": group, **keys}, many=True))

    def gravity(self):
        if self.random.random() < 0.4:
            weight = self.speed / self.time * self.random.uniform(0.2, 3)
            self.sections.append(Section("load", {"gravity": vector((0.0,) * (self.d - 1) + (-weight,), ACCELERATION)}))
            self.facts["gravity"] = weight

    def loads(self, group):
        random, kind = self.random, self.random.random()
        size = self.young * 10**random.uniform(-4, -2.5)
        course = lambda amplitude: Course(((amplitude, random.choice(("ramp", "sine", "swing")), random.uniform(1, 5) / self.time),))
        if kind < 0.15:
            pull = vector([0.0 if self.axisymmetric and k == 0 else size * random.uniform(-1, 1) for k in range(self.d)], STRESS)
            self.sections.append(Section("traction", {"group": group, "value": course(pull)}, many=True))
        elif kind < 0.3:
            self.sections.append(Section("pressure", {"group": group, "value": course(scalar(size, STRESS))}, many=True))
        self.facts["loads"] = self.facts.get("loads") or kind < 0.3

    def velocity_field(self, centre, speed):
        """Returns a motion downwards and sideways, with a spin."""
        random, d = self.random, self.d
        if self.axisymmetric:
            return VelocityField((0.0, -speed), ((0.0, 0.0), (0.0, 0.0)), tuple(centre))
        velocity = (*(random.uniform(-0.6, 0.6) * speed for _ in range(d - 1)), -speed)
        spin = [random.uniform(-1, 1) * speed / self.size * random.choice((0, 1)) for _ in range(3)]
        rows = [[0.0, -spin[2], spin[1]], [spin[2], 0.0, -spin[0]], [-spin[1], spin[0], 0.0]]
        return VelocityField(velocity, tuple(tuple(row[:d]) for row in rows[:d]), tuple(centre))

    def probes(self, at, boundaries=()):
        self.tail.append(Section("probe", {"name": "place", "at": point(at)}, many=True))
        for group in boundaries:
            self.tail.append(Section("probe", {"name": "side", "boundary": group, "about": point(at)}, many=True))

    def time_keys(self, adaptive=True):
        random, more = self.random, {}
        if random.random() < 0.3 and not self.finite:
            more["reaction_weight"] = random.choice(("adaptive", "end"))
        section = time_section(self.step, self.steps, **more)
        if adaptive and random.random() < 0.1:
            longest = section.keys["step"]
            section.keys |= {"step": "adaptive", "largest": longest, "smallest": Quantity(longest.values / 64, "scalar", TIME)}
            self.facts["adaptive"] = True
        self.sections.append(section)

    def scene(self, parts, as_parts=False):
        output = Section("output", {"fields_every": 0})
        return Scene(self.seed, self.family, parts, [*self.sections, *self.tail, output], self.plane, self.degree, as_parts,
                     {**self.facts, "finite": self.finite, "friction": self.friction, "step": self.step})


class Relaxation:
    """An inline table of moduli and times."""

    def __init__(self, moduli, times):
        self.moduli, self.times = moduli, times

    def seen(self, frame):
        return Relaxation(self.moduli, tuple(t * frame.time for t in self.times))

    def text(self):
        return "{{ modulus = {}, time = {} }}".format(list(self.moduli), [float(f"{t:.17g}") for t in self.times])


def one_body(draw, held):
    """Draws a body above one obstacle or two; if held, a support at its top moves it down."""
    random, d = draw.random, draw.d
    low, high = [-0.5] * d, [0.5] * d
    draw.size = 1.0
    if draw.axisymmetric:
        low[0] = 0.0 if random.random() < 0.5 else 0.3
        high[0] = low[0] + 0.6
    high[-1] = low[-1] + random.uniform(0.6, 1.2)
    counts, cell = draw.cells(low, high)
    form = meshes.rounded(random.uniform(0.2, 0.6)) if random.random() < 0.4 and not draw.axisymmetric else None
    mesh = draw.body("one", low, high, counts, form)
    draw.set_step(cell)
    draw.material("body")
    gap = draw.speed * draw.time * random.uniform(0.02, 0.4)
    kinds = ("plane", "circle", "waves", "ball as expression") if draw.axisymmetric else KINDS[d]
    sides = "bottom" if form is None or random.random() < 0.5 else ["bottom", "left", "right"]
    for k in range(1 if draw.family in ("free", "axisymmetric") else random.choice((1, 1, 2))):
        kind = random.choice(kinds if draw.family != "free" else ("circle", "polygon" if d == 2 else "rock"))
        add_obstacle(draw, mesh, kind, f"o{k}", gap, sides)
    draw.gravity()
    if held:
        deep = gap + 0.03 * random.random() * draw.cell * counts[-1] * (0.3 if draw.law == "saint-venant-kirchhoff" else 1.0)
        sideways = [0.0 if draw.axisymmetric else random.uniform(-0.5, 0.5) * deep for _ in range(d - 1)]
        course = Course(((vector((*sideways, -deep), LENGTH), random.choice(("swing", "sine", "ramp")), random.uniform(1, 3) / draw.time),))
        draw.sections.append(Section("support", {"group": "top", "value": course}, many=True))
        draw.probes([a + 0.9 * (b - a) if k < d - 1 else a for k, (a, b) in enumerate(zip(low, high))], ("top",))
        draw.facts["supported"] = True
    else:
        draw.loads("top")
        centre = [(a + b) / 2 for a, b in zip(low, high)]
        draw.sections.append(Section("initial", {"velocity": draw.velocity_field(centre, draw.speed)}))
        draw.probes(low)
    draw.time_keys()
    return draw.scene([mesh])


def add_obstacle(draw, mesh, kind, name, gap, sides):
    random = draw.random
    shape = Shape(random, kind, draw.d, draw.size)
    shape.place(mesh.points, gap)
    if draw.axisymmetric and kind in ("circle", "ball as expression"):
        shape.centre = (0.0, min(p[1] for p in mesh.points) - shape.radius - gap)
    if draw.axisymmetric and kind == "plane":
        shape.tilt, shape.centre = (0.0, 1.0), (0.0, min(p[1] for p in mesh.points) - gap)
    keys = shape.keys()
    if draw.family == "free":
        keys |= freedom(random, shape, draw.speed, draw.density)
    else:
        keys |= motion(random, shape, draw.speed, draw.time, draw.axisymmetric)
    draw.sections.append(Section(f"obstacle.{name}", keys))
    draw.facts.setdefault("kinds", []).append(kind)
    draw.contact(sides, obstacle=name)


def two_bodies(draw):
    """Draws a body that strikes another one, which is free, held, or on a floor."""
    random, d = draw.random, draw.d
    draw.size = 1.0
    sliding, flat = draw.family == "sliding", random.random() < 0.5
    low, high = [-0.6] * (d - 1) + [-0.6], [0.6] * (d - 1) + [0.0]
    counts, cell = draw.cells(low, high)
    matching = flat and not sliding and random.random() < 0.5
    kind = random.choice(draw.kinds)
    draw.kinds = (kind,) if matching else draw.kinds
    above = counts if matching else draw.cells(low, high)[0]
    half = 0.6 if matching else 0.4
    draw.set_step(min(cell, 2 * half / max(above)))
    gap = draw.speed * draw.time * random.uniform(0.02, 0.3)
    form = None if flat else meshes.rounded(random.uniform(0.2, 0.5))
    upper = draw.body("up", [-half] * (d - 1) + [gap], [half] * (d - 1) + [gap + 0.7], above, form)
    lower = draw.body("low", low, high, counts)
    lower.version = upper.version
    draw.material("up.body", 10**random.uniform(-0.5, 0.5) if random.random() < 0.5 else 1.0)
    draw.material("low.body")
    how = {"sliding": "large"} if sliding else {"multipliers": random.choice(("p1", "p1", "dual", "nodal"))}
    # With equal bodies, rounding would decide.
    how["multipliers_on"] = random.choice(("group", "against") if matching else ("automatic", "group", "against"))
    draw.contact("up.bottom", against="low.top", **how)
    draw.facts |= {"matching": matching, "pair": True}
    velocity = [random.uniform(-0.3, 0.3) * draw.speed * (3 if sliding else 1) for _ in range(d - 1)] + [-draw.speed]
    draw.sections.append(Section("motion", {"group": "up.body", "velocity": vector(velocity, SPEED)}, many=True))
    stands = random.random()
    if stands < 0.3:
        course = Course(((vector([0.0] * (d - 1) + [0.3 * draw.speed * draw.time], LENGTH), "swing", 1 / draw.time),))
        draw.sections.append(Section("support", {"group": "low.bottom", "value": course}, many=True))
        draw.facts["supported"] = True
    elif stands < 0.6:
        add_obstacle(draw, lower, "plane", "floor", 0.3 * gap, "low.bottom")
    draw.gravity()
    draw.loads("up.top")
    draw.probes(high)
    draw.time_keys()
    return draw.scene([upper, lower], as_parts=random.random() < 0.5)


def clamp(draw):
    """Draws a strip bent to an open ring, whose ends are thrown against each other."""
    random = draw.random
    draw.size, half = 1.0, random.uniform(2.88, 3.02)
    across, along = random.randint(3, 4) if draw.degree == 1 else 3, random.randint(14, 18)
    inner, outer = 0.35, 0.55
    mesh = draw.body("ring", [-1.0, -1.0], [1.0, 1.0], [along, across])
    # Along the ring from one end to the other; angle 0 is on the left, the ends are on the right. A uniform ring would
    # be its own mirror image, and rounding would choose which of two facing points counts.
    angle = lambda s: half * (s + 0.04 * (1 - s * s)) + 0.1
    bend = lambda p: (-(inner + (1 - p[1]) / 2 * (outer - inner)) * math.cos(angle(p[0])),
                      (inner + (1 - p[1]) / 2 * (outer - inner)) * math.sin(angle(p[0])))
    mesh.points = [bend(p) for p in mesh.points]
    draw.crossings = max(draw.crossings, 0.6)
    draw.set_step(min((outer - inner) / across, 2 * half * inner / along))
    draw.material("body")
    draw.speed = min(draw.speed, 0.02 * draw.wave)
    gap = 2 * inner * abs(math.sin(half))
    draw.steps = min(120, max(draw.steps, int(1.3 * gap / (2 * draw.speed * draw.step)) + 10))
    draw.contact(["left", "right"], against=["left", "right"], sliding="large")
    draw.facts |= {"pair": True, "itself": True}
    # The upper and lower halves move to the line between them, in proportion to the distance on the right.
    rows = ((0.0, 0.0), (0.0, -2 * draw.speed / gap))
    draw.sections.append(Section("initial", {"velocity": VelocityField((0.0, 0.0), rows, (0.0, 0.0))}))
    draw.probes([inner * math.cos(math.pi - half), inner * math.sin(half)])
    draw.time_keys(adaptive=False)
    return draw.scene([mesh])


def scene_of(seed):
    draw = Draw(seed)
    if draw.family in ("pair", "sliding"):
        return two_bodies(draw)
    if draw.family == "itself":
        return clamp(draw)
    return one_body(draw, draw.family == "pressed" or draw.axisymmetric and draw.random.random() < 0.4)
