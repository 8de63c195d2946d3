#!/usr/bin/env python3
"""Draws disc-energy.png and disc-force.png beside this file from the histories that ./dev demo leaves in out/disc.

Needs python3-matplotlib (Debian: apt-get install python3-matplotlib). Run it from anywhere: python3 docs/figures/disc.py
"""

import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)

HERE = pathlib.Path(__file__).resolve().parent
RUNS = HERE.parents[1] / "out" / "disc"
COLOURS = {"midpoint": "#b3261e", "klr-conserving": "#1f5fa8", "newmark": "#1b7f4d"}
LABELS = {
    "midpoint": "midpoint, consistent mass",
    "klr-conserving": "klr-conserving, consistent mass",
    "newmark": "newmark (½, ½), equivalent mass",
}


def read(run, column, shift=0.0):
    """Times (moved by `shift` steps) and values of a column of a run's history."""
    with open(RUNS / run / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    step = float(rows[1]["time"])
    return [float(row["time"]) + shift * step for row in rows], [float(row[column]) for row in rows]


def draw_energy():
    figure, (near, far) = plt.subplots(1, 2, figsize=(10, 3.6))
    # klr-conserving accounts for energy at n + 1/2.
    for run, shift in (("klr-conserving", 0.5), ("newmark", 0.0)):
        times, energy = read(run, "total_energy", shift)
        near.plot(times, [1e2 * (e / energy[0] - 1.0) for e in energy], color=COLOURS[run], label=LABELS[run], lw=1.2)
    near.set_title("energy: change in percent of the initial energy", fontsize=10)
    near.set_ylabel("%")
    near.set_ylim(-0.05, 0.03)
    for run, shift in (("midpoint", 0.0), ("klr-conserving", 0.5), ("newmark", 0.0)):
        times, energy = read(run, "total_energy", shift)
        far.semilogy(times, [e / energy[0] for e in energy], color=COLOURS[run], label=LABELS[run], lw=2.5 if shift else 1.2)
    far.set_title("energy / initial energy, logarithmic", fontsize=10)
    finish(figure, (near, far), "disc-energy.png")


def draw_force():
    figure, (rattling, smooth) = plt.subplots(1, 2, figsize=(10, 3.6))
    for axes, run in ((rattling, "klr-conserving"), (smooth, "newmark")):
        times, force = read(run, "lowest.reaction_normal")
        axes.plot(times, force, color=COLOURS[run], label=LABELS[run], lw=0.7 if axes is rattling else 1.2)
        axes.set_ylabel("N per metre")
    rattling.set_title("contact force at the lowest node", fontsize=10)
    smooth.set_title("contact force at the lowest node, smaller scale", fontsize=10)
    finish(figure, (rattling, smooth), "disc-force.png")


def finish(figure, all_axes, name):
    for axes in all_axes:
        axes.set_xlabel("time, s")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8, loc="best")
    figure.tight_layout()
    figure.savefig(HERE / name, dpi=80)
    plt.close(figure)


if __name__ == "__main__":
    draw_energy()
    draw_force()
