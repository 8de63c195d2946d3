"""Properties that another observer, another description or another machine must find of the same scene: each makes a
twin.

A twin has the same history as the scene, seen in its frame, up to TOLERANCE of the largest number of each class of
columns. With the linear law and planes the differences are rounding of matrices and solutions (1e-16 times condition
numbers of up to 1e6) over some fifty steps. If contact follows the motion (finite strain, large sliding, obstacles
other than planes), the iterations of a step end when gaps are correct up to rounding, which leaves its root to
directions and forces, and one iteration more or less makes a difference of that size. If a difference is larger, twins
whose nodes are moved by NUDGE of the body show how far rounding is amplified in this scene: a point that is about to
touch or to slip does so in one of two runs. A difference counts if it exceeds SPREAD times those of NUDGED twins up to
the next row. Rows from a step on that one of the runs divides, or holds, as it finds no solution, are not compared.
Which points of a surface that touches itself represent others depends on the first of them (docs/sliding.md), which
numbers and axes decide: frames and numbers are compared until then.
"""

import math
import random as random_module

from history import Run, deviations
from quantities import Frame, Level, Quantity, SPEED, axial, identity, scalar, steady, vector
from scene import Section, Table

TOLERANCE = {False: 1e-9, True: 1e-5}  # by whether contact follows the motion
NUDGE, SPREAD, NUDGED = 1e-12, 100.0, 8
# For flat meshes that match at the start. Deformed ones no longer do, and both sides are discretizations: up to 5e-3
# apart in 1,000 scenes.
OTHER_SIDE = {False: 0.0, True: 1e-2}
HEAVY = 1e9  # ratio of the mass of a free body to that of the body it meets


def random_rotation(random, d):
    """Returns the rows of a rotation by any angle."""
    if d == 2:
        a = random.uniform(0.1, 2 * math.pi)
        return ((math.cos(a), -math.sin(a)), (math.sin(a), math.cos(a)))
    q = [random.gauss(0, 1) for _ in range(4)]
    n = math.sqrt(sum(x * x for x in q))
    w, x, y, z = (v / n for v in q)
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))


def mirrored(rows, axis):
    return tuple(tuple(-x if k == axis else x for k, x in enumerate(row)) for row in rows)


def frame_of(name, random, scene):
    d = scene.dimension
    ring = scene.plane == "axisymmetric"
    rows = identity(d).rows
    if name == "turned":
        return Frame(random_rotation(random, d), (0.0,) * d)
    if name == "mirrored":
        return Frame(mirrored(rows if ring else random_rotation(random, d), d - 1), (0.0,) * d)
    if name == "moved":
        return Frame(rows, tuple(0.0 if ring and k == 0 else random.uniform(-3, 3) * scene.size() for k in range(d)))
    if name == "units":
        return identity(d, mass=3.7**random.uniform(-6, 6), length=1.7**random.uniform(-8, 8), time=2.3**random.uniform(-6, 6))
    return identity(d)


class Twins:
    """Runs a scene and its twins in a folder, and reports disagreements."""

    def __init__(self, scene, program, folder):
        self.scene, self.program, self.folder = scene, program, folder
        self.random = random_module.Random(scene.seed * 7919 + 1)
        self.base = self.run(scene, "base")

    def run(self, scene, name, *arguments):
        run = Run(self.program, scene.write(self.folder, name), self.folder / name, *arguments)
        run.scene = scene
        return run

    def tolerance(self, scene):
        curved = any(o.keys["type"] != "plane" for o in scene.obstacles())
        return TOLERANCE[scene.facts["finite"] or curved or scene.family in ("sliding", "itself")]

    def compare(self, name, twin_scene, frame, tolerance=0.0, **how):
        """Returns [(property, size, text)] of the disagreements of the twin, and the twin's run."""
        twin = self.run(twin_scene, name)
        return self.judge(name, twin, twin_scene, frame, max(tolerance, self.tolerance(twin_scene)), **how), twin

    def judge(self, name, twin, twin_scene, frame, tolerance, **how):
        base = self.base
        if self.scene.facts.get("itself") and name in ("turned", "mirrored", "renumbered") and base.columns:
            how["until"] = base.first_choice()
        rows, worst = deviations(self.scene, base, twin, frame, **how) if base.columns and twin.columns else ([], (0.0, ""))
        ends = (base.status, len(base.columns.get("time", ())))
        same = ends == (twin.status, len(twin.columns.get("time", ()))) or base.columns and twin.columns and self.differ_by_method(base, twin)
        if same and max(rows, default=0.0) <= tolerance:
            return []
        spread, all_ends = [0.0] * len(rows), {(twin.status, len(twin.columns.get("time", ())))}
        for k in range(NUDGED):
            self.nudge(k, twin_scene, twin, spread, all_ends, how)
            first = next((k for k, row in enumerate(rows) if not row <= max(tolerance, SPREAD * max(spread[:k + 2]))), None)
            if first is None and (same or ends in all_ends):
                return []
        if first is None:
            return [(name, math.inf, f"status {base.status}, twin {twin.status}: {(twin if base.status == 0 else base).error()[:200]}")]
        return [(name, worst[0], f"{worst[1]}; first in row {first}, {rows[first]:.1e} where rounding causes {max(spread[:first + 2]):.1e}")]

    def differ_by_method(self, one, other):
        return one.status == other.status == 0 and one.alike_until(other) < len(one.columns["time"])

    def nudge(self, k, scene, run, spread, ends, how):
        """Records, by rows, the effect of moving the nodes of the twin or of the scene by rounding, and how that run
        ended."""
        of, reference = ((scene, run), (self.scene, self.base))[k % 2]
        meshes = [m.perturbed(self.random, NUDGE * of.size(), of.plane == "axisymmetric") for m in of.meshes]
        other = self.run(of.replace(meshes=meshes), f"nudged{k}")
        ends.add((other.status, len(other.columns.get("time", ()))))
        if other.columns and reference.columns:
            rows, _ = deviations(of, reference, other, identity(of.dimension), keep=how.get("keep", lambda *_: True))
            for k in range(len(spread)):
                spread[k] = max(spread[k], rows[k] if k < len(rows) else math.inf)

    def symmetry(self, name):
        frame = frame_of(name, self.random, self.scene)
        return self.compare(name, self.scene.seen(frame), frame)

    def renumbered(self):
        scene = self.scene.replace(meshes=[m.renumbered(self.random) for m in self.scene.meshes])
        return self.compare("renumbered", scene, identity(scene.dimension))

    def described(self):
        """Uses the other version of the file format; bodies in files of their own or in one."""
        scene = self.scene
        for mesh in scene.meshes:
            mesh.version = "2.2" if mesh.version == "4.1" else "4.1"
        try:
            return self.compare("described", scene.replace(as_parts=len(scene.meshes) > 1 and not scene.as_parts), identity(scene.dimension))
        finally:
            for mesh in scene.meshes:
                mesh.version = "2.2" if mesh.version == "4.1" else "4.1"

    def ordered(self):
        sections = list(self.scene.sections)
        self.random.shuffle(sections)
        # A probe at a node of two contacts refers to the first of them.
        return self.compare("order", self.scene.replace(sections=sections), identity(self.scene.dimension), keep=without_points)

    def threads(self):
        twin = self.run(self.scene, "threads", "--threads", "2")
        same = twin.status == self.base.status and getattr(twin, "bytes", None) == getattr(self.base, "bytes", None)
        return ([] if same else [("threads", math.inf, f"histories differ; status {self.base.status} and {twin.status}")]), twin

    def resumed(self):
        """Runs a fraction of the steps, and resumes from there to the end."""
        step, steps = self.scene.facts["step"], round(self.scene.section("time").keys["end"].values / self.scene.facts["step"])
        case = self.scene.write(self.folder, "resumed")
        half = self.random.randint(2, steps - 1) * step
        end = self.scene.section("time").keys["end"].text()
        twin = Run(self.program, case, self.folder / "resumed", "--set", f"time.end={half:.17g}")
        if twin.status == 0:
            before = twin.messages  # its messages about steps count for the whole run
            twin = Run(self.program, case, self.folder / "resumed", "--set", f"time.end={end}", resume=True)
            twin.messages = before + twin.messages
        twin.scene = self.scene
        same = twin.status == self.base.status and getattr(twin, "bytes", None) == getattr(self.base, "bytes", None)
        return ([] if same else [("resumed", math.inf, f"histories differ; status {self.base.status} and {twin.status} {twin.error()[:200]}")]), twin

    def thrown(self):
        """Galilei: all bodies, obstacles and supports have an additional constant velocity."""
        d, ring = self.scene.dimension, self.scene.plane == "axisymmetric"
        size = self.scene.size() / self.scene.section("time").keys["end"].values * self.random.uniform(0.1, 1)
        w = tuple(0.0 if ring and k == 0 else size * self.random.uniform(-1, 1) for k in range(d))
        sections = [boosted(s, w) for s in self.scene.sections]
        if not any(s.name == "initial" for s in sections):
            sections.append(Section("initial", {"velocity": vector(w, SPEED)}))

        def adjust(columns, values, time):
            tail = columns[0].split(".")[-1].rpartition("_")[0]
            add = {"velocity": 1.0, "displacement": time}.get(tail, 0.0)
            return [v + add * a for v, a in zip(values, w)]

        kept = ("elastic_energy", "friction_work", "contact_work", "numerical_dissipation", "viscous_dissipation")
        keep = lambda family, columns: (family not in ("energy", "momentum", "angular momentum", "moment")) or columns[0] in kept
        return self.compare("thrown", self.scene.replace(sections=sections), identity(d), keep=keep, adjust=adjust)

    def heavy(self):
        """An obstacle with a given steady rotation, and a free body of very large mass and inertia with that spin."""
        scene, section = self.scene, turning_steadily(self.scene)
        keys, d, mass = dict(section.keys), scene.dimension, HEAVY * scene.mass()
        amplitude, _, rate = keys.pop("rotation").terms[0]
        spin = tuple(rate * a for a in amplitude.values) if d == 3 else rate * amplitude.values
        centre = keys.pop("about", None) or keys.get("centre") or keys.get("point")
        dims = scene.dims
        inertia = mass * scene.size()**2
        keys |= {"mass": scalar(mass, dims["mass"]), "centre_of_mass": centre, "spin": axial(spin),
                 "inertia": Quantity((inertia,) * 3 if d == 3 else inertia, "vector" if d == 3 else "scalar", dims["inertia"])}
        if "motion" in keys:
            terms = keys.pop("motion").terms
            keys["velocity"] = vector(tuple(sum(a.values[k] * r for a, _, r in terms) for k in range(d)), SPEED)
        if scene.facts.get("gravity"):
            keys["force"] = vector((0.0,) * (d - 1) + (mass * scene.facts["gravity"],))
        twin = scene.with_section(section, Section(section.name, keys))
        kept = ("elastic_energy", "friction_work", "contact_work")
        keep = lambda family, columns: columns[0] in kept or family in ("force", "displacement")
        size = math.hypot(*spin) if isinstance(spin, tuple) else abs(spin)
        # Motions within a step differ: the given angle of a step, or the angle of its middle. The difference is of
        # first order.
        tolerance = 0.1 * size * scene.facts["step"]
        return self.compare("heavy", twin, identity(d), tolerance, keep=keep)

    def expressed(self):
        """A plane, a circle or ball, or a cylinder, given by an expression."""
        scene = self.scene
        section = next(s for s in scene.obstacles() if can_be_expressed(scene, s))
        k = section.keys
        if k["type"] == "plane":
            level = Level("plane", k["point"].values, normal=tuple(n / math.hypot(*k["normal"].values) for n in k["normal"].values))
        else:
            level = Level("ball" if k["type"] == "sphere" else "cylinder", k["centre"].values, k["axis"].values if "axis" in k else (),
                          k["radius"].values)
        about = k.get("about") or k.get("centre") or k.get("point")
        rest = {key: value for key, value in k.items() if key in ("velocity", "motion", "rotation", "table", "side")}
        if "rotation" in rest or "table" in rest:
            rest["about"] = about
        twin = scene.with_section(section, Section(section.name, {"type": "implicit", "expression": level, **rest}))
        return self.compare("expressed", twin, identity(scene.dimension))

    def other_side(self):
        """Matching flat meshes, with the multipliers on either side."""
        scene = self.scene
        section = first_contact(scene)
        side = {"group": "against", "against": "group"}[section.keys["multipliers_on"]]
        twin = scene.with_section(section, Section("contact", section.keys | {"multipliers_on": side}, many=True))
        return self.compare("other side", twin, identity(scene.dimension), OTHER_SIDE[scene.facts["finite"]], keep=without_points)


def without_points(family, columns):
    """Excludes quantities that a probe reads from a contact point."""
    return columns[0].split(".")[-1].rpartition("_")[0] != "reaction_tangential" and family not in ("gap", "pressure") and (
        not columns[0].endswith("reaction_normal"))


def first_contact(scene):
    return next(s for s in scene.sections if s.name == "contact" and "against" in s.keys)


def boosted(section, w):
    """Returns a section for an observer in whose frame everything has the additional velocity w."""
    keys, d = dict(section.keys), len(w)
    if section.name.startswith("obstacle."):
        if "motion" in keys:
            keys["motion"] = keys["motion"].with_velocity(w)
        elif "table" in keys:
            table = keys["table"]
            keys["table"] = Table(table.times, tuple(tuple(a + t * b for a, b in zip(u, w)) for t, u in zip(table.times, table.displacements)),
                                  table.rotations)
        elif "rotation" in keys:
            keys["motion"] = steady(w, keys["rotation"].terms[0][2])
        else:
            old = keys["velocity"].values if "velocity" in keys else (0.0,) * d
            keys["velocity"] = vector(tuple(a + b for a, b in zip(old, w)), SPEED)
    elif section.name == "support":
        keys["value"] = keys["value"].with_velocity(w)
    elif section.name == "initial":
        field = keys["velocity"]
        keys["velocity"] = type(field)(tuple(a + b for a, b in zip(field.velocity, w)), field.gradient, field.centre)
    return Section(section.name, keys, section.many)


def turning_steadily(scene):
    for s in scene.obstacles():
        rotation = s.keys.get("rotation")
        moves = s.keys.get("motion")
        steadily = rotation and rotation.terms[0][1] == "linear" and (moves is None or all(n == "linear" for _, n, _ in moves.terms))
        if steadily and s.keys["type"] not in ("implicit",):
            return s
    return None


def can_be_expressed(scene, section):
    """The default uses a mean of the reactions without friction only for planes."""
    k = section.keys
    if k["type"] == "plane" and (scene.facts["friction"] == 0 or "reaction_weight" in scene.section("time").keys):
        return False
    return k["type"] in ("plane", "sphere", "cylinder") and "rotation_rate" not in k and "density" not in k


def properties_of(scene):
    """Returns the names of the properties that apply to the scene."""
    facts, adaptive = scene.facts, scene.facts.get("adaptive")
    names = ["mirrored", "moved", "units", "renumbered", "described", "order", "threads"]
    if scene.plane != "axisymmetric":
        names += ["turned"] * 2
    if not adaptive:
        names += ["resumed"]
        if not facts.get("mass damping"):
            names += ["thrown"] * 2
    if scene.plane != "axisymmetric" and turning_steadily(scene):
        names += ["heavy"] * 3
    if any(can_be_expressed(scene, s) for s in scene.obstacles()):
        names += ["expressed"]
    if facts.get("matching"):
        names += ["other side"] * 2
    return names


def check(twins, name):
    """Returns the findings of one property, and the twin's run."""
    methods = {"renumbered": twins.renumbered, "described": twins.described, "order": twins.ordered, "threads": twins.threads,
               "resumed": twins.resumed, "thrown": twins.thrown, "heavy": twins.heavy, "expressed": twins.expressed,
               "other side": twins.other_side}
    return methods[name]() if name in methods else twins.symmetry(name)
