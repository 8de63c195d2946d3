"""Closed forms of pressed, sliding and rolling bodies and of Hertz' impact: functions of a case and of the name of a
quantity, which return its value, or None. The derivations are in the README.md of the folder of each case."""

import math
import re

from hertz import LineContact, LineImpact, PointContact, PointImpact, contact_modulus, relative_radius
from history_quantity import column_and_time

WEDGE_AREA = 4.0 * (1.0 + 0.6) / 2.0  # cgs-4/wedges.geo
WEDGE_PUSHED = 0.8
SLOPE = 0.1
HERTZ_MODULUS = contact_modulus((1.0, 0.3))  # E = rho = R = 1


def wedge_force(friction, weight):
    """The horizontal force that makes a wedge slide up, from the balance along and across the incline:
    F cos a - G sin a = mu (G cos a + F sin a)."""
    return weight * (SLOPE + friction) / (1.0 - friction * SLOPE)


def cgs_4(case, quantity):
    mass = case["material"][0]["density"] * WEDGE_AREA
    weight = -case["load"]["gravity"][1] * mass
    column, time = column_and_time(case, quantity)
    found = re.fullmatch(r"(push|wedge)-(\d)\.(force_x|velocity_average_x)", column or "")
    if not found:
        return None
    friction = case["contact"][int(found[2])]["friction"]
    threshold = wedge_force(friction, weight)
    if found[1] == "push":
        return threshold
    # threshold.toml: (F - F*) rises from -0.001 F* at t = 0.01 to 0.001 F* at t = 0.03. Sliding starts where it is 0, at t = 0.02,
    # under (F - F*) (cos a - mu sin a) along the incline.
    cosine = 1.0 / math.sqrt(1.0 + SLOPE**2)
    impulse = 0.001 * threshold * (0.5 * 0.01 + time - 0.03)
    return impulse * (cosine - friction * SLOPE * cosine) / mass * cosine


def elastic(material):
    return material["young"], material["poisson"]


def expected(case, quantity):
    """A value that the case states as measured."""
    return next(e["value"] for e in case["expect"] if e["quantity"] == quantity)


class PartialSlip(LineContact):
    """A cylinder pressed by `load` and then pushed by a force Q, which rises within 200: it sticks in the middle."""

    def __init__(self, case, load, modulus, radius, time):
        super().__init__(load, modulus, radius)
        self.friction = case["contact"][0]["friction"]
        self.force = case["traction"][0]["parameters"]["Q"] * min(time / 200.0, 1.0)
        self.stick = self.width * math.sqrt(1.0 - self.force / (self.friction * load))


def cattaneo_mindlin(case, quantity):
    column, time = column_and_time(case, quantity)
    slip = PartialSlip(case, expected(case, "history.contact_force_y[-1]"), contact_modulus(elastic(case["material"][0])), 1.0, time)
    facet = 2.0 * 0.096 / 64  # half-disc.geo; degree 2 has a node in its middle
    return {
        "contact.area": 2.0 * slip.width,
        "middle.pressure": slip.peak,
        "sticking": 2.0 * slip.stick / (facet / 2.0),
        "middle.reaction_tangential_x": -slip.friction * slip.peak * (1.0 - slip.stick / slip.width) * facet / 3.0,
        "contact_force_x": -slip.force,
    }.get(column)


def cattaneo_mindlin_pair(case, quantity):
    """Two equal cylinders of radius 1."""
    column, time = column_and_time(case, quantity)
    load, both = expected(case, "history.contact.force_y[-1]"), [elastic(case["material"][0])] * 2
    slip = PartialSlip(case, load, contact_modulus(*both), 0.5, time)
    return {
        "contact.area": 2.0 * slip.width,
        "middle.pressure": slip.peak,
        "sticking": 2.0 * slip.stick / (2.0 * 0.03 / 48),  # half-disc.geo
        # divided by the normal reaction, 1 in these units
        "middle.reaction_tangential_x": slip.friction * (1.0 - slip.stick / slip.width),
        "middle.reaction_normal": 1.0,
        "contact.force_x": -slip.force,
    }.get(column)


def pressed_cylinders(case, quantity, radius, share):
    """A load per length, of which the mesh has a share, as of the contact, and pressures at probes of both bodies."""
    load = case["traction"][0]["parameters"]["P"]
    contact = LineContact(load, contact_modulus(*map(elastic, case["material"])), radius)
    column, _ = column_and_time(case, quantity)
    if column and column.endswith(".pressure"):
        return contact.pressure(next(probe["at"][0] for probe in case["probe"] if probe["name"] == column.split(".")[0]))
    return {"contact.force_y": share * load, "contact.area": share * 2.0 * contact.width}.get(column)


def hertz_cylinders(case, quantity):
    return pressed_cylinders(case, quantity, relative_radius(*(part["scale"] for part in case["part"].values())), 1.0)


def roller(case, quantity):
    """A cylinder of radius 50 and a block."""
    return pressed_cylinders(case, quantity, 50.0, 0.5)


def patch_test(case, quantity):
    """Blocks with a height of 2 together, pressed by 0.1 on an area of 1."""
    young, strain = case["material"][0]["young"], -case["support"][-1]["value"] / 2.0
    axis = case["support"][0]["components"][0]
    column, _ = column_and_time(case, quantity)
    return {
        f"contact.force_{axis}": young * strain,
        "contact.area": 1.0,
        "corner.pressure": young * strain,
        "other.pressure": young * strain,
        f"facing-up.displacement_minimum_{axis}": -strain,
        f"facing-up.displacement_maximum_{axis}": -strain,
        "blocks.von_mises_minimum": young * strain,
        "blocks.von_mises_maximum": young * strain,
        "total_energy": young * strain**2,
    }.get(column)


def greco(case, quantity):
    """Only the balance of the pressure on the top, 40 mm long."""
    return 0.04 * 50.0e6 if quantity == "history.contact_force_y[-1]" else None


def incline(case, quantity, friction):
    mass = 20.0
    along, across = case["load"]["gravity"][0], -case["load"]["gravity"][1]
    force = min(friction * across, along)
    column, time = column_and_time(case, quantity)
    return {
        "contact_force_x": -mass * force,
        "momentum_x": mass * (along - force) * time,
        "centre.displacement_x": 0.5 * (along - force) * time**2,
    }.get(column)


def held(case, quantity):
    along, across = case["load"]["gravity"]
    return {"contact_force_x": -20.0 * along, "contact_force_y": -20.0 * across}.get(
        (re.fullmatch(r"(?:min|max)\(history\.(.+)\)", quantity) or [None, None])[1])


def cylinder(case, quantity):
    weight = -math.pi * case["load"]["gravity"][1]
    return LineContact(weight, HERTZ_MODULUS).peak if quantity == "history.lowest.pressure[-1]" else None


def sphere(case, quantity):
    load = 4.0 * expected(case, "history.contact_force_z[-1]")
    return PointContact(load, HERTZ_MODULUS).peak if quantity == "history.lowest.pressure[-1]" else None


def sphere_impact(case, quantity):
    """A quarter of the mesh's mass."""
    speed = -case["initial"]["velocity"][2]
    mass = 4.0 * 2.0 * expected(case, "max(history.total_energy)") / speed**2
    return PointImpact(HERTZ_MODULUS, 1.0, mass, speed).force / 4.0 if quantity == "max(history.contact_force_z)" else None


def cylinder_impact(case, quantity):
    """A half."""
    speed = -case["initial"]["velocity"][1]
    return 0.5 * LineImpact(HERTZ_MODULUS, 1.0, 0.3, math.pi, speed).force if quantity == "max(history.contact_force_y)" else None


def of_a_quarter(impact, masses, quantity):
    """The reference values of a case that has a quarter of each body: only the area is a quarter."""
    return {
        "max(history.contact.force_z)": impact.force,
        "last_time(history.contact.force_z > 0.5)": impact.duration,
        "max(history.contact.area)": impact.area / 4.0,
        "integral(history.contact.force_z)": 2.0 * masses[1] / sum(masses),  # over that of the first body
    }.get(quantity)


def two_balls(case, quantity):
    material, radii = case["material"][0], [part["scale"] for part in case["part"].values()]
    masses = [material["density"] * 4.0 / 3.0 * math.pi * radius**3 for radius in radii]
    impact = PointImpact.of_bodies([elastic(material)] * 2, radii, masses, -case["part"]["upper"]["velocity"][2])
    return of_a_quarter(impact, masses, quantity)


def ball_block(case, quantity):
    """A cube of side 4 for a half-space."""
    ball, block = case["material"]
    radius, side = case["part"]["ball"]["scale"], 4.0 * case["part"]["block"]["scale"]
    masses = [ball["density"] * 4.0 / 3.0 * math.pi * radius**3, block["density"] * side**3]
    impact = PointImpact.of_bodies([elastic(ball), elastic(block)], (radius, math.inf), masses, -case["part"]["ball"]["velocity"][2])
    return of_a_quarter(impact, masses, quantity)


class BlockInBowl:
    """A rigid block whose lower corners slide on y = bowl x^2: one degree of freedom, the x of the middle of the chord."""

    def __init__(self, bowl=0.25, half=0.2, thick=0.15):
        self.bowl, self.half, self.thick = bowl, half, thick

    def place(self, x):
        """Returns the centre of mass and the angle."""
        turn = math.atan(2.0 * self.bowl * x)
        chord = self.bowl * (x**2 + (self.half * math.cos(turn)) ** 2)
        return x - 0.5 * self.thick * math.sin(turn), chord + 0.5 * self.thick * math.cos(turn), turn

    def rate(self, x, h=1e-6):
        return tuple((after - before) / (2.0 * h) for before, after in zip(self.place(x - h), self.place(x + h)))

    def inertia(self, rate):
        """Returns twice the kinetic energy per mass of a unit rate of x."""
        return rate[0] ** 2 + rate[1] ** 2 + ((2.0 * self.half) ** 2 + self.thick**2) / 12.0 * rate[2] ** 2
