"""Random throws: an elastic body, and one or two obstacles of any kind, at rest, with a given motion, or free."""

import math
import random as random_module

import shapes

BODIES = {
    (2, "disc"): 'Disk(1) = {0.5, 0.4, 0, 0.4};',
    (2, "block"): 'Rectangle(1) = {0, 0, 0, 1.0, 0.5};',
    (3, "ball"): 'Sphere(1) = {0.5, 0.4, 0.4, 0.4};',
    (3, "block"): 'Box(1) = {0, 0, 0, 1.0, 0.8, 0.6};',
}
KINDS = {2: ["plane", "sphere", "bowl", "implicit", "surface", "free sphere"],
         3: ["plane", "sphere", "bowl", "cylinder", "bore", "torus", "implicit", "surface", "ground", "free sphere", "free surface"]}
DEEPEST_FALL = 2  # body lengths


def numbers(values):
    return "[" + ", ".join(f"{value:.9g}" for value in values) + "]"


class Throw:
    """A throw: `text` is the case, with its files in `folder`; `kinds` are the obstacles."""

    def __init__(self, seed, folder):
        self.random, self.seed, self.folder = random_module.Random(seed), seed, folder
        random = self.random
        self.dimension = random.choice([2, 3])
        self.law = random.choice(["linear", "neo-hookean"])
        self.body = random.choice(["block", "disc" if self.dimension == 2 else "ball"])
        self.friction = random.choice([0, 0.2, 0.5, 0.9])
        self.kinds = [random.choice(KINDS[self.dimension]) for _ in range(random.choice([1, 1, 2]))]
        self.size = random.choice([0.1, 0.14] if self.dimension == 2 else [0.16, 0.19])
        self.write_body()
        self.text = self.material_and_time() + "".join(
            f'[obstacle.o{k}]\n{self.obstacle(kind, k)}[[contact]]\ngroup = "skin"\nobstacle = "o{k}"\nfriction = {self.friction}\n'
            for k, kind in enumerate(self.kinds))

    def file(self, ending):
        return self.folder / f"throw_{self.seed}{ending}"

    def write_body(self):
        what, sides = ("Volume", "Surface") if self.dimension == 3 else ("Surface", "Curve")
        boundary = "{1}" if self.body in ("disc", "ball") else "{1:6}" if self.dimension == 3 else "{1:4}"
        self.file(".geo").write_text(
            f'SetFactory("OpenCASCADE");\n{BODIES[self.dimension, self.body]}\nMesh.MeshSizeMax = {self.size};\n'
            f'Mesh.MeshSizeMin = {self.size};\nPhysical {what}("body") = {{1}};\nPhysical {sides}("skin") = {boundary};\n')

    def material_and_time(self):
        """Draws impacts of up to a tenth of the wave speed, including after a fall; steps of up to ten crossings of a
        cell, or a tenth of the body."""
        random, speed = self.random, self.random.uniform(0.3, 3)
        young = 10**random.uniform(1.5, 3.5)
        crossings = random.choice([0.5, 1, 3, 10])
        velocity = [random.uniform(-0.5, 0.5) * speed for _ in range(self.dimension - 1)] + [-speed]
        weight = random.choice([0, 5.0])
        fastest = math.sqrt(speed**2 + 2 * weight * DEEPEST_FALL)
        young = max(young, 100 * fastest**2)
        step = min(crossings * self.size / math.sqrt(young), 0.1 / fastest)
        end = max(40 * step, min(1.2, 300 * step))
        if weight > 0:
            end = min(end, (fastest - speed) / weight)
        gravity = [0.0] * (self.dimension - 1) + [-weight]
        return (f'[mesh]\nfile = "{self.file(".geo").name}"\n[[material]]\ngroup = "body"\nlaw = "{self.law}"\ndensity = 1.0\n'
                f'young = {young:.9g}\npoisson = {random.choice([0.0, 0.3, 0.4])}\n[load]\ngravity = {numbers(gravity)}\n'
                f'[initial]\nvelocity = {numbers(velocity)}\n[mass]\ntype = "equivalent"\n'
                f'[time]\nstep = {step:.9g}\nend = {end:.9g}\n')

    def formulas(self, most):
        random = self.random
        one = lambda: f'"{random.uniform(-most, most):.3f}*sin({random.uniform(1, 8):.2f}*t)"'
        return "[" + ", ".join(one() for _ in range(self.dimension)) + "]"

    def motion(self):
        random, kind = self.random, self.random.random()
        if kind < 0.35:
            return ""
        if kind < 0.6:
            return f"velocity = {numbers(random.uniform(-0.5, 0.5) for _ in range(self.dimension))}\n"
        translation = f"motion = {self.formulas(0.15)}\n"
        if kind < 0.8:
            return translation
        turn = self.formulas(0.3) if self.dimension == 3 else f'"{random.uniform(-0.5, 0.5):.3f}*sin({random.uniform(1, 5):.2f}*t)"'
        return f"rotation = {turn}\n" + (translation if random.random() < 0.5 else "")

    def freedom(self):
        random = self.random
        spin = numbers(random.uniform(-3, 3) for _ in range(3)) if self.dimension == 3 else f"{random.uniform(-3, 3):.9g}"
        return (f"density = {10**random.uniform(-0.5, 1):.9g}\nspin = {spin}\n"
                f"velocity = {numbers(random.uniform(-0.3, 0.5) for _ in range(self.dimension))}\n")

    def obstacle(self, kind, number):
        random, d = self.random, self.dimension
        place = [random.uniform(0.2, 0.8) for _ in range(d - 1)]
        if kind == "plane":
            tilt = [random.uniform(-0.4, 0.4) for _ in range(d - 1)]
            return f'type = "plane"\npoint = {numbers([0.5] * (d - 1) + [-0.75])}\nnormal = {numbers(tilt + [1])}\n' + self.motion()
        if kind in ("sphere", "free sphere"):
            radius = random.uniform(0.25, 1.2)
            return (f'type = "sphere"\ncentre = {numbers(place + [-radius - 0.35])}\nradius = {radius:.9g}\n'
                    + (self.freedom() if kind.startswith("free") else self.motion()))
        if kind == "bowl":
            return f'type = "sphere"\ncentre = {numbers([0.5] * (d - 1) + [0.4])}\nradius = {random.uniform(1.6, 4):.9g}\nside = "inside"\n'
        if kind == "cylinder":
            radius, axis = random.uniform(0.3, 1), [random.uniform(-1, 1), 1, random.uniform(-0.1, 0.1)]
            return (f'type = "cylinder"\ncentre = {numbers(place + [-radius - 0.35])}\naxis = {numbers(axis)}\nradius = {radius:.9g}\n'
                    + self.motion())
        if kind == "bore":
            axis = [random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1]
            return (f'type = "cylinder"\ncentre = [0.5, 0.4, 0.4]\naxis = {numbers(axis)}\nradius = {random.uniform(1.5, 3):.9g}\n'
                    'side = "inside"\n')
        if kind == "torus":
            ring, tube = random.uniform(0.8, 1.6), random.uniform(0.25, 0.5)
            axis = [random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15), 1]
            return (f'type = "torus"\ncentre = {numbers([0.5, 0.4, -tube - 0.55])}\naxis = {numbers(axis)}\nring_radius = {ring:.9g}\n'
                    f'tube_radius = {tube:.9g}\n' + self.motion())
        if kind == "implicit":
            height, wave = random.uniform(0.05, 0.25), random.uniform(1, 5)
            level = (f"y + 0.7 + {height:.4f}*sin({wave:.3f}*x)" if d == 2 else
                     f"z + 0.75 + {height:.4f}*sin({wave:.3f}*x)*cos({random.uniform(0, 4):.3f}*y)")
            return f'type = "implicit"\nexpression = "{level}"\n' + self.motion()
        file = self.file(f"_{number}.txt" if d == 2 else f"_{number}.stl")
        if kind == "ground":
            shapes.write_rough_ground(random, file)
        elif d == 2:
            shapes.write_polygon(random, file, place[0])
        else:
            shapes.write_rock(random, file)
        return f'type = "surface"\nfile = "{file.name}"\n' + (self.freedom() if kind.startswith("free") else self.motion())
