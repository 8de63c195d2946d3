"""A ball strikes a plane slowly: force over indentation, compared with Hertz.

Physics: P = 4/3 E* sqrt(R) d^(3/2), E* = E / (1 - nu²), where d is the distance by which the centre of mass has approached the plane
since the first touch. In a slow impact waves are negligible. Hertz' contact is then a spring: its largest force follows from the
energy, and contact lasts 2.943 d_max / v. The remaining difference of 1 % arises because a ball is not a half-space (see cases/hertz).

The example shows: a callback in every step, the mass matrix (of scipy) for the centre of mass, an axisymmetric body.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/06-hertz")
out.mkdir(parents=True, exist_ok=True)

case = pathlib.Path(__file__).resolve().parents[1] / "cases/ball-axisymmetric/impact-axisymmetric.toml"
session = rc.Session(case)
session.start()
weight = np.asarray(session.mass.sum(axis=1)).ravel()[1::2]  # the inertia of each node along the axis
weight /= weight.sum()

rows = []
session.run(lambda s: rows.append((s.time, -weight @ s.displacement[:, 1], s.contact_force[:, 1].sum())))
time, indentation, force = np.array(rows).T

stiffness, v = 4 / 3 / (1 - 0.3**2), 3e-5  # E = rho = R = 1
hertz = stiffness * np.clip(indentation, 0, None) ** 1.5
mass = 4 / 3 * np.pi
deepest = (15 * mass * v**2 / (16 / (1 - 0.3**2))) ** 0.4
print(f"largest force {force.max():.5g}, Hertz {stiffness * deepest**1.5:.5g}")
print(f"largest indentation {indentation.max():.5g}, Hertz {deepest:.5g}")
print(f"contact lasts {time[force > 0][-1]:.2f}, Hertz {2.943 * deepest / v:.2f}")

assert abs(force - hertz).max() < 0.03 * hertz.max(), "the curve of force is not that of Hertz"
assert abs(force.max() / (stiffness * deepest**1.5) - 1) < 0.015
assert abs(indentation.max() / deepest - 1) < 0.015
assert abs(time[force > 0][-1] / (2.943 * deepest / v) - 1) < 0.015

figure, axes = plt.subplots(figsize=(6, 3.4), constrained_layout=True)
d = np.linspace(0, deepest, 200)
axes.plot(d, stiffness * d**1.5, color="0.7", linewidth=5, label="Hertz")
axes.plot(indentation, force, linewidth=1, label="in and out again")
axes.set(xlabel="indentation d / R", ylabel="force P / (E R²)")
axes.legend(fontsize=8)
figure.savefig(out / "picture.png", dpi=80)
