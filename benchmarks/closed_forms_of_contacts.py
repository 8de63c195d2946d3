"""Closed forms of pressed, sliding and rolling bodies and of Hertz' impact: functions of a case and of the name of a
quantity, which return its value, or None. The derivations are in the README.md of the folder of each case."""

import math
import re

from history_quantity import column_and_time

WEDGE_AREA = 4.0 * (1.0 + 0.6) / 2.0  # cgs-4/wedges.geo
WEDGE_PUSHED = 0.8
SLOPE = 0.1
HERTZ_MODULUS = 1.0 / (1.0 - 0.3**2)  # E = rho = R = 1


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


def cattaneo_mindlin(case, quantity):
    material, radius = case["material"][0], 1.0
    modulus = material["young"] / (1.0 - material["poisson"] ** 2)
    friction = case["contact"][0]["friction"]
    load = next(e["value"] for e in case["expect"] if e["quantity"] == "history.contact_force_y[-1]")
    push = case["traction"][0]["parameters"]["Q"]
    half_width = math.sqrt(4.0 * load * radius / (math.pi * modulus))
    largest = 2.0 * load / (math.pi * half_width)
    facet = 2.0 * 0.096 * radius / 64  # half-disc.geo; degree 2 has a node in its middle

    def stick(force):
        return half_width * math.sqrt(1.0 - force / (friction * load))

    column, time = column_and_time(case, quantity)
    force = push * min(time / 200.0, 1.0)
    return {
        "contact.area": 2.0 * half_width,
        "middle.pressure": largest,
        "sticking": 2.0 * stick(force) / (facet / 2.0),
        "middle.reaction_tangential_x": -friction * largest * (1.0 - stick(force) / half_width) * facet / 3.0,
        "contact_force_x": -force,
    }.get(column)


def cattaneo_mindlin_pair(case, quantity):
    """Two equal cylinders of radius 1."""
    material = case["material"][0]
    modulus, radius = 0.5 * material["young"] / (1.0 - material["poisson"] ** 2), 0.5
    friction = case["contact"][0]["friction"]
    load = next(e["value"] for e in case["expect"] if e["quantity"] == "history.contact.force_y[-1]")
    push = case["traction"][0]["parameters"]["Q"]
    half_width = math.sqrt(4.0 * load * radius / (math.pi * modulus))
    column, time = column_and_time(case, quantity)
    force = push * min(time / 200.0, 1.0)
    stick = half_width * math.sqrt(1.0 - force / (friction * load))
    return {
        "contact.area": 2.0 * half_width,
        "middle.pressure": 2.0 * load / (math.pi * half_width),
        "sticking": 2.0 * stick / (2.0 * 0.03 / 48),  # half-disc.geo
        # divided by the normal reaction, 1 in these units
        "middle.reaction_tangential_x": friction * (1.0 - stick / half_width),
        "middle.reaction_normal": 1.0,
        "contact.force_x": -force,
    }.get(column)


def hertz_cylinders(case, quantity):
    """A load per length, and pressures at probes of the two bodies."""
    load = case["traction"][0]["parameters"]["P"]
    modulus = 1.0 / sum((1.0 - m["poisson"] ** 2) / m["young"] for m in case["material"])
    radius = 1.0 / sum(1.0 / part["scale"] for part in case["part"].values())
    half_width = math.sqrt(4.0 * load * radius / (math.pi * modulus))
    column, _ = column_and_time(case, quantity)
    if column and column.endswith(".pressure"):
        place = next(probe["at"][0] for probe in case["probe"] if probe["name"] == column.split(".")[0])
        return 2.0 * load / (math.pi * half_width) * math.sqrt(1.0 - (place / half_width) ** 2)
    return {"contact.force_y": load, "contact.area": 2.0 * half_width}.get(column)


def roller(case, quantity):
    """Hertz' contact of a cylinder of radius 50 and a block; half of the load, and pressures at probes."""
    load, radius = case["traction"][0]["parameters"]["P"], 50.0
    modulus = 1.0 / sum((1.0 - m["poisson"] ** 2) / m["young"] for m in case["material"])
    half_width = math.sqrt(4.0 * load * radius / (math.pi * modulus))
    largest = 2.0 * load / (math.pi * half_width)
    column, _ = column_and_time(case, quantity)
    if column and column.endswith(".pressure"):
        place = next(probe["at"][0] for probe in case["probe"] if probe["name"] == column.split(".")[0])
        return largest * math.sqrt(1.0 - (place / half_width) ** 2)
    return {"contact.force_y": load / 2.0, "contact.area": half_width}.get(column)


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
    gravity = -case["load"]["gravity"][1]
    weight = math.pi * gravity
    half_width = math.sqrt(4.0 * weight / (math.pi * HERTZ_MODULUS))
    return 2.0 * weight / (math.pi * half_width) if quantity == "history.lowest.pressure[-1]" else None


def sphere(case, quantity):
    load = 4.0 * next(e["value"] for e in case["expect"] if e["quantity"] == "history.contact_force_z[-1]")
    radius = (3.0 * load / (4.0 * HERTZ_MODULUS)) ** (1.0 / 3.0)
    return 3.0 * load / (2.0 * math.pi * radius**2) if quantity == "history.lowest.pressure[-1]" else None


def energy_of(case):
    return next(e["value"] for e in case["expect"] if e["quantity"] == "max(history.total_energy)")


def sphere_impact(case, quantity):
    """Four quarters of the mesh's mass on Hertz' spring, 4/3 E* d^(3/2)."""
    if quantity != "max(history.contact_force_z)":
        return None
    energy = 4.0 * energy_of(case)
    approach = (15.0 * energy / (8.0 * HERTZ_MODULUS)) ** 0.4
    return HERTZ_MODULUS * approach**1.5 / 3.0


class PointImpact:
    """Hertz' impact of two balls (radius inf: a half-space of a body with the mass): the force 4/3 E* sqrt(R) d^(3/2) is a spring
    between the masses. Half of m v^2 is its work at the largest compression, and contact lasts 2.943 compressions over the speed."""

    def __init__(self, moduli, radii, masses, speed):
        self.modulus = 1.0 / sum((1.0 - poisson**2) / young for young, poisson in moduli)
        self.radius, mass = 1.0 / sum(1.0 / r for r in radii), masses[0] * masses[1] / sum(masses)
        self.compression = (15.0 * mass * speed**2 / (16.0 * self.modulus * math.sqrt(self.radius))) ** 0.4
        self.force = 4.0 / 3.0 * self.modulus * math.sqrt(self.radius) * self.compression**1.5
        self.duration = 0.8 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9) * self.compression / speed
        self.area = math.pi * self.radius * self.compression
        self.impulse = 2.0 * masses[1] / sum(masses)  # over that of the first body

    def of_a_quarter(self, quantity):
        """The reference values of a case that has a quarter of each body: only the area is a quarter."""
        return {
            "max(history.contact.force_z)": self.force,
            "last_time(history.contact.force_z > 0.5)": self.duration,
            "max(history.contact.area)": self.area / 4.0,
            "integral(history.contact.force_z)": self.impulse,
        }.get(quantity)


def two_balls(case, quantity):
    material, radii = case["material"][0], [part["scale"] for part in case["part"].values()]
    elastic = (material["young"], material["poisson"])
    masses = [material["density"] * 4.0 / 3.0 * math.pi * radius**3 for radius in radii]
    impact = PointImpact((elastic, elastic), radii, masses, -case["part"]["upper"]["velocity"][2])
    return impact.of_a_quarter(quantity)


def ball_block(case, quantity):
    """A cube of side 4 for a half-space."""
    ball, block = case["material"]
    radius, side = case["part"]["ball"]["scale"], 4.0 * case["part"]["block"]["scale"]
    masses = [ball["density"] * 4.0 / 3.0 * math.pi * radius**3, block["density"] * side**3]
    impact = PointImpact([(m["young"], m["poisson"]) for m in (ball, block)], (radius, math.inf), masses, -case["part"]["ball"]["velocity"][2])
    return impact.of_a_quarter(quantity)


def cylinder_impact(case, quantity):
    """W(P) = P^2/(pi E*) (K/2 - 1/4 - ln(P)/2) is the energy at the largest force P; two halves."""
    if quantity != "max(history.contact_force_y)":
        return None
    energy = 0.5 * math.pi * case["initial"]["velocity"][1] ** 2
    constant = math.log(math.pi * HERTZ_MODULUS) - 1.0 / (4.0 * (1.0 - 0.3))
    low, high = 1e-9, 1e-1
    while high - low > 1e-12 * high:
        force = 0.5 * (low + high)
        work = force**2 / (math.pi * HERTZ_MODULUS) * (0.5 * constant - 0.25 - 0.5 * math.log(force))
        low, high = (force, high) if work < energy else (low, force)
    return 0.5 * high
