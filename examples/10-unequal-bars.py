"""A long bar strikes a short one of the same material: a restitution below 1 without any loss of energy.

Physics (Saint-Venant): fronts with the pressure rho c V / 2 travel into both bars. The front in the short bar has returned after 2 l / c.
The short bar then leaves the contact with the velocity V and without vibration. The long bar keeps a wave and moves at V (1 - l / L) on
average. Newton's coefficient of restitution is therefore l / L although no energy is lost: the rest is vibration of the long bar.

The example shows: two bodies in one mesh of arrays, contact between bodies, probes of groups, momentum exchange.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import ricochet as rc

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/10-unequal-bars")
h, height, V = 0.01, 0.04, 0.01  # E = rho = 1, so that c = 1


def bar(x0, x1):
    """Points, quads and side lines of a strip that is two cells high."""
    n = round((x1 - x0) / h)
    x, y = np.meshgrid(np.linspace(x0, x1, n + 1), np.linspace(0, height, 3), indexing="ij")
    corner = (np.arange(n)[:, None] * 3 + np.arange(2)).ravel()
    sides = np.concatenate([[[3 * i + j, 3 * i + 3 + j] for i in range(n)] for j in (0, 2)])
    return np.column_stack([x.ravel(), y.ravel()]), np.column_stack([corner, corner + 3, corner + 4, corner + 1]), sides


def two_bars(long, short):
    (a, cells_a, sides_a), (b, cells_b, sides_b) = bar(-long, 0), bar(0, short)
    quads = np.concatenate([cells_a, cells_b + len(a)])
    return rc.Mesh(np.concatenate([a, b]), {"quad": quads}, {
        "long": {0: np.arange(len(cells_a))}, "short": {0: len(cells_a) + np.arange(len(cells_b))},
        "end": {"line": [[len(a) - 3, len(a) - 2], [len(a) - 2, len(a) - 1]]},
        "face": {"line": [[len(a), len(a) + 1], [len(a) + 1, len(a) + 2]]},
        "sides": {"line": np.concatenate([sides_a, sides_b + len(a)])}})


figure, (motion, law) = plt.subplots(1, 2, figsize=(9, 3.4), constrained_layout=True)
found = []
for short in (0.25, 0.5, 0.75, 1.0):
    case = {
        "title": f"A bar of length 1 strikes one of length {short}",
        "material": [{"group": "all", "density": 1.0, "young": 1.0, "poisson": 0.0}],
        "contact": [{"group": "face", "against": "end"}],
        "support": [{"group": "sides", "components": ["y"]}],
        "motion": [{"group": "long", "velocity": [V, 0]}],
        "probe": [{"name": "long", "group": "long"}, {"name": "short", "group": "short"}],
        "time": {"step": 0.5 * h, "end": 4.0},
        "output": {"fields_every": 0},
    }
    run = rc.run(case, out / f"short-{short}", mesh=two_bars(1.0, short), force=True)
    history = run.history
    slow, fast = history["long.velocity_average_x"], history["short.velocity_average_x"]
    restitution = (fast[-1] - slow[-1]) / V
    found.append(restitution)
    momentum = history["momentum_x"]
    print(f"l / L = {short}: velocities / V {slow[-1] / V:.4f}, {fast[-1] / V:.4f}; restitution {restitution:.4f}")
    assert abs(restitution - short) < 0.02, "not Saint-Venant's restitution"
    assert np.ptp(momentum) < 1e-12 * momentum[0], "momentum is not conserved"
    assert np.ptp(history["total_energy"]) < 1e-9 * history["total_energy"][0]
    if short == 0.5:
        motion.plot(run.time, slow / V, label="long bar, mean")
        motion.plot(run.time, fast / V, label="short bar, mean")
motion.set(xlabel="t c / L", ylabel="velocity / V", title="l / L = 0.5")
law.plot([0, 1], [0, 1], color="0.7", linewidth=4, label="Saint-Venant")
law.plot([0.25, 0.5, 0.75, 1.0], found, "o", label="runs")
law.set(xlabel="l / L", ylabel="restitution")
for axes in (motion, law):
    axes.legend(fontsize=8)
figure.savefig(out / "picture.png", dpi=80)
