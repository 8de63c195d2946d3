"""The order of a scheme: a block stays pressed on a floor while its load varies, and the step is halved repeatedly.

Physics: if contact stays closed and loads are smooth in time, the motion is smooth, and with half the step a scheme of second order
has a quarter of the error. The exact solution in time is not needed: the differences between the results of successive steps
decrease by the same factor, 4 (Richardson).

The example shows: rc.study over a key of the case, its table (a pandas table if pandas is installed), and its runs.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/05-order-of-steps")

n = 6
x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
points = np.column_stack([x.ravel(), y.ravel()])
corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
mesh = rc.Mesh(points, {"quad": np.column_stack([corner, corner + 1, corner + n + 2, corner + n + 1])},
               {"bottom": np.flatnonzero(points[:, 1] == 0), "top": np.flatnonzero(points[:, 1] == 1)})
case = {
    "title": "A block under a load that swells",
    "material": [{"group": "all", "density": 1.0, "young": 1.0, "poisson": 0.3}],
    "obstacle": {"floor": {"type": "plane", "point": [0, 0], "normal": [0, 1]}},
    "contact": [{"group": "bottom", "obstacle": "floor"}],
    "traction": [{"group": "top", "value": ["0", "-1e-3*(1 + 0.2*sin(t/4)^4)"]}],
    "initial": {"displacement": "static"},
    "probe": [{"name": "top", "at": [0.5, 1.0]}],
    "time": {"step": 0.5, "end": 8.0},
    "output": {"fields_every": 0},
}
steps = [0.5 / 2**k for k in range(6)]
study = rc.study(case, {"time.step": steps}, out / "study", mesh=mesh, jobs=2, force=True,
                 quantities=["history.top.displacement_y[-1]", "min(history.active_contacts)"])
table = study.table
columns = ["time.step", "history.top.displacement_y[-1]", "min(history.active_contacts)"]
print(table[columns].to_string(index=False) if hasattr(table, "to_string") else table)  # with or without pandas

value = study["history.top.displacement_y[-1]"]
differences = abs(np.diff(value))
orders = np.log2(differences[:-1] / differences[1:])
print("orders of successive steps:", np.round(orders, 3))
assert (study["min(history.active_contacts)"] == n + 1).all(), "contact has opened: the motion is not smooth"
assert abs(orders[-1] - 2) < 0.1, "the scheme is not of second order"

figure, axes = plt.subplots(figsize=(5, 3.4), constrained_layout=True)
axes.loglog(steps[1:], differences[-1] * (np.array(steps[1:]) / steps[-1]) ** 2, color="0.7", linewidth=4, label="slope 2")
axes.loglog(steps[1:], differences, "o-", label="difference to twice the step")
axes.set(xlabel="step", ylabel="displacement of the top")
axes.legend(fontsize=8)
figure.savefig(out / "picture.png", dpi=80)
