"""A disc bounces under five schemes: energy and contact force.

Physics: without gravity, friction and damping the total energy is always m v²/2, and the contact force is one smooth hump. Its impulse is
at most 2 m v; the difference is due to vibrations that remain in the disc. Textbook schemes with inertia on the contact nodes create
energy, make the force oscillate, or lose energy. The default, with the equivalent mass, does none of these.

The example shows: runs of one dictionary that differ in scheme and mass, and the variation of a force as a measure.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/08-schemes")
mesh = pathlib.Path(__file__).resolve().parents[1] / "cases/disc/disc.msh"

v, density = 0.1, 6000.0
case = {
    "title": "A disc strikes a foundation",
    "mesh": {"file": mesh},
    "material": [{"group": "body", "density": density, "lambda": 1e6, "mu": 5e5}],
    "obstacle": {"foundation": {"type": "plane", "point": [0, 0], "normal": [0, 1]}},
    "contact": [{"group": "lower", "obstacle": "foundation"}],
    "initial": {"velocity": [0, -v]},
    "time": {"step": 4e-5, "end": 0.03},
    "output": {"fields_every": 0},
}
schemes = {
    "reduced-kane, equivalent mass": {},
    "Newmark 1/2, equivalent mass": {"time.scheme": "newmark", "time.preset": "textbook-half"},
    "trapezoidal rule, consistent mass": {"time.scheme": "newmark", "time.preset": "trapezoidal", "mass.type": "consistent"},
    "Moreau-Jean, consistent mass": {"time.scheme": "moreau-jean", "mass.type": "consistent"},
    "generalized-alpha, consistent mass": {"time.scheme": "generalized-alpha", "mass.type": "consistent"},
}
rc.set_log_level("error")  # the library would warn that contact creates energy, which this example demonstrates
runs = {}
for number, (name, changes) in enumerate(schemes.items()):
    runs[name] = run = rc.run(case, out / f"run-{number}", changes, force=True)
    energy, force = run.history["total_energy"], run.history["contact_force_y"]
    roughness = abs(np.diff(force)).sum() / (2 * force.max())
    print(f"{name:36s} energy from {energy.min() / energy[0]:.5f} to {energy.max() / energy[0]:.5f} of m v²/2, largest force "
          f"{force.max():.1f} N/m, its variation {roughness:.2f} (one hump: 1)")

run = runs["reduced-kane, equivalent mass"]
energy, force, momentum = (run.history[name] for name in ("total_energy", "contact_force_y", "momentum_y"))
mass = -momentum[0] / v
impulse = run.impacts[0]["impulse"][1]
print(f"impulse / (2 m v) {impulse / (2 * mass * v):.4f}")
assert np.isclose(energy[0], mass * v**2 / 2, rtol=1e-12), "the energy at the start is not m v²/2"
assert np.ptp(energy) < 1e-9 * energy[0], "the default does not keep the energy"
assert np.isclose(impulse, momentum[-1] - momentum[0], rtol=1e-9) and 0.98 < impulse / (2 * mass * v) <= 1
assert abs(np.diff(force)).sum() / (2 * force.max()) < 1.5, "the default's force is not smooth"

figure, axes = plt.subplots(2, 1, figsize=(8, 5.5), sharex=True, constrained_layout=True)
for name, run in reversed(runs.items()):  # draws the default last, over the others
    width = 2.5 if name.startswith("reduced-kane") else 0.8
    axes[0].plot(1e3 * run.time, run.history["total_energy"] / energy[0], linewidth=width, label=name)
    axes[1].plot(1e3 * run.time, run.history["contact_force_y"], linewidth=width)
axes[0].set(ylabel="energy / (m v²/2)", yscale="log")
axes[1].set(ylabel="contact force, N/m", xlabel="time, ms")
axes[0].legend(fontsize=8)
figure.savefig(out / "picture.png", dpi=80)
