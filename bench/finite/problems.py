"""Problems of finite strain for both programs: meshes and case files."""

import pathlib
import subprocess

import bodies

HERE = pathlib.Path(__file__).resolve().parent
LAMBDA, MU, DENSITY = 1e4, 5e3, 1.0  # Poisson's ratio 1/3
STEP = bodies.STEP
FLIGHT = 2  # steps

# Time schemes: their section of the case file, by their name in getfem_finite.py.
SCHEMES = {"newmark": 'scheme = "newmark"\npreset = "textbook-half"', "trapezoidal": 'scheme = "newmark"\npreset = "trapezoidal"',
           "midpoint": 'scheme = "midpoint"', "reduced-kane": 'scheme = "reduced-kane"', "mean-reaction": 'scheme = "mean-reaction"'}


def gap(speed):
    """Returns the initial gap of falling bodies: they touch in the third step."""
    return (FLIGHT + 0.5) * STEP * speed


def pressed_mesh(directory, name, dimension, size):
    """Makes a mesh of block.geo or half.geo."""
    path = directory / f"{name}-{dimension}d-{size:g}.msh"
    if not path.exists():
        subprocess.run(["gmsh", str(HERE / f"{name}.geo"), f"-{dimension}", "-setnumber", "dimension", str(dimension), "-setnumber", "size",
                        repr(size), "-format", "msh22", "-o", str(path), "-v", "0"], check=True)
    return path


def sections(mesh, dimension, friction, mass, time, law):
    """Returns the common sections of all cases."""
    zeros = ", ".join(["0.0"] * (dimension - 1))
    dilatation = 'dilatation = "pointwise"\n' if law != "linear" else ""
    return (f'[mesh]\nfile = "{mesh}"\n[[material]]\ngroup = "body"\ndensity = {DENSITY}\nlaw = "{law}"\nlambda = {LAMBDA}\nmu = {MU}\n{dilatation}'
            f'[obstacle.floor]\ntype = "plane"\npoint = [{zeros}, 0.0]\nnormal = [{zeros}, 1.0]\n'
            f'[[contact]]\ngroup = "lower"\nobstacle = "floor"\nfriction = {friction}\nmultipliers = "nodal"\n'
            f'[mass]\ntype = "{mass}"\n[time]\n{time}[solver]\nmethod = "direct"\n[output]\nfields_every = 0\n')


def pressed(directory, body, press, friction):
    """Writes the case of a body whose top is held and pressed down by a fraction of its height, in equilibrium. Returns
    its path."""
    name, dimension, size = body
    mesh = pressed_mesh(directory, name, dimension, size)
    text = sections(mesh, dimension, friction, "consistent", f'{SCHEMES["newmark"]}\nstep = {STEP}\nend = {STEP}\n', "neo-hookean")
    across = ", ".join(f'"{axis}"' for axis in "xy"[:dimension - 1])
    text += (f'[[support]]\ngroup = "top"\ncomponents = [{across}]\n'
             f'[[support]]\ngroup = "top"\ncomponents = ["{"xyz"[dimension - 1]}"]\nvalue = {-press!r}\n[initial]\ndisplacement = "static"\n')
    path = directory / f"pressed-{name}-{dimension}d-{size:g}-{press:g}-{friction:g}.toml"
    path.write_text(text)
    return path


def falling_mesh(directory, body):
    """Makes the mesh of the disc or the ball of bench/step; their lowest point is 0.1 above the floor."""
    return bodies.mesh(directory, *body)


def falling(directory, body, speed, friction, scheme, steps, mass=None, law="neo-hookean", step=STEP):
    """Writes the case of a disc or ball that falls at this speed, `gap` above the floor. Returns its path."""
    name, dimension, size = body
    mass = mass or ("equivalent" if scheme in ("reduced-kane", "mean-reaction") else "consistent")
    zeros = ["0.0"] * (dimension - 1)
    sliding = [repr(0.5 * speed if friction > 0.0 else 0.0)] + zeros[1:]
    text = sections(falling_mesh(directory, body), dimension, friction, mass, f"{SCHEMES[scheme]}\nstep = {step!r}\nend = {step * steps!r}\n", law)
    text += (f'[initial]\ndisplacement = [{", ".join(zeros)}, {gap(speed) - 0.1!r}]\n'
             f'velocity = [{", ".join(sliding)}, {-speed!r}]\n')
    path = directory / f"{name}-{size:g}-{speed:g}-{friction:g}-{scheme}-{mass}-{law}-{step:g}.toml"
    path.write_text(text)
    return path
