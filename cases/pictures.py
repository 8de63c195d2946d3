#!/usr/bin/env python3
"""Draws the pictures of the cases' READMEs: runs the cases into out/pictures and plots their history.csv beside the
closed forms. From the repository root, with python3-matplotlib installed:

    /usr/bin/python3 cases/pictures.py [disc rod bar ball]
"""
import csv
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

EXACT = {"color": "0.6", "linewidth": 4, "solid_capstyle": "butt"}


def run(case, name, *settings):
    """The columns of history.csv by name, as arrays."""
    directory = f"out/pictures/{name}"
    command = ["build/ricochet", "run", f"cases/{case}.toml", "-o", directory, "--force", "--quiet", "--log-level", "error"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(f"{directory}/history.csv", newline="") as file:
        rows = csv.reader(file)
        names = next(rows)
        return dict(zip(names, np.array([[float(entry) for entry in row] for row in rows]).T))


def save(figure, path):
    for axes in figure.axes:
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=80)
    print(path)


def disc():
    figure, (energy, force) = plt.subplots(1, 2, figsize=(10, 3.6))
    for scheme, mass in (("midpoint", "consistent"), ("klr-conserving", "consistent"), ("newmark", "equivalent")):
        history = run("disc/disc", f"disc-{scheme}", f"time.scheme={scheme}", f"mass.type={mass}")
        label = f"{scheme}, {mass} mass"
        milliseconds = 1e3 * history["time"]
        line = "--" if scheme == "newmark" else "-"  # it would hide the one below
        energy.semilogy(milliseconds, history["total_energy"] / history["total_energy"][0], line, label=label)
        if scheme != "midpoint":
            style = {"linewidth": 0.5, "color": "C1"} if mass == "consistent" else {"linewidth": 1.6, "color": "C2"}
            force.plot(milliseconds, history["lowest.reaction_normal"], label=label, **style)
    energy.set(xlabel="time, ms", title="total energy / its value at the start")
    force.set(xlabel="time, ms", title="contact force at the lowest node, N/m", ylim=(0, 90))
    energy.legend(loc="center right")
    force.legend(loc="upper right")
    save(figure, "cases/disc/disc.png")


def rod():
    figure, (displacement, pressure) = plt.subplots(1, 2, figsize=(10, 3.4))
    time = np.linspace(0, 6, 6001)
    phase = time % 3
    displacement.plot(time, np.select([phase < 1, phase < 2], [0.5 - phase / 2, 0 * phase], (phase - 2) / 2), **EXACT)
    pressure.plot(time, np.where((phase > 1) & (phase < 2), 0.5, 0), label="closed form", **EXACT)
    for case, label in (("quadrilaterals", "quadrilaterals"), ("rod", "triangles (one period)")):
        history = run(f"rod/{case}", f"rod-{case}")
        displacement.plot(history["time"], history["tip.displacement_x"], linewidth=1)
        pressure.plot(history["time"], history["contact_force_x"] / 0.1, linewidth=1, label=label)
    displacement.set(xlabel="time", title="displacement of the end, u(0, t)")
    pressure.set(xlabel="time", title="contact stress", ylim=(-0.05, 1.1))
    pressure.legend(loc="upper right")
    save(figure, "cases/rod/rod.png")


def bar():
    figure, axes = plt.subplots(2, 2, figsize=(10, 5.6))
    impact = run("bar/impact", "bar-impact")
    time = np.linspace(0, 2, 4001)
    axes[0, 0].plot(time, np.select([time < 1 / 2, time < 7 / 6], [5 - 10 * time, 0 * time], 10 * (time - 7 / 6)), **EXACT)
    axes[0, 1].plot(time, np.where((time > 1 / 2) & (time < 7 / 6), 300, 0), label="closed form", **EXACT)
    bounce = run("bar/bounce", "bar-bounce")
    time = np.linspace(0, 7.5, 15001)
    phase = time % (16 / 3)
    mirrored = np.minimum(phase, 16 / 3 - phase)
    contact = (mirrored > 1) & (mirrored <= 5 / 3)
    flight = phase - 5 / 3
    vibration = flight % (2 / 3)
    height = np.select(
        [mirrored <= 1, contact],
        [5 - 5 * mirrored**2, 0 * mirrored],
        10 * flight - 5 * flight**2 - 10 * vibration * (2 / 3 - vibration),
    )
    axes[1, 0].plot(time, height, **EXACT)
    axes[1, 1].plot(time, np.where(contact, 300 * mirrored, 0), label="closed form", **EXACT)
    for row, history, name in ((0, impact, "impact"), (1, bounce, "bounce")):
        axes[row, 0].plot(history["time"], 5 + history["bottom.displacement_y"], linewidth=1)
        axes[row, 1].plot(history["time"], history["contact_force_y"] / 0.5, linewidth=1, label="computed")
        axes[row, 0].set(title=f"{name}: height of the bottom")
        axes[row, 1].set(title=f"{name}: contact pressure")
    for axis in axes[1]:
        axis.set(xlabel="time")
    axes[0, 1].legend(loc="upper right")
    save(figure, "cases/bar/bar.png")


def hertz(mass, speed, gravity=9.81, radius=0.05, young=1.0e7, poisson=0.4, step=1e-6):
    """Force over time of a rigid mass on Hertz's spring, from first touch to release."""
    stiffness = 4 / 3 * young / (1 - poisson**2) * radius**0.5
    time, approach, times, forces = 0.0, 0.0, [0.0], [0.0]
    while approach >= 0:
        speed += step * (gravity - stiffness * approach**1.5 / mass)
        approach += step * speed
        time += step
        times.append(time)
        forces.append(stiffness * max(approach, 0) ** 1.5)
    return np.array(times), np.array(forces)


def ball():
    history = run("ball/ball", "ball")
    figure, (height, force) = plt.subplots(1, 2, figsize=(10, 3.6))
    milliseconds = 1e3 * history["time"]
    height.plot(milliseconds, 5 + 1e3 * history["lowest.displacement_z"], label="lowest point")
    height.plot(milliseconds, 5 + 1e3 * history["centre.displacement_z"], "--", label="centre, less the radius")
    mass, drop = 0.5643067, 0.005
    touch = (2 * drop / 9.81) ** 0.5
    times, forces = hertz(mass, (2 * 9.81 * drop) ** 0.5)
    force.plot(1e3 * (touch + times), forces, label="Hertz, with gravity", **EXACT)
    force.plot(milliseconds, history["contact_force_z"], label="computed")
    force.axhline(mass * 9.81, linestyle=":", color="k", linewidth=1, label="weight")
    height.set(xlabel="time, ms", title="height over the plane, mm", ylim=(-1.2, 7.5))
    force.set(xlabel="time, ms", title="contact force of the first bounce, N", xlim=(30, 43), ylim=(-5, 125))
    height.legend(loc="upper right")
    force.legend(loc="upper right")
    save(figure, "cases/ball/ball.png")


if __name__ == "__main__":
    known = {"disc": disc, "rod": rod, "bar": bar, "ball": ball}
    for wanted in sys.argv[1:] or known:
        known[wanted]()
