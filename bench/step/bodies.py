"""The disc and the ball that benchmarks drop onto a floor or onto another one: their meshes and case files."""

import pathlib
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
STEP = 1e-3
STEPS = 160  # the body is in contact from step 92 on


def mesh(directory, name, dimension, size):
    path = directory / f"{name}-{size:g}.msh"
    if not path.exists():
        subprocess.run(["gmsh", str(HERE / f"{name}.geo"), f"-{dimension}", "-setnumber", "size", repr(size), "-format", "msh22",
                        "-o", str(path), "-v", "0"], check=True)
    return path


NEWMARK = f'scheme = "newmark"\npreset = "textbook-half"\nstep = {STEP}\nend = {STEP * STEPS}\n'


def case(directory, body, mass="equivalent", friction=0.0, method="direct", time=NEWMARK, down=0.0, output="fields_every = 0\n"):
    """Returns the path of a case file; `time` and `output` are its sections, `down` is the distance by which the body
    starts closer to the floor."""
    name, dimension, size = body
    zeros = ", ".join(["0.0"] * (dimension - 1))
    path = directory / f"{name}-{size:g}-{mass}-{friction:g}{'-' if method else ''}{method}.toml"
    sliding = 0.5 if friction > 0.0 else 0.0
    solver = f'[solver]\nmethod = "{method}"\n' if method else ""
    path.write_text(
        f'[mesh]\nfile = "{mesh(directory, *body)}"\n[[material]]\ngroup = "body"\ndensity = 1.0\nlambda = 1e4\nmu = 5e3\n'
        f'[obstacle.floor]\ntype = "plane"\npoint = [{zeros}, 0.0]\nnormal = [{zeros}, 1.0]\n'
        f'[[contact]]\ngroup = "lower"\nobstacle = "floor"\nfriction = {friction}\n[load]\ngravity = [{zeros}, -9.81]\n'
        f'[initial]\ndisplacement = [{zeros}, {-down!r}]\nvelocity = [{", ".join([repr(sliding)] + ["0.0"] * (dimension - 2))}, -1.0]\n'
        f'[mass]\ntype = "{mass}"\n[time]\n{time}[output]\n{output}{solver}')
    return path


def pair_case(directory, pair, friction=0.0):
    """Returns the path of a case file with two bodies of different cells, one of which strikes the other, free one at
    step 20. They separate at about step 110. The scheme is the default one."""
    name, dimension, size, other = pair
    below = [0.0] * (dimension - 1)
    path = directory / f"two-{name}s-{size:g}-{friction:g}.toml"
    turn = "{ angle = 180 }" if dimension == 2 else "{ axis = [1, 0, 0], angle = 180 }"
    path.write_text(
        f'[part.upper]\nfile = "{mesh(directory, name, dimension, size)}"\nmove = {below + [-0.06]}\n'
        f'velocity = {[2.0 if friction > 0.0 else 0.0] + below[1:] + [-4.0]}\n'
        f'[part.lower]\nfile = "{mesh(directory, name, dimension, other)}"\nturn = {turn}\nmove = {below + [0.06]}\n'
        f'[[material]]\ngroup = "all"\ndensity = 1.0\nlambda = 1e4\nmu = 5e3\n'
        f'[[contact]]\ngroup = "upper.lower"\nagainst = "lower.lower"\nfriction = {friction}\n[mass]\ntype = "equivalent"\n'
        f'[time]\nstep = {STEP}\nend = {STEP * STEPS}\n[output]\nfields_every = 0\n[solver]\nmethod = "direct"\n')
    return path
