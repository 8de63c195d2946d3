"""A bar strikes a wall: the mesh is made from arrays and the case from a dictionary, without any file.

Physics: with Poisson's ratio 0 the strip is a rod. A front with the pressure rho c v travels from the wall to the free end and back.
Contact therefore lasts 2 L / c under the constant force rho c v per area, and the bar leaves with the speed at which it arrived.

The example shows: rc.Mesh from arrays with groups of nodes, a dictionary as a case, comparison of the history with a closed form.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/03-arrays-and-a-dictionary")

nx, ny, L, width = 100, 2, 1.0, 0.05
rho, E, v = 7800.0, 2.1e11, 5.0
c = np.sqrt(E / rho)
x, y = np.meshgrid(np.linspace(0, L, nx + 1), np.linspace(0, width, ny + 1), indexing="ij")
points = np.column_stack([x.ravel(), y.ravel()])
corner = (np.arange(nx)[:, None] * (ny + 1) + np.arange(ny)).ravel()
cells = np.column_stack([corner, corner + ny + 1, corner + ny + 2, corner + 1])
sides = {"line": np.concatenate([[[i * (ny + 1) + j, (i + 1) * (ny + 1) + j] for i in range(nx)] for j in (0, ny)])}
mesh = rc.Mesh(points, {"quad": cells}, {"end": np.flatnonzero(points[:, 0] == 0), "sides": sides})

gap = 0.1 * L * v / c  # contact begins at 0.1 L / c
case = {
    "title": "A steel bar strikes a wall",
    "material": [{"group": "all", "density": rho, "young": E, "poisson": 0.0}],
    "obstacle": {"wall": {"type": "plane", "point": [-gap, 0], "normal": [1, 0]}},
    "contact": [{"group": "end", "obstacle": "wall"}],
    "support": [{"group": "sides", "components": ["y"]}],
    "initial": {"velocity": [-v, 0]},
    "time": {"step": 0.5 * L / nx / c, "end": 3 * L / c},
    "output": {"fields_every": 50},
}
run = rc.run(case, out, mesh=mesh, force=True)
time, force = run.time * c / L, run.history["contact_force_x"] / (rho * c * v * width)
impulse = run.history["momentum_x"][-1] - run.history["momentum_x"][0]
mass = rho * L * width
middle = force[(time > 0.3) & (time < 1.9)].mean()

print(f"force / (rho c v A) {middle:.4f} (closed form 1)")
print(f"impulse / (2 m v) {impulse / (2 * mass * v):.4f} (closed form 1)")
print(f"last force at t c / L = {time[force > 0.5][-1]:.3f} (closed form 2.1)")
assert abs(middle - 1) < 0.01
assert abs(impulse / (2 * mass * v) - 1) < 0.01
assert abs(time[force > 0.5][-1] - 2.1) < 0.03

figure, axes = plt.subplots(figsize=(6, 3.2), constrained_layout=True)
axes.plot([0, 0.1, 0.1, 2.1, 2.1, 3], [0, 0, 1, 1, 0, 0], color="0.7", linewidth=4, label="closed form")
axes.plot(time, force, label="Ricochet")
axes.set(xlabel="t c / L", ylabel="force / (ρ c v A)")
axes.legend(fontsize=8)
figure.savefig(out / "picture.png", dpi=80)
