"""The cases that cause messages which advise a setting (followed_advice_tables.py): texts, settings, and files beside
the case."""

import math

from harness import MESHES, SOURCE, block_case, body_case, gravity, with_more
from two_bodies_test import strip
from two_bodies_traps_test import wedge

BLOCK = (block_case().replace("[[material]]", "refine = 2\n[[material]]", 1)
         .replace('scheme = "newmark"\npreset = "trapezoidal"', 'scheme = "midpoint"'))
PLANE = 'type = "plane"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]'
BALL = BLOCK.replace(PLANE, 'type = "sphere"\ncentre = [0.5, -2.0]\nradius = 2.0')
BALLOON = with_more(SOURCE / "cases" / "balloon" / "balloon.toml", "")
PRESSED = BLOCK + '[[pressure]]\ngroup = "sides"\nvalue = "1"\n'
JERKED = BLOCK + '[[support]]\ngroup = "sides"\ncomponents = ["x"]\nvalue = "-0.01*min(t/0.1, 1)"\n'
HELD = BLOCK + '[[support]]\ngroup = "sides"\ncomponents = ["y"]\n'
CURVED = BLOCK.replace("quadrilateral_o1", "disc_o2").replace("refine = 2\n", "").replace('"bottom"', '"boundary"')
SOLID = body_case(MESHES / "tetrahedron_o1_msh41_ascii.msh", [0.0, 0.0, -9.0], [0.0, 0.0, 1.0], gravity(0.0, 0.0, -10.0),
                  scheme="reduced-kane", mass="equivalent")
PARALLELOGRAM = MESHES / "quadrilateral_o1_msh41_ascii.msh"
PAIR = f"""[part.one]
file = "{PARALLELOGRAM}"
refine = 2
[part.two]
file = "{PARALLELOGRAM}"
refine = 1
move = [0.0, 1.2]
[[material]]
group = "one.all"
density = 1.0
young = 100.0
poisson = 0.3
[[material]]
group = "two.all"
density = 1.0
young = 100.0
poisson = 0.3
[[contact]]
group = "two.bottom"
against = "one.boundary"
multipliers = "p1"
[[support]]
group = "one.bottom"
components = ["x", "y"]
[time]
step = 1e-3
end = 0.1
"""
# The upper block stands on the middle of the lower one, whose facets end elsewhere.
NARROW = PAIR.replace("refine = 1\nmove = [0.0, 1.2]", "refine = 1\nscale = 0.37\nmove = [0.64, 1.195]")
# None removes a key.
KANE = {"time.scheme": "reduced-kane", "mass.type": "equivalent", "time.preset": None}
NEWMARK = {"time.scheme": "newmark", "time.preset": "trapezoidal"}
EXPLICIT = {"time.scheme": "semi-explicit", "mass.type": "equivalent-lumped", "time.step": 1e-3}
ALL_ROUND = {"mesh.refine": 0, "contact.0.group": "boundary"}
FEWER = [{"mesh.degree": 2}, {"mesh.refine": 2}, {"contact.0.group": "bottom"}]
ADAPTIVE = {"time.step": "adaptive", "time.tolerance": 1e-7, "time.largest": 1e-2, "time.smallest": 5e-3}
GROWS = {"time.scheme": "newmark", "time.beta": 0.1, "time.gamma": 0.5, "time.step": 0.05, "time.end": 40, "mass.type": "lumped",
         "output.fields_every": 0, "check.energy_residual": 0, "check.momentum": 0, "check.angular_momentum": 0}
SLIDES = {**NEWMARK, "contact.0.friction": 0.3, "initial.velocity": "[5.0, 0.0]", "mesh.move": "[0.0, -0.1]", "time.step": 0.05,
          "time.end": 1.0, "mass.type": "lumped", "material.0.lambda": 1e4, "material.0.mu": 1e4}
RELAXES = {"material.0.relaxation.modulus": "[0.5]", "material.0.relaxation.time": "[0.1]"}


def mapped(text, place):
    """Returns a mesh of `strip` with its nodes moved."""
    lines = text.split("\n")
    first = lines.index("$Nodes") + 2
    for k in range(first, first + int(lines[first - 1])):
        number, x, y, _ = lines[k].split()
        x, y = place(float(x), float(y))
        lines[k] = f"{number} {x!r} {y!r} 0"
    return "\n".join(lines)


def bricks(across, up):
    """Returns a cuboid of hexahedra, as a .msh file."""
    at = lambda i, j, k: 1 + i + (across + 1) * (j + (across + 1) * k)
    nodes = [(i, j, k) for k in range(up + 1) for j in range(across + 1) for i in range(across + 1)]
    cells = [(at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1), at(i + 1, j, k + 1),
              at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)) for k in range(up) for j in range(across) for i in range(across)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "1", '3 1 "body"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{n} {x} {y} {z}" for n, (x, y, z) in enumerate(nodes, start=1)] + ["$EndNodes", "$Elements", str(len(cells))]
    lines += [f"{n} 5 2 1 1 {' '.join(map(str, cell))}" for n, cell in enumerate(cells, start=1)]
    return "\n".join([*lines, "$EndElements", ""])


# Masses with inertia on contact nodes, with schemes that accept them.
LUMPED = [{"mass.type": "lumped", "time.scheme": "contact-stabilized", "time.preset": None}, {"mass.type": "lumped", **NEWMARK}]
WITH_INERTIA = [*LUMPED, *({**values, "mass.type": "consistent"} for values in LUMPED)]


def horn():
    """Returns a body of revolution made of two triangles of second order, whose first facet begins on the axis, with
    its midside node close to it."""
    nodes = [(0, 0), (1, 0), (0, 1), (1, 1), (0.4, 0.1), (0.5, 0.5), (0, 0.5), (1, 0.5), (0.5, 1)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '1 1 "bottom"', '2 2 "body"', "$EndPhysicalNames", "$Nodes", "9"]
    lines += [f"{n} {x} {y} 0" for n, (x, y) in enumerate(nodes, start=1)] + ["$EndNodes", "$Elements", "3"]
    return "\n".join([*lines, "1 8 2 1 1 1 2 5", "2 9 2 2 2 1 2 3 5 6 7", "3 9 2 2 2 2 4 3 8 9 6", "$EndElements", ""])


def arc(angle, text):
    """Returns a mesh of `strip` bent by a large angle, to a radius of 1 on one side."""
    return mapped(text, lambda x, y: ((1.0 + y) * math.sin(angle * (x - 0.5)), -(1.0 + y) * math.cos(angle * (x - 0.5))))


# Beside every case.
FILES = {
    "cell.msh": strip(1, 1, 1.0), "fine.msh": strip(24, 4, 1.0), "flat.msh": strip(8, 2, 0.25), "flat3.msh": strip(3, 2, 0.5),
    "flat12.msh": strip(12, 2, 0.5), "half.msh": mapped(strip(8, 4, 0.5), lambda x, y: (0.5 * x, y)), "long.msh": strip(1001, 1, 1.0),
    "ridge.msh": wedge(4), "rows.msh": strip(6, 4, 0.5, split=True), "slim.msh": strip(400, 1, 0.0005), "strip.msh": strip(8, 4, 1.0),
    "arc.msh": arc(0.3, strip(20, 2, 0.1)), "nearly-straight.msh": mapped(strip(20, 2, 0.1), lambda x, y: (x, y + 1e-5 * (x - 0.5)**2)),
    "shoe.msh": arc(5.6, strip(40, 2, 0.3)), "rod.msh": strip(4, 1, 0.2), "horn.msh": horn(),
    "bricks.msh": bricks(6, 4), "pin.txt": "0.05 -0.3\n0.05 0\n-0.05 0\n-0.05 -0.3\n0.05 -0.3\n",
}
ELASTIC = '[[material]]\ngroup = "all"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n'
STEPS = "[time]\nstep = 1e-3\nend = 0.1\n[output]\nfields_every = 0\n"
STATIC = '[initial]\ndisplacement = "static"\n'
GROUND = BLOCK + STATIC
NEO = {**KANE, "material.0.law": "neo-hookean"}
SIDEWAYS = {**KANE, "load.gravity": "[1.0, -10.0]"}
# Texts that are appended to a case.
HELD_X = '[[support]]\ngroup = "sides"\ncomponents = ["x"]\n'
CELL = ('[mesh]\nfile = "cell.msh"\n' + ELASTIC + f"[obstacle.floor]\n{PLANE}\n"
        '[[contact]]\ngroup = "boundary"\nobstacle = "floor"\n' + STEPS)
ROWS = ('[mesh]\nfile = "rows.msh"\n' + ELASTIC + '[obstacle.wall]\ntype = "plane"\npoint = [-0.1, 0.0]\nnormal = [1.0, 0.0]\n'
        '[[contact]]\ngroup = "left0"\nobstacle = "wall"\n[[contact]]\ngroup = "left1"\nobstacle = "wall"\nfriction = 0.3\n' + STEPS)
ON_FACETS = {"contact.0.multipliers": "p0", "contact.1.multipliers": "p0", "mesh.degree": 2}
TIED = ('[part.one]\nfile = "strip.msh"\n[part.two]\nfile = "fine.msh"\nmove = [1.0, 0.0]\n' + ELASTIC
        + '[obstacle.floor]\ntype = "plane"\npoint = [0.0, -0.1]\nnormal = [0.0, 1.0]\n[[contact]]\ngroup = "one.bottom"\n'
        'obstacle = "floor"\nmultipliers = "nodal"\n[[contact]]\ngroup = "one.right"\nagainst = "two.left"\ntied = true\n'
        'multipliers_on = "group"\n' + STEPS)
PIN = BLOCK.replace(PLANE, 'type = "surface"\nfile = "pin.txt"')
PRESSED_PAIR = PAIR + '[[support]]\ngroup = "two.sides"\ncomponents = ["x", "y"]\n'
TWO_DISCS = ('[part.one]\nfile = "{disc}"\n{more}[part.two]\nfile = "{disc}"\n{more}move = {move}\nturn = {{ angle = {turn} }}\n' + ELASTIC
             + '[[contact]]\ngroup = "one.boundary"\nagainst = "two.boundary"\n' + STEPS)
SECOND_ORDER = TWO_DISCS.format(disc=MESHES / "disc_o2_msh41_ascii.msh", more="", move=[0.3, 2.001], turn=0.0)
POLYGONS = TWO_DISCS.format(disc=MESHES / "disc.geo", more="size = 0.25\n", move=[0.0, 1.94], turn=10.0)
LONG = ('[mesh]\nfile = "long.msh"\n' + ELASTIC + f"[obstacle.floor]\n{PLANE}\n"
        '[[contact]]\ngroup = "bottom"\nobstacle = "floor"\n' + STEPS)
SLIM = '[mesh]\nfile = "slim.msh"\n' + ELASTIC + '[[support]]\ngroup = "left"\ncomponents = ["x", "y"]\n[load]\ngravity = [0.0, -1e-6]\n' + STEPS
BRICKS = '[mesh]\nfile = "bricks.msh"\n' + ELASTIC + "[load]\ngravity = [0.0, 0.0, -10.0]\n" + STEPS
# A block of half the length that comes from the right, lands on a slab and slides.
LANDS = ('[part.slab]\nfile = "flat.msh"\n[part.block]\nfile = "half.msh"\nmove = [0.9, 0.4]\nvelocity = [-1.0, -0.3]\n' + ELASTIC
         + '[[contact]]\ngroup = "block.bottom"\nagainst = "slab.top"\n[[support]]\ngroup = "slab.bottom"\ncomponents = ["x", "y"]\n'
         "[time]\nstep = 0.01\nend = 0.6\n[output]\nfields_every = 0\n")
STRIKES = {"part.block.move": "[0.7, 0.4]", "part.block.velocity": "[-2.0, -2.0]", "time.end": 0.13, "time.step": 0.005}
MEETS = ('[part.one]\nfile = "rows.msh"\nvelocity = [0.5, 0.0]\n[part.two]\nfile = "rows.msh"\nmove = [1.01, 0.0]\n' + ELASTIC
         + '[[contact]]\ngroup = "one.right0"\nagainst = "two.left0"\n[time]\nstep = 0.01\nend = 0.1\n')
RIDGE = ('[part.one]\nfile = "ridge.msh"\nvelocity = [0.0, 0.1]\n[part.two]\nfile = "flat3.msh"\nmove = [0.0, 1.51]\n'
         + ELASTIC.replace("100.0", "1.0") + '[[contact]]\ngroup = "one.top"\nagainst = "two.bottom"\n[time]\nstep = 0.02\nend = 1.0\n'
         "[output]\nfields_every = 0\n")
SHAKEN = {**NEWMARK, "contact.0.friction": 3.0, "initial.velocity": "[-2.41, -3.83]", "mesh.move": "[0.0, -0.1]", "mesh.refine": 1,
          "time.end": 0.3, "material.0.lambda": 500, "material.0.mu": 500}
HORN = ('[mesh]\nfile = "horn.msh"\nplane = "axisymmetric"\ndegree = 2\n' + ELASTIC + f"[obstacle.floor]\n{PLANE}\n"
        '[[contact]]\ngroup = "bottom"\nobstacle = "floor"\nfriction_bound = 1.0\nmultipliers = "nodal"\n' + STEPS)
ARC = ('[mesh]\nfile = "arc.msh"\n' + ELASTIC + '[obstacle.floor]\ntype = "plane"\npoint = [0.0, -1.3]\nnormal = [0.0, 1.0]\n'
       '[[contact]]\ngroup = ["bottom", "top"]\nobstacle = "floor"\n' + STEPS)
STRUCK = block_case().replace("gravity = [0.0, -10.0]", "gravity = [0.0, 0.0]") + (
    "[initial]\nvelocity = [0.0, -1.0]\ndisplacement = [0.0, 0.1]\n")
# Its arms swing together.
SHOE = ('[mesh]\nfile = "shoe.msh"\n' + ELASTIC + 'law = "neo-hookean"\n[[contact]]\ngroup = "boundary"\nagainst = "boundary"\n'
        'sliding = "large"\n[initial]\nvelocity = ["-15*x*(1+y)", "0"]\n[time]\nstep = 5e-3\nend = 0.02\n[output]\nfields_every = 0\n')
ROD = ('[mesh]\nfile = "rod.msh"\nmove = [0.0, 0.21]\nturn = { angle = 56.3 }\n' + ELASTIC.replace("100.0", "10.0") + f"[obstacle.floor]\n{PLANE}\n"
       '[[contact]]\ngroup = "boundary"\nobstacle = "floor"\nmultipliers = "dual"\nfriction_bound = 1000.0\n[load]\ngravity = [0.0, -10.0]\n'
       '[initial]\nvelocity = [-7.9, -1.3]\n[mass]\ntype = "consistent"\n[time]\nscheme = "midpoint"\nstep = 0.1\nend = 1.2\n')
