"""Closed forms of waves in bars, layers and stacks: functions of a case and of the name of a quantity, which return its
value, or None. The derivations are in the README.md of the folder of each case."""

import math
import re

from history_quantity import column_and_time


class BarImpact:
    """A free uniform bar of uniaxial elasticity meets a rigid wall with its end s = 0 (s along the bar, away from the wall).

    By d'Alembert, a front of compression runs from the wall at c, stops the bar, is reflected by the free end as unloading, and
    is back at 2L/c, when the whole bar moves off at the speed with which it came and without strain.
    """

    def __init__(self, length, area, young, density, speed, gap):
        self.length, self.speed, self.gap = length, speed, gap
        self.wave_speed = math.sqrt(young / density)
        self.begin = gap / speed
        self.duration = 2.0 * length / self.wave_speed
        self.end = self.begin + self.duration
        self.pressure = density * self.wave_speed * speed
        self.force = self.pressure * area
        self.mass = density * length * area
        self.impulse = 2.0 * self.mass * speed
        self.energy = 0.5 * self.mass * speed**2
        self.shortening = speed * length / self.wave_speed

    def displacement(self, s, time):
        """Away from the wall: free flight, and what each passage of a front adds, v (t - t_front)."""
        moved = -self.speed * time
        for distance in (s, 2.0 * self.length - s):
            moved += self.speed * max(0.0, time - self.begin - distance / self.wave_speed)
        return moved

    def velocity(self, s, time):
        fronts = sum(time > self.begin + distance / self.wave_speed for distance in (s, 2.0 * self.length - s))
        return self.speed * (fronts - 1)

    def force_at(self, time):
        return self.force if self.begin < time < self.end else 0.0


class TwoBars:
    """Two free uniform bars of uniaxial elasticity, without strain at first, meet end on; each has an impedance z, the time T of a
    wave there and back, and a velocity towards the other one (bar 2: away from it). The far end of bar 2 may be clamped.

    In bar 1 v + p/z runs towards the contact unchanged and v - p/z away from it, in bar 2 v - p/z and v + p/z (p: pressure). A free
    end turns one into the other after T, a clamped one with the opposite sign. With I1 and I2 arriving, equal velocities of the
    faces give p = z1 z2 (I1 - I2)/(z1 + z2), and the bars part where that is not positive.
    """

    def __init__(self, z, transit, velocity, gap, end, clamped=False):
        self.z, self.transit, self.velocity, self.clamped = z, transit, velocity, clamped
        self.pieces = []  # (begin, end, pressure, velocities of the faces), all constant
        breaks, time = [0.0], 0.0
        while time < end:
            arriving = [self.arriving(bar, time) for bar in (0, 1)]
            closing = arriving[0] - arriving[1]
            pressure = z[0] * z[1] / (z[0] + z[1]) * closing if gap <= 0.0 < closing else 0.0
            faces = (arriving[0] - pressure / z[0], arriving[1] + pressure / z[1])
            later = [b + t for b in breaks for t in transit if b + t > time + 1e-9 * transit[0]]
            if gap > 0.0 and closing > 0.0:
                later.append(time + gap / closing)
            until = min(later, default=end)
            gap -= (until - time) * (faces[0] - faces[1])
            gap = 0.0 if gap < 1e-12 * abs(velocity[0] - velocity[1]) * transit[0] else gap
            self.pieces.append((time, until, pressure, faces))
            breaks.append(until)
            time = until

    def arriving(self, bar, time):
        sent = time - self.transit[bar]
        sign = -1.0 if bar == 1 and self.clamped else 1.0
        if sent < -1e-9 * self.transit[bar]:
            return self.velocity[bar]
        _, _, pressure, faces = self.piece(sent + 1e-9 * self.transit[bar])
        return sign * (faces[bar] + (pressure if bar == 1 else -pressure) / self.z[bar])

    def piece(self, time):
        return next(piece for piece in self.pieces if piece[0] <= time < piece[1])

    def pressure(self, time):
        return self.piece(time)[2]

    def impulse(self, time):
        return sum(p * (min(end, time) - begin) for begin, end, p, _ in self.pieces if begin < time)

    def displacement(self, bar, time):
        return sum(faces[bar] * (min(end, time) - begin) for begin, end, _, faces in self.pieces if begin < time)

    def mean_velocity(self, bar, time):
        mass = 0.5 * self.z[bar] * self.transit[bar]
        return self.velocity[bar] + (self.impulse(time) if bar == 1 else -self.impulse(time)) / mass


def bar(case, quantity, area, axis):
    """Reference values of a bar with probes "struck" and "free" at its ends."""
    at = {probe["name"]: probe["at"][axis] for probe in case["probe"] if "at" in probe}
    material = case["material"][0]
    impact = BarImpact(at["free"] - at["struck"], area, material["young"], material["density"],
                       -case["initial"]["velocity"][axis], at["struck"] - case["obstacle"]["wall"]["point"][axis])
    letter = "xyz"[axis]
    fixed = {
        "summary.impacts.0.begin": impact.begin,
        "summary.impacts.0.end": impact.end,
        "summary.impacts.0.duration": impact.duration,
        "summary.impacts.0.normal_impulse": impact.impulse,
        "summary.impacts.0.restitution": 1.0,
        f"summary.impacts.0.velocity_after.{axis}": impact.speed,
        "history.total_energy[-1]": impact.energy,
        "max(history.total_energy)": impact.energy,
        f"min(history.free.displacement_{letter})": -impact.gap - impact.shortening,
    }
    if quantity in fixed:
        return fixed[quantity]
    column, time = column_and_time(case, quantity)
    moving = {
        f"contact_force_{letter}": lambda: impact.force_at(time),
        "struck.pressure": lambda: impact.force_at(time) / area,
        f"struck.displacement_{letter}": lambda: impact.displacement(0.0, time),
        f"free.displacement_{letter}": lambda: impact.displacement(impact.length, time),
        f"free.velocity_{letter}": lambda: impact.velocity(impact.length, time),
    }
    return moving[column]() if column in moving else None


def sdnl111(case, quantity):
    """The second bar is clamped at its far end; x runs from it to the first one, which flies at -1 m/s."""
    material, gap, height, length = case["material"][0], 1.0e-5, 0.02, 1.0
    young, poisson, density = (material[key] for key in ("young", "poisson", "density"))
    wave_speed = math.sqrt(young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson)) / density)
    impedance, transit, speed = density * wave_speed, 2.0 * length / wave_speed, -case["motion"][0]["velocity"][0]
    bars = TwoBars((impedance, impedance), (transit, transit), (speed, 0.0), gap, case["time"]["end"], clamped=True)
    contact = [piece for piece in bars.pieces if piece[2] > 0.0]
    energy = 0.5 * density * length * height * speed**2
    fixed = {
        "first_time(history.contact.area > 0.01)": contact[0][0],
        "last_time(history.contact.area > 0.01)": contact[-1][1],
        "history.total_energy[-1]": energy,
        "max(history.total_energy)": energy,
    }
    if quantity in fixed:
        return fixed[quantity]
    column, time = column_and_time(case, quantity)
    return {
        "struck.pressure": lambda: bars.pressure(time),
        "struck.displacement_x": lambda: -bars.displacement(0, time),
        "bar.velocity_average_x": lambda: -bars.mean_velocity(0, time),
    }.get(column, lambda: None)()


def released_rod(time):
    """Returns the displacement and the pressure of the tip of a rod of E = rho = L = 1, compressed by half: u(0, t) has the period 3."""
    time %= 3.0
    return max(0.5 - 0.5 * time, 0.0, 0.5 * (time - 2.0)), 0.5 if 1.0 < time < 2.0 else 0.0


def rod(case, quantity):
    """Height 0.1."""
    column, time = column_and_time(case, quantity)
    displacement, pressure = released_rod(time)
    return {"tip.displacement_x": displacement, "tip.pressure": pressure, "contact_force_x": 0.1 * pressure}.get(column)


STRIKING_BAR = BarImpact(10.0, 0.5, 900.0, 1.0, 10.0, 5.0)  # of cases/bar


def bar_impact(case, quantity):
    impact = STRIKING_BAR
    column, time = column_and_time(case, quantity)
    return {
        "bottom.pressure": impact.force_at(time) / 0.5,
        "contact_force_y": impact.force_at(time),
        "bottom.displacement_y": impact.displacement(0.0, time),
        "top.displacement_y": impact.displacement(10.0, time),
        "momentum_y": impact.mass * impact.speed * (-1.0 if time < impact.begin else 1.0),
        "total_energy": impact.energy,
    }.get(column)


def bouncing_bar(time):
    """Returns the displacement and the pressure of the lower end of the same bar, dropped: period 16/3; contact from 1 to 5/3, and its
    time reverse from 11/3 to 13/3."""
    time %= 16.0 / 3.0
    mirrored = min(time, 16.0 / 3.0 - time)
    if mirrored <= 1.0:
        return -5.0 * mirrored**2, 0.0
    if mirrored < 5.0 / 3.0:
        return -5.0, 300.0 * mirrored
    flight = time - 5.0 / 3.0
    wave = flight % (2.0 / 3.0)
    return -5.0 + 10.0 * flight - 5.0 * flight**2 - 10.0 * wave * (2.0 / 3.0 - wave), 0.0


def bar_bounce(case, quantity):
    column, time = column_and_time(case, quantity)
    return dict(zip(("bottom.displacement_y", "bottom.pressure"), bouncing_bar(time))).get(column)


class SlidingLayer:
    """A layer of H = c = rho = 1 with a free top that comes at `speed`, on a base with the friction traction a: phase k slides at
    V - (1 + 2k) a for a time of 2; then the base sticks."""

    def __init__(self, a, speed=1.0):
        self.a, self.speed = a, speed
        self.phases = math.ceil((speed / a - 1.0) / 2.0 - 1e-9)
        self.left = speed - 2.0 * self.phases * a

    def sticks(self, time):
        return time >= 2.0 * self.phases

    def velocity(self, time):
        return 0.0 if self.sticks(time) else self.speed - (1 + 2 * int(time // 2.0)) * self.a

    def traction(self, time):
        """Of the base on the layer."""
        return -self.left * (-1) ** int((time - 2.0 * self.phases) // 2.0) if self.sticks(time) else -self.a

    def slip(self, time):
        return sum(min(max(time - 2.0 * k, 0.0), 2.0) * self.velocity(2.0 * k) for k in range(self.phases))


def layer(case, quantity, friction):
    """V = p = 0.01, width 0.5."""
    sliding = SlidingLayer(friction * 0.01, 0.01)
    column, time = column_and_time(case, quantity)
    slip = sliding.slip(time)
    return {
        "contact_force_x": 0.5 * sliding.traction(time),
        "left.displacement_x": slip,
        "right.displacement_x": slip,
        "friction_work": -0.5 * sliding.a * slip,
        "total_energy": 0.25 * sliding.left**2 if sliding.sticks(time) else None,
    }.get(column)


def sliding_plates(z, speed, bound):
    """Friction q and velocities of the faces in four phases of two plates with H/c = 1, impedances z1 and z2 and free backs; the upper
    one comes at `speed`. What arrives at the faces is D; the upper face moves at D1 - q/z1, the lower one at D2 + q/z2, with q = F p
    while that slides, else what makes them equal."""
    relative = z[0] * z[1] / (z[0] + z[1])
    arriving, phases = [speed, 0.0], []
    for _ in range(4):
        needed = relative * (arriving[0] - arriving[1])
        friction = needed if abs(needed) <= bound else math.copysign(bound, needed)
        phases.append((friction, arriving[0] - friction / z[0], arriving[1] + friction / z[1]))
        arriving = [arriving[0] - 2.0 * friction / z[0], arriving[1] + 2.0 * friction / z[1]]
    return phases


def stack(case, quantity):
    """Width 0.5."""
    z = [math.sqrt(m["density"] * m["young"] / 2.0) for m in case["material"]]
    width, bound, speed = 0.5, case["contact"][0]["friction"] * case["traction"][0]["parameters"]["p"], case["part"]["upper"]["velocity"][0]
    phases = sliding_plates(z, speed, bound)
    column, time = column_and_time(case, quantity)
    moved = [sum(min(max(time - 2.0 * k, 0.0), 2.0) * phase[face] for k, phase in enumerate(phases)) for face in (1, 2)]
    energy = 0.5 * z[0] * width * speed**2
    work = -width * bound * (moved[0] - moved[1])
    return {
        "contact.force_x": -width * phases[min(int(time / 2.0), 3)][0],
        "upper.displacement_average_x": moved[0],
        "lower.displacement_average_x": moved[1],
        "friction_work": work,
        "total_energy": energy + work,
        "momentum_x": z[0] * width * speed,
    }.get(column)


def two_bars(case, quantity, names, transit, height=0.05):
    """Bars of wave speed 1 whose faces have a probe face-NAME; all forces on the second bar."""
    speed, (first, second) = 0.01, names
    bars = TwoBars((3.0, 1.0), transit, (speed, 0.0), 0.05 * speed, case["time"]["end"])
    contact = [piece for piece in bars.pieces if piece[2] > 0.0]
    middle = re.fullmatch(r"mean\(history\.contact\.force_x, (.+), (.+)\)", quantity)
    if middle:
        begin, end = map(float, middle.groups())
        return height * (bars.impulse(end) - bars.impulse(begin)) / (end - begin)
    fixed = {
        "first_time(history.contact.area > 0.025)": contact[0][0],
        "last_time(history.contact.area > 0.025)": contact[-1][1],
        "max(history.total_energy)": 0.5 * 3.0 * speed**2 * height,
        "min(history.total_energy)": 0.5 * 3.0 * speed**2 * height,
        "history.momentum_x[-1]": 3.0 * speed * height,
    }
    if quantity in fixed:
        return fixed[quantity]
    column, time = column_and_time(case, quantity)
    time -= 1e-9
    return {
        f"face-{first}.pressure": lambda: bars.pressure(time),
        f"face-{second}.pressure": lambda: bars.pressure(time),
        f"face-{first}.displacement_x": lambda: bars.displacement(0, time),
        f"face-{second}.displacement_x": lambda: bars.displacement(1, time),
        f"{first}.velocity_average_x": lambda: bars.mean_velocity(0, time),
        f"{second}.velocity_average_x": lambda: bars.mean_velocity(1, time),
    }.get(column, lambda: None)()


def cradle(case, quantity):
    """Four rods of E = rho = c = L = 1 and height 0.05: contact k carries half of zV from k - 1 to k + 1, k = 1, 2, 3."""
    momentum = 0.01 * 0.05
    contacts = {"ab": 0, "bc": 1, "cd": 2}
    found = re.fullmatch(r"(\w+)\(history\.(ab|bc|cd)\.(force_x|area)(?: > 0\.025)?(?:, .+)?\)", quantity)
    if found:
        begin = contacts[found[2]]
        return {"integral": -momentum, "mean": -0.5 * momentum, "first_time": begin, "last_time": begin + 2.0}.get(found[1])
    return {
        "history.a.velocity_average_x[-1]": 0.0, "history.b.velocity_average_x[-1]": 0.0, "history.c.velocity_average_x[-1]": 0.0,
        "history.d.velocity_average_x[-1]": 0.01, "history.momentum_x[-1]": momentum, "max(history.total_energy)": 0.5 * 0.01 * momentum,
        "min(history.total_energy)": 0.5 * 0.01 * momentum,
    }.get(quantity)
