"""A spring pulls a block over a rough floor. The other end of the spring, the puller, moves at a constant speed and then stops.

Physics: the block sticks until the force of the spring reaches k X = F m g at the time t_0. Then m x'' = k (X - x) - F m g with X = V t.
The motion is x = V s - V/w sin(w s) with s = t - t_0 and w² = k / m, and the block is at rest for an instant after each period. After
the puller has stopped, the block comes to rest, at any position at which the spring does not overcome friction, |k (X - x)| <= F m g.

The example shows: set_load in every step, contact_status, a closed form over many steps.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/07-stick-and-slip")
out.mkdir(parents=True, exist_ok=True)

nx, ny, length, height = 12, 2, 0.2, 0.02
x, y = np.meshgrid(np.linspace(0, length, nx + 1), np.linspace(0, height, ny + 1))
points = np.column_stack([x.ravel(), y.ravel()])
corner = (np.arange(ny)[:, None] * (nx + 1) + np.arange(nx)).ravel()
mesh = rc.Mesh(points, {"quad": np.column_stack([corner, corner + 1, corner + nx + 2, corner + nx + 1])},
               {"bottom": np.flatnonzero(points[:, 1] == 0)})
density, g, friction, V, stop, k = 1000.0, 9.81, 0.4, 0.1, 1.2, 400.0
mass = density * length * height
weight = mass * g

case = {
    "title": "A block pulled by a spring",
    "material": [{"group": "all", "density": density, "young": 1e8, "poisson": 0.0, "damping": {"stiffness": 1e-4}}],
    "obstacle": {"floor": {"type": "plane", "point": [0, 0], "normal": [0, 1]}},
    "contact": [{"group": "bottom", "obstacle": "floor", "friction": friction}],
    "load": {"gravity": [0, -g]},
    "initial": {"displacement": "static"},
    "time": {"step": 5e-4, "end": 2.0},
}
session = rc.Session(case, mesh=mesh)
session.start()
share = np.asarray(session.mass.sum(axis=1)).ravel()[::2] / mass  # the spring acts on the whole body, as gravity does

rows = []
while session.time < session.end:
    position = share @ session.displacement[:, 0]
    pull = k * (V * min(session.time, stop) - position)
    session.set_load(np.column_stack([share * pull, np.zeros_like(share)]))
    session.step()
    rows.append((session.time, share @ session.displacement[:, 0], share @ session.velocity[:, 0], pull,
                 (session.contact_status == rc.contact.STICK).all(),
                 (session.contact_status == rc.contact.SLIP).all()))
time, position, velocity, pull, sticks, slips = np.array(rows).T

begin = friction * weight / (k * V)
w = np.sqrt(k / mass)
s = np.clip(time - begin, 0, None)
exact = V * s - V / w * np.sin(w * s)
pulled = time < stop
error = abs(position - exact)[pulled].max() / exact[pulled][-1]
print(f"first slip at {time[slips > 0][0]:.4f} s (closed form {begin:.4f} s)")
print(f"motion within {100 * error:.2f} % of the closed form while the puller moves")
print(f"largest speed {velocity[pulled].max() / V:.4f} V (closed form 2 V)")
print(f"at the end: spring {pull[-1] / (friction * weight):.3f} of what friction holds, speed {velocity[-1]:.1e} m/s")
assert abs(time[slips > 0][0] - begin) < 0.01, "it slips at another force"
assert error < 0.01, "it does not move as the closed form"
assert abs(velocity[pulled].max() / V - 2) < 0.03
assert abs(velocity[-1]) < 1e-6 and abs(pull[-1]) <= friction * weight and sticks[-1], "it does not rest"

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), constrained_layout=True)
left.plot(time, 1e3 * V * np.minimum(time, stop), color="k", linewidth=0.8, label="puller")
left.plot(time[pulled], 1e3 * exact[pulled], color="0.7", linewidth=5, label="closed form")
left.plot(time, 1e3 * position, label="block")
left.set(xlabel="time, s", ylabel="position, mm")
right.axhspan(-1, 1, color="0.9", label="friction holds it")
right.plot(time, pull / (friction * weight), label="spring / (F m g)")
right.plot(time, velocity / V, label="speed / V")
right.set(xlabel="time, s")
for axes in (left, right):
    axes.legend(fontsize=8)
figure.savefig(out / "picture.png", dpi=80)
