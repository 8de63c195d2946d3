"""A controller measures the contact force and presses a plate on a block.

Physics: the plate moves down with a velocity in proportion to the error of the force. The block of height H and width w does not
widen (Poisson's ratio 0) and acts as a spring of stiffness E w / H per depth. Under the force P the plate has moved down by
P H / (E w), and it has done the work P² H / (2 E w), plus the energy that the block has lost by damping.

The example shows: a Session, set_obstacle_velocity in a loop, views of the state, the energy account.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/02-own-loop")
out.mkdir(parents=True, exist_ok=True)

n, H, w, E = 8, 0.1, 0.1, 2e6
x, y = np.meshgrid(np.linspace(0, w, n + 1), np.linspace(0, H, n + 1))
points = np.column_stack([x.ravel(), y.ravel()])
corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
mesh = rc.Mesh(points, {"quad": np.column_stack([corner, corner + 1, corner + n + 2, corner + n + 1])},
               {"bottom": np.flatnonzero(points[:, 1] == 0), "top": np.flatnonzero(points[:, 1] == H)})

case = {
    "title": "A plate under control",
    "material": [{"group": "all", "density": 1200.0, "young": E, "poisson": 0.0, "damping": {"mass": 300.0}}],
    "support": [{"group": "bottom", "components": ["x", "y"]}],
    "obstacle": {"plate": {"type": "plane", "point": [0, H + 1e-4], "normal": [0, -1]}},
    "contact": [{"group": "top", "obstacle": "plate"}],
    "time": {"step": 1e-4, "end": 0.4},
}
session = rc.Session(case, mesh=mesh)
session.set_obstacle_velocity("plate", [0.0, 0.0])  # before the start: announces that this plate moves

plate, rows = 0.0, []
while session.time < session.end:
    target = 2000.0 if session.time < 0.2 else 1000.0  # N per metre of depth
    force = session.reactions.sum()
    velocity = -float(np.clip(2e-5 * (target - force), -0.02, 0.02))
    session.set_obstacle_velocity("plate", [0.0, velocity])
    before = session.time
    session.step()
    plate += velocity * (session.time - before)
    rows.append((session.time, session.reactions.sum(), plate, target))
time, force, plate, target = np.array(rows).T

depth = -plate[-1] - 1e-4  # the plate starts 0.1 mm above the block
expected = 1000.0 * H / (E * w)
energies = session.energies
print(f"force {force[-1]:.3f} N/m (asked 1000), before the change {force[time < 0.2][-1]:.3f} (asked 2000)")
print(f"indentation {1e3 * depth:.5f} mm, closed form {1e3 * expected:.5f} mm")
print(f"work of the plate {energies['obstacle_work']:.6f} J/m, account within {energies['energy_residual']:.1e} J/m")

assert abs(force[-1] - 1000) < 1 and abs(force[time < 0.2][-1] - 2000) < 2, "the controller misses its target"
assert abs(depth / expected - 1) < 5e-3, "the block is not the spring that it should be"
assert abs(energies["energy_residual"]) < 1e-9 * abs(energies["obstacle_work"])

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.2), constrained_layout=True)
left.plot(time, target, color="0.7", linewidth=4, label="asked")
left.plot(time, force, label="contact force")
left.set(xlabel="time, s", ylabel="force, N/m")
right.plot(time, 1e3 * plate)
right.axhline(-1e3 * (expected + 1e-4), color="0.7", zorder=0, label="closed form, in the end")
right.set(xlabel="time, s", ylabel="position of the plate, mm")
for axes in (left, right):
    axes.legend(fontsize=8)
figure.savefig(out / "picture.png", dpi=80)
