"""Quantities of a case that can be transformed to another observer: a rotated, mirrored or moved frame, or other units.

A quantity has a kind (scalar, point, vector, or axial vector, which a reflection reverses in addition) and dimensions,
the exponents of mass, length and time. `seen(frame)` is the quantity in that frame, `text(dimension)` its value in
TOML.
"""

import dataclasses
import math

NONE, LENGTH, TIME, RATE, SPEED, ACCELERATION = (0, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1), (0, 1, -1), (0, 1, -2)
STRESS, DENSITY = (1, -1, -2), (1, -3, 0)


def mechanical(per_length):
    """Returns the dimensions of quantities that a plane body has per unit thickness."""
    e = -1 if per_length else 0
    return {"mass": (1, e, 0), "inertia": (1, 2 + e, 0), "force": (1, 1 + e, -2), "energy": (1, 2 + e, -2),
            "momentum": (1, 1 + e, -1), "angular momentum": (1, 2 + e, -1), "stress": STRESS, "length": LENGTH,
            "speed": SPEED, "angle": NONE, "rate": RATE, "stiffness": (1, e, -2)}


def number(value):
    return f"{value:.17g}" if value >= 0 else f"({value:.17g})"


def plain(value):
    """Returns a dimensionless value of a case in TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(plain, value)) + "]"
    return f"{value:.17g}" if isinstance(value, float) else str(value)


@dataclasses.dataclass(frozen=True)
class Frame:
    """x -> length (R x + shift) with orthogonal rows R; the factors are those of the numbers in other units."""
    rows: tuple
    shift: tuple
    mass: float = 1.0
    length: float = 1.0
    time: float = 1.0

    def factor(self, dims):
        return self.mass**dims[0] * self.length**dims[1] * self.time**dims[2]

    def turn(self, values):
        return tuple(math.fsum(r * v for r, v in zip(row, values)) for row in self.rows)

    def handedness(self):
        rows = self.rows
        if len(rows) == 2:
            sign = rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]
        else:
            sign = sum(a * b for a, b in zip(rows[0], cross(rows[1], rows[2])))
        return 1.0 if sign > 0 else -1.0

    def apply(self, values, kind, dims):
        factor = self.factor(dims)
        if kind == "scalar":
            return values * factor
        if kind == "axial" and not isinstance(values, tuple):
            return values * self.handedness() * factor
        turned = self.turn(values)
        if kind == "point":
            turned = tuple(a + b for a, b in zip(turned, self.shift))
        elif kind == "axial":
            factor *= self.handedness()
        return tuple(factor * a for a in turned)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def identity(dimension, **units):
    rows = tuple(tuple(float(i == j) for j in range(dimension)) for i in range(dimension))
    return Frame(rows, (0.0,) * dimension, **units)


@dataclasses.dataclass(frozen=True)
class Quantity:
    values: object  # a number, or a tuple
    kind: str = "scalar"
    dims: tuple = NONE

    def seen(self, frame):
        return Quantity(frame.apply(self.values, self.kind, self.dims), self.kind, self.dims)

    def text(self):
        return plain(list(self.values) if isinstance(self.values, tuple) else float(self.values))


def scalar(value, dims):
    return Quantity(value, "scalar", dims)


def point(values):
    return Quantity(tuple(values), "point", LENGTH)


def vector(values, dims=NONE):
    return Quantity(tuple(values), "vector", dims)


def axial(values, dims=NONE):
    return Quantity(tuple(values) if isinstance(values, (tuple, list)) else values, "axial", dims)


FUNCTIONS = {"linear": "{r}*t", "sine": "sin({r}*t)", "swing": "(1-cos({r}*t))", "ramp": "min({r}*t, 1)"}
VALUES = {"linear": lambda s: s, "sine": math.sin, "swing": lambda s: 1 - math.cos(s), "ramp": lambda s: min(s, 1.0)}


@dataclasses.dataclass(frozen=True)
class Course:
    """Sum of amplitude * function(rate * t)."""
    terms: tuple  # of (Quantity, name of a function, rate)

    def seen(self, frame):
        return Course(tuple((a.seen(frame), name, rate * frame.factor(RATE)) for a, name, rate in self.terms))

    def component(self, k):
        """Returns the expression of component k, or of a scalar if k is None."""
        parts = []
        for amplitude, name, rate in self.terms:
            value = amplitude.values if k is None else amplitude.values[k]
            parts.append(f"{number(value)}*{FUNCTIONS[name].format(r=number(rate))}")
        return " + ".join(parts)

    def at(self, time):
        """Returns the value at that time."""
        factors = [VALUES[name](rate * time) for _, name, rate in self.terms]
        amplitudes = [a.values for a, _, _ in self.terms]
        if not isinstance(amplitudes[0], tuple):
            return sum(a * f for a, f in zip(amplitudes, factors))
        return tuple(sum(a[k] * f for a, f in zip(amplitudes, factors)) for k in range(len(amplitudes[0])))

    def text(self):
        first = self.terms[0][0].values
        if not isinstance(first, tuple):
            return plain(self.component(None))
        return plain([self.component(k) for k in range(len(first))])

    def with_velocity(self, velocity):
        """Returns this course with an additional constant velocity."""
        rate = self.terms[0][2]
        drift = Quantity(tuple(v / rate for v in velocity), "vector", self.terms[0][0].dims)
        return Course((*self.terms, (drift, "linear", rate)))


def steady(velocity, rate, kind="vector"):
    """Returns a course with a constant velocity; the rate only affects the form of the expression."""
    values = tuple(v / rate for v in velocity) if isinstance(velocity, (tuple, list)) else velocity / rate
    return Course(((Quantity(values, kind, LENGTH if kind == "vector" else NONE), "linear", rate),))


@dataclasses.dataclass(frozen=True)
class VelocityField:
    """v + A (x - c): a body that moves, spins and is strained."""
    velocity: tuple
    gradient: tuple  # rows of A
    centre: tuple

    def seen(self, frame):
        d = len(self.velocity)
        turned = [[sum(frame.rows[i][k] * self.gradient[k][m] * frame.rows[j][m] for k in range(d) for m in range(d))
                   * frame.factor(RATE) for j in range(d)] for i in range(d)]
        return VelocityField(frame.apply(self.velocity, "vector", SPEED), tuple(map(tuple, turned)),
                             frame.apply(self.centre, "point", LENGTH))

    def text(self):
        def component(k):
            parts = [number(self.velocity[k])]
            parts += [f"{number(a)}*({'xyz'[m]} - {number(self.centre[m])})" for m, a in enumerate(self.gradient[k]) if a != 0]
            return " + ".join(parts)
        if all(a == 0 for row in self.gradient for a in row):
            return plain([float(v) for v in self.velocity])
        return plain([component(k) for k in range(len(self.velocity))])


@dataclasses.dataclass(frozen=True)
class Level:
    """An implicit surface: a ball, a cylinder (with an axis), a plane, or waves on it."""
    form: str
    point: tuple
    normal: tuple = ()  # axis of a cylinder
    size: float = 0.0  # radius, or height of the waves
    wave: tuple = ()

    def seen(self, frame):
        turn = lambda values, dims: frame.apply(values, "vector", dims) if values else ()
        return Level(self.form, frame.apply(self.point, "point", LENGTH), turn(self.normal, NONE), self.size * frame.length,
                     turn(self.wave, (0, -1, 0)))

    def text(self):
        away = [f"({'xyz'[k]} - {number(p)})" for k, p in enumerate(self.point)]
        along = lambda direction: "(" + " + ".join(f"{number(n)}*{a}" for n, a in zip(direction, away)) + ")"
        square = " + ".join(f"{a}^2" for a in away)
        if self.form == "ball":
            return plain(f"sqrt({square}) - {number(self.size)}")
        if self.form == "cylinder":
            return plain(f"sqrt({square} - {along(self.normal)}^2) - {number(self.size)}")
        waves = f" - {number(self.size)}*sin({along(self.wave)})" if self.form == "waves" else ""
        return plain(along(self.normal) + waves)
