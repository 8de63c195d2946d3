"""Hertz' contact and impact (K. L. Johnson, Contact Mechanics, 1985; cases/hertz/README.md derives the cylinder). Python's library only."""

import math

CONTACT_TIME = 0.8 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9)  # of an impact: 2.943 largest compressions over the speed


def contact_modulus(*elastic):
    """E* of bodies, each with (Young's modulus, Poisson's ratio); what else touches is rigid."""
    return 1.0 / sum((1.0 - poisson**2) / young for young, poisson in elastic)


def relative_radius(*radii):
    return 1.0 / sum(1.0 / radius for radius in radii)


class LineContact:
    """Parallel cylinders under a load per length: the half-width and the largest pressure."""

    def __init__(self, load, modulus, radius=1.0):
        self.width = math.sqrt(4.0 * load * radius / (math.pi * modulus))
        self.peak = 2.0 * load / (math.pi * self.width)

    def pressure(self, distance):
        return self.peak * math.sqrt(1.0 - (distance / self.width) ** 2)


class PointContact:
    """Balls under a load: the radius of the contact and the largest pressure."""

    def __init__(self, load, modulus, radius=1.0):
        self.width = (0.75 * load * radius / modulus) ** (1.0 / 3.0)
        self.peak = 1.5 * load / (math.pi * self.width**2)


class PointImpact:
    """A mass (of two bodies: m1 m2/(m1 + m2)) on the spring 4/3 E* sqrt(R) d^(3/2), which the contact of balls is in a slow impact."""

    def __init__(self, modulus, radius, mass, speed):
        self.mass, self.speed, self.stiffness = mass, speed, 4.0 / 3.0 * modulus * math.sqrt(radius)
        self.compression = (1.25 * mass * speed**2 / self.stiffness) ** 0.4  # half of m v^2 is the work of the force up to here
        self.force = self.force_at(self.compression)
        self.duration = CONTACT_TIME * self.compression / speed
        self.area = math.pi * radius * self.compression

    @classmethod
    def of_bodies(cls, elastic, radii, masses, speed):
        """Two bodies; the radius inf stands for a half-space that has the mass of the body."""
        return cls(contact_modulus(*elastic), relative_radius(*radii), masses[0] * masses[1] / sum(masses), speed)

    def force_at(self, compression):
        return self.stiffness * max(compression, 0.0) ** 1.5

    def course(self, gravity=0.0, steps=4000):
        """Returns times and forces from the first touch to the release."""
        step, compression, velocity = self.duration / steps, 0.0, self.speed
        times, forces = [0.0], [0.0]
        while compression >= 0.0:
            velocity += step * (gravity - self.force_at(compression) / self.mass)
            compression += step * velocity
            times.append(times[-1] + step)
            forces.append(self.force_at(compression))
        return times, forces


class LineImpact:
    """A mass per length on the spring

        delta(P) = P/(pi E*) (2 ln(2R/a) - 1/(4 (1 - nu))) = k P (K - ln P),

    the approach of a disc's centre of mass to a plane when its own inertia, a uniform body force, balances P. The work up to P is
    k P^2 (K/2 - 1/4 - ln(P)/2)."""

    def __init__(self, modulus, radius, poisson, mass, speed):
        self.k = 1.0 / (math.pi * modulus)
        self.constant = math.log(math.pi * modulus * radius) - 0.25 / (1.0 - poisson)
        low, high = 0.0, math.exp(self.constant - 1.0)  # the spring is monotonic up to here
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.work(middle) < 0.5 * mass * speed**2 else (low, middle)
        self.force = high
        # T = 2 int d delta / sqrt(v^2 - 2 W/m), with P = P_max sin(angle): a smooth integrand, midpoint rule.
        count, self.duration = 20000, 0.0
        for n in range(count):
            angle = (n + 0.5) * 0.5 * math.pi / count
            load = self.force * math.sin(angle)
            rate = self.k * (self.constant - 1.0 - math.log(load)) * self.force * math.cos(angle)
            self.duration += math.pi / count * rate / math.sqrt(speed**2 - 2.0 * self.work(load) / mass)

    def work(self, load):
        return self.k * load**2 * (0.5 * self.constant - 0.25 - 0.5 * math.log(load))
