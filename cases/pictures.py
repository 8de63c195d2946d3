#!/usr/bin/env python3
"""Draws the pictures of the cases' READMEs: runs the cases into out/pictures and plots their history.csv beside the
closed forms. From the repository root, with python3-matplotlib installed:

    /usr/bin/python3 cases/pictures.py [puck disc rod bar ball ball-axisymmetric hertz layer incline dragged conveyor oblique ball-spin bowl bars-pair cradle
        balls ball-block stack tied golf-ball rubber-ball tumbling-block]
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


def puck():
    figure, (momentum, force, energy) = plt.subplots(1, 3, figsize=(13, 3.8), sharex=True)
    history = run("puck/puck", "puck")
    milliseconds, mass = 1e3 * history["time"], np.pi * 0.02**2 * 1200
    for value in (1.5, 1.5 - 0.6 * 0.5, -0.5, 0.5):
        momentum.axhline(mass * value, label="m (1.5, −0.5) m/s and m (1.5 − 2 F 0.5, 0.5) m/s" if value == 1.5 else None, **EXACT)
    momentum.plot(milliseconds, history["momentum_x"], label="along the wall")
    momentum.plot(milliseconds, history["momentum_y"], label="across it")
    force.plot(milliseconds, history["contact_force_y"], label="normal force")
    force.plot(milliseconds, -history["contact_force_x"] / 0.3, "--", label="friction / 0.3")
    energy.plot(milliseconds, history["total_energy"], label="total energy")
    energy.plot(milliseconds, history["total_energy"][0] + history["friction_work"], "--", label="that of the start + friction work")
    energy.plot(milliseconds, history["elastic_energy"], label="elastic energy")
    momentum.set(xlabel="time, ms", title="momentum, kg/s")
    force.set(xlabel="time, ms", title="force, N/m")
    energy.set(xlabel="time, ms", title="energy, J/m")
    momentum.legend(loc=(0.02, 0.58), fontsize=8)
    force.legend(loc="upper right")
    energy.legend(loc="center right")
    save(figure, "cases/puck/puck.png")


def disc():
    figure, (energy, force) = plt.subplots(1, 2, figsize=(10, 3.6))
    for scheme, mass in (("midpoint", "consistent"), ("klr-conserving", "consistent"), ("newmark", "equivalent"), ("reduced-kane", "equivalent")):
        preset = ("time.preset=textbook-half",) if scheme == "newmark" else ()
        history = run("disc/disc", f"disc-{scheme}", f"time.scheme={scheme}", f"mass.type={mass}", *preset)
        label = f"{scheme}, {mass} mass"
        milliseconds = 1e3 * history["time"]
        line = {"newmark": "--", "reduced-kane": ":"}.get(scheme, "-")  # they would hide those below
        energy.semilogy(milliseconds, history["total_energy"] / history["total_energy"][0], line, label=label)
        if scheme != "midpoint":
            style = {"klr-conserving": {"linewidth": 0.5, "color": "C1"}, "newmark": {"linewidth": 1.6, "color": "C2"}}
            force.plot(milliseconds, history["lowest.reaction_normal"], label=label, **style.get(scheme, {"linestyle": ":", "color": "C3"}))
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


def layer():
    """Base velocity and traction of the sliding layer, relative to V and rho c_s V, for three coefficients."""
    figure, axes = plt.subplots(2, 3, figsize=(12, 5.4), sharex=True)
    for column, friction in enumerate((0.15, 0.3, 0.45)):
        history = run("layer/layer", f"layer-{friction}", f"contact.0.friction={friction}")
        time = np.arange(0, 8, 0.005)
        phase = np.floor(time / 2)
        sliding = np.ceil((1 / friction - 1) / 2)  # phases
        arriving = np.where(phase < sliding, 1 - 2 * friction * phase, (1 - 2 * friction * sliding) * (-1) ** (phase - sliding))
        axes[0, column].plot(time, np.where(phase < sliding, arriving - friction, 0), **EXACT)
        axes[1, column].plot(time, np.where(phase < sliding, -friction, -arriving), label="closed form", **EXACT)
        base = 0.5 * (history["left.displacement_x"] + history["right.displacement_x"])
        middle = 0.5 * (history["time"][1:] + history["time"][:-1])
        axes[0, column].plot(middle, np.diff(base) / np.diff(history["time"]) / 0.01, linewidth=1)
        axes[1, column].plot(history["time"], history["contact_force_x"] / 0.5 / 0.01, linewidth=1, label="computed")
        axes[0, column].set(title=f"F = {friction}: velocity of the base / V", ylim=(-0.2, 1.1))
        axes[1, column].set(title="traction on the base / ρ c V", xlabel="time", ylim=(-0.6, 0.4))
    axes[1, 0].legend(loc="upper left")
    save(figure, "cases/layer/layer.png")


def incline():
    figure, (velocity, force) = plt.subplots(1, 2, figsize=(10, 3.6))
    angle, mass = np.radians(20), 20.0
    for color, friction in enumerate((0.0, 0.2, 0.3, 0.4)):
        history = run("incline/incline", f"incline-{friction}", f"contact.0.friction={friction}")
        acceleration = max(0.0, 9.81 * (np.sin(angle) - friction * np.cos(angle)))
        velocity.plot(history["time"], acceleration * history["time"], **EXACT)
        velocity.plot(history["time"], history["momentum_x"] / mass, f"C{color}", linewidth=1, label=f"F = {friction}")
        force.plot(1e3 * history["time"], -history["contact_force_x"], f"C{color}", linewidth=1)
        force.axhline(mass * min(friction * 9.81 * np.cos(angle), 9.81 * np.sin(angle)), color="0.8", linewidth=4, zorder=0)
    velocity.set(xlabel="time, s", title="velocity down the slope, m/s (grey: rigid)")
    force.set(xlabel="time, ms", title="friction force, N", xlim=(0, 40))
    velocity.legend(loc="upper left")
    save(figure, "cases/incline/incline.png")


def rigid_slips(times, force=8.0, limit=0.8 * 9.81, mass=1.0, step=1e-4):
    """Place of a rigid block under force cos(t) and friction, at these times: it sticks, or slips until it stops."""
    place, velocity, result, t = 0.0, 0.0, [], 0.0
    for wanted in times:
        while t < wanted - 0.5 * step:
            push = force * np.cos(t + 0.5 * step)
            if velocity == 0.0 and abs(push) > limit:
                velocity += step * (push - np.sign(push) * limit) / mass
            elif velocity != 0.0:
                after = velocity + step * (push - np.sign(velocity) * limit) / mass
                velocity = after if after * velocity > 0.0 else 0.0
            place += step * velocity
            t += step
        result.append(place)
    return np.array(result)


def dragged():
    figure, (place, energy) = plt.subplots(1, 2, figsize=(11, 3.8))
    histories = {"reduced-kane, Δt = 1 ms": run("dragged/dragged", "dragged"),
                 "reduced-kane, Δt = 10 ms": run("dragged/dragged", "dragged-long", "time.step=1e-2", "output.history_every=1"),
                 "newmark, Δt = 1 ms": run("dragged/dragged", "dragged-newmark", "time.scheme=newmark", "time.preset=trapezoidal")}
    exact = histories["reduced-kane, Δt = 1 ms"]["time"]
    place.plot(exact, 1e3 * rigid_slips(exact), label="rigid block", **EXACT)
    for (name, history), style in zip(histories.items(), ("-", "--", ":")):
        place.plot(history["time"], 1e3 * history["centre.displacement_x"], style, label=name)
        energy.plot(history["time"], np.maximum(history["kinetic_energy"] + history["elastic_energy"], 1e-12), style, label=name)
    place.set(xlabel="time, s", title="displacement of the centre, mm", ylim=(-12, 12))
    energy.set(xlabel="time, s", title="kinetic and elastic energy, J/m", yscale="log")
    place.legend(loc="upper right", fontsize=8)
    energy.legend(loc="center right", fontsize=8)
    save(figure, "cases/dragged/dragged.png")


def conveyor():
    history = run("conveyor/conveyor", "conveyor")
    figure, (velocity, work) = plt.subplots(1, 2, figsize=(10, 3.6))
    time, mass, speed, drag = history["time"], 20.0, 0.5, 0.3 * 9.81
    velocity.plot(time, np.minimum(drag * time, speed), label="rigid block", **EXACT)
    velocity.plot(time, history["momentum_x"] / mass, linewidth=1, label="centre of the block")
    velocity.axhline(speed, linestyle=":", color="k", linewidth=1, label="belt")
    velocity.set(xlabel="time, s", title="velocity, m/s", ylim=(0, 0.6))
    velocity.legend(loc="lower right")
    for name, label in (("obstacle_work", "work of the belt"), ("kinetic_energy", "kinetic energy"), ("friction_work", "friction work")):
        work.plot(time, history[name], linewidth=1.4, label=label)
    work.set(xlabel="time, s", title="works and energy, J", ylim=(-3.2, 6))
    work.legend(loc="upper left")
    save(figure, "cases/conveyor/conveyor.png")


def oblique():
    figure, axes = plt.subplots(1, 3, figsize=(13, 3.8), sharex=True)
    for color, speed in enumerate((0.03, 0.1, 0.3)):
        history = run("oblique/oblique", f"oblique-{speed}", f"initial.velocity=[{speed},-0.1]")
        milliseconds, pressing = 1e3 * history["time"], history["contact_force_y"]
        axes[0].plot(milliseconds, history["contact_force_x"], f"C{color}", linewidth=1, label=f"thrown at ({speed}, −0.1) m/s")
        if speed != 0.1:
            continue
        axes[0].plot(milliseconds, 0.3 * pressing, "0.7", linewidth=1, label="± F × normal force")
        axes[0].plot(milliseconds, -0.3 * pressing, "0.7", linewidth=1)
        axes[1].stackplot(milliseconds, history["sticking"], history["slipping"], labels=("sticking", "slipping"), step="mid")
        axes[2].plot(milliseconds, history["total_energy"] - history["total_energy"][0], label="energy − its value at the start")
        axes[2].plot(milliseconds, history["friction_work"], "--", label="friction work")
    axes[0].set(xlabel="time, ms", title="friction force, N/m", xlim=(4.5, 15.5), ylim=(-165, 90))
    axes[1].set(xlabel="time, ms", title="nodes in contact, thrown at (0.1, −0.1) m/s")
    axes[2].set(xlabel="time, ms", title="J/m, thrown at (0.1, −0.1) m/s")
    axes[0].legend(loc="lower left")
    axes[1].legend(loc="upper left")
    axes[2].legend(loc="lower left")
    save(figure, "cases/oblique/oblique.png")


def ball_spin():
    history = run("ball-spin/ball-spin", "ball-spin")
    figure, (force, rotation) = plt.subplots(1, 2, figsize=(10, 3.6))
    milliseconds = 1e3 * history["time"]
    friction = np.hypot(history["contact_force_x"], history["contact_force_y"])
    force.plot(milliseconds, 0.3 * history["contact_force_z"], label="F × normal force", **EXACT)
    force.plot(milliseconds, friction, linewidth=1, label="friction")
    rotation.plot(milliseconds, history["max_rotation"])
    rotation.axhline(0.1, linestyle=":", color="k", label="the program warns")
    force.set(xlabel="time, ms", title="force, N", xlim=(31, 41))
    rotation.set(xlabel="time, ms", title="largest rotation of a cell, rad")
    force.legend(loc="upper right")
    rotation.legend(loc="upper left")
    save(figure, "cases/ball-spin/ball-spin.png")


def bowl():
    figure, (motion, energy) = plt.subplots(1, 2, figsize=(10, 3.6))
    length, friction = np.sqrt(1 - 0.004**2) - 0.002, 0.01
    smooth, rough = run("bowl/bowl", "bowl"), run("bowl/rough", "bowl-rough")
    for history, style, label in ((smooth, "C0-", "without friction"), (rough, "C1-", "F = 0.01")):
        motion.plot(history["time"], np.sin(0.1) + history["base.displacement_x"], style, label=label)
    # The point mass: θ'' = −(g/l) sin θ − F sgn(θ') ((g/l) cos θ + θ'²).
    for coefficient in (0.0, friction):
        angle, rate, h, points = 0.1, -1e-9, 1e-4, []
        for step in range(31000):
            points.append((step * h, np.sin(angle)))
            sign = np.sign(rate)
            rate -= h * 9.81 / length * np.sin(angle) + h * coefficient * sign * (9.81 / length * np.cos(angle) + rate**2)
            angle += h * rate
        motion.plot(*np.array(points).T, label="point mass" if coefficient else None, zorder=0, **EXACT)
    energy.plot(rough["time"], 1e3 * rough["total_energy"], label="total energy, F = 0.01")
    energy.plot(rough["time"], 1e3 * rough["friction_work"], "--", label="friction work")
    energy.plot(smooth["time"], 1e3 * smooth["total_energy"], label="total energy without friction")
    motion.set(xlabel="time, s", title="horizontal position of the block, m")
    energy.set(xlabel="time, s", title="energy, mJ/m")
    motion.legend(loc="lower right")
    energy.legend(loc="lower left")
    save(figure, "cases/bowl/bowl.png")


def steps(axis, breaks, values, **style):
    """A piecewise constant closed form: values[i] from breaks[i] to breaks[i + 1]."""
    axis.plot(np.repeat(breaks, 2)[1:-1], np.repeat(values, 2), **{**EXACT, **style})


def bars_pair():
    figure, axes = plt.subplots(2, 2, figsize=(11, 6.4))
    speed, height = 0.01, 0.05
    forms = (("pair", ("one", "two"), (3.0, 1.0), [0, 0.05, 2.05, 3], [0, 0.75, 0]),
             ("hammer", ("hammer", "pile"), (3.0, 4.0), [0, 0.05, 2.05, 4.05, 6.05, 8.05, 10], [0, 3 / 4, 3 / 8, 3 / 16, 3 / 32, 0]))
    for row, (case, bodies, masses, breaks, pressures) in enumerate(forms):
        history = run(f"bars-pair/{case}", f"bars-pair-{case}")
        steps(axes[row, 0], breaks, pressures, label="closed form")
        axes[row, 0].plot(history["time"], history["contact.force_x"] / height / speed, linewidth=1, label="computed")
        impulse = np.concatenate([[0.0], np.cumsum(np.diff(breaks) * pressures)])
        for body, start, mass, sign in zip(bodies, (1.0, 0.0), masses, (-1, 1)):
            axes[row, 1].plot(breaks, start + sign * impulse / mass, label="closed form" if sign < 0 else None, **EXACT)
            axes[row, 1].plot(history["time"], history[f"{body}.velocity_average_x"] / speed, linewidth=1.2, label=body)
        axes[row, 0].set(title=f"{case}: contact pressure / V")
        axes[row, 1].set(title=f"{case}: velocities of the centres of mass / V")
    for axis in axes[1]:
        axis.set(xlabel="time")
    axes[0, 0].legend(loc="upper right")
    for axis in axes[:, 1]:
        axis.legend(loc="center right")
    save(figure, "cases/bars-pair/bars-pair.png")


def tied():
    history = run("tied/tied", "tied")
    figure, (force, velocity) = plt.subplots(1, 2, figsize=(11, 3.6))
    steps(force, [0, 0.05, 2.05, 3], [0, 1, 0], label="closed form")
    force.plot(history["time"], history["wall.force_x"] / 0.1 / 0.01, linewidth=1, label="computed")
    velocity.plot([0, 0.05, 2.05, 3], [-1, -1, 1, 1], label="closed form", **EXACT)
    velocity.plot(history["time"], history["all.velocity_average_x"] / 0.01, linewidth=1.3, label="computed")
    force.set(xlabel="time", title="pressure on the wall / ρcV")
    velocity.set(xlabel="time", title="velocity of the centre of mass / V")
    force.legend(loc="upper right")
    velocity.legend(loc="lower right")
    save(figure, "cases/tied/tied.png")


def cradle():
    history = run("cradle/cradle", "cradle")
    figure, (force, velocity) = plt.subplots(1, 2, figsize=(11, 3.8))
    for number, name in enumerate(("ab", "bc", "cd")):
        offset = 1.2 * (2 - number)
        steps(force, [0, number, number + 2, 6], [offset, 0.5 + offset, offset], label="closed form" if number == 0 else None)
        force.plot(history["time"], offset + -history[f"{name}.force_x"] / 0.05 / 0.01, linewidth=1, label=f"{name[0]} on {name[1]}")
    for name, times, values in (("a", [0, 2, 6], [1, 0, 0]), ("b", [0, 1, 2, 3, 6], [0, 0.5, 0.5, 0, 0]),
                                ("c", [0, 1, 2, 3, 4, 6], [0, 0, 0.5, 0.5, 0, 0]), ("d", [0, 2, 4, 6], [0, 0, 1, 1])):
        velocity.plot(times, values, label="closed form" if name == "a" else None, **EXACT)
        velocity.plot(history["time"], history[f"{name}.velocity_average_x"] / 0.01, linewidth=1.3, label=name)
    force.set(xlabel="time", title="contact pressures / V, one above the other", ylim=(-0.1, 4.1), yticks=[0, 0.5, 1.2, 1.7, 2.4, 2.9],
              yticklabels=["0", "½", "0", "½", "0", "½"])
    velocity.set(xlabel="time", title="velocities of the centres of mass / V")
    force.legend(loc="upper right", ncol=2)
    velocity.legend(loc="center right")
    save(figure, "cases/cradle/cradle.png")


def point_impact(stiffness, mass, speed, steps=4000):
    """Force over time of a spring, force = stiffness × compression^1.5, that a mass meets at this speed, until release."""
    largest = (1.25 * mass * speed**2 / stiffness) ** 0.4
    step, compression, velocity, forces = 2.943275 * largest / speed / steps, 0.0, speed, [0.0]
    while compression >= 0.0:
        velocity -= step * stiffness * compression**1.5 / mass
        compression += step * velocity
        forces.append(stiffness * max(compression, 0.0) ** 1.5)
    return step * np.arange(len(forces)), np.array(forces)


def impact_of_two(axes, history, moduli, radius, masses, color, label):
    """Force and velocities of two bodies, a quarter of which is computed, beside Hertz; the first one comes with 1 m/s."""
    force, velocity = axes
    modulus = 1 / sum((1 - poisson**2) / young for young, poisson in moduli)
    times, forces = point_impact(4 / 3 * modulus * radius**0.5, masses[0] * masses[1] / sum(masses), 1.0)
    computed = 4 * history["contact.force_z"]
    force.plot(1e6 * times, forces, label="Hertz" if color == 0 else None, **EXACT)
    force.plot(1e6 * history["time"], computed, f"C{color}", linewidth=1.3, label=label[0])
    for body, start, mass, sign in (("upper", 1.0, masses[0], -1), ("lower", 0.0, masses[1], 1)):
        for time, values, style in ((times, forces, EXACT), (history["time"], computed, {"color": f"C{color}", "linewidth": 1.3})):
            impulse = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(time))])
            line = {} if style is EXACT else {"linestyle": "-" if sign < 0 else "--", "label": label[1 if sign < 0 else 2]}
            velocity.plot(1e6 * time, start + sign * impulse / mass, **style, **line)


def balls():
    figure, axes = plt.subplots(1, 2, figsize=(11, 3.8))
    steel, density = (2.1e11, 0.3), 7800 * 4 / 3 * np.pi
    for color, (case, radius) in enumerate((("balls", 0.01), ("unequal", 0.02))):
        impact_of_two(axes, run(f"balls/{case}", f"balls-{case}"), (steel, steel), 0.01 * radius / (0.01 + radius),
                      (density * 0.01**3, density * radius**3), color,
                      (f"radii 10 and {1000 * radius:.0f} mm", f"the striking ball, 10 mm ({case})", f"the struck ball, {1000 * radius:.0f} mm ({case})"))
    axes[0].set(xlabel="time, µs", title="contact force, N")
    axes[1].set(xlabel="time, µs", title="velocities of the centres of mass, m/s", ylim=(-0.9, 1.75))
    axes[0].legend(loc="lower center")
    axes[1].legend(loc="upper right", fontsize=8, ncol=2)
    save(figure, "cases/balls/balls.png")


def ball_block():
    figure, axes = plt.subplots(1, 2, figsize=(11, 3.8))
    impact_of_two(axes, run("ball-block/ball-block", "ball-block"), ((2.1e11, 0.3), (7e10, 0.33)), 0.01,
                  (7800 * 4 / 3 * np.pi * 0.01**3, 2700 * 0.04**3), 0, ("computed", "ball", "block"))
    axes[0].set(xlabel="time, µs", title="contact force, N")
    axes[1].set(xlabel="time, µs", title="velocities of the centres of mass, m/s")
    axes[0].legend(loc="lower center")
    axes[1].legend(loc="upper right")
    save(figure, "cases/ball-block/ball-block.png")


def stack():
    history = run("stack/stack", "stack")
    figure, (velocity, friction) = plt.subplots(1, 2, figsize=(11, 3.8))
    breaks = [0, 2, 4, 6, 8]
    steps(velocity, breaks, [0.775, 0.325, 0.25, 0.25], label="closed form")
    steps(velocity, breaks, [0.075, 0.225, 0.25, 0.25])
    steps(friction, breaks, [0.225, 0.225, -0.15, 0.15], label="closed form")
    middle = 0.5 * (history["time"][1:] + history["time"][:-1])
    for body in ("upper", "lower"):
        face = np.diff(history[f"{body}.displacement_average_x"]) / np.diff(history["time"])
        velocity.plot(middle, face / 0.01, linewidth=1, label=f"face of the {body} plate")
    friction.plot(history["time"], -history["contact.force_x"] / 0.5 / 0.01, linewidth=1, label="computed")
    velocity.set(xlabel="time", title="velocities of the faces / V", ylim=(-0.1, 1.1))
    friction.set(xlabel="time", title="friction traction on the lower plate / (ρ c V)", ylim=(-0.4, 0.6))
    velocity.legend(loc="upper right")
    friction.legend(loc="upper right")
    save(figure, "cases/stack/stack.png")


def ball_axisymmetric():
    """The force of the ball by its section beside that of the ball in space, and the pressure under a pressed one."""
    import meshio  # python3-meshio, for this picture only

    section, solid = run("ball-axisymmetric/ball-axisymmetric", "ball-axisymmetric"), run("ball/ball", "ball")
    run("ball-axisymmetric/pressed-axisymmetric", "ball-pressed")
    figure, (force, pressure) = plt.subplots(1, 2, figsize=(10, 3.6))
    force.plot(1e3 * solid["time"], solid["contact_force_z"], label="ball in space", **EXACT)
    force.plot(1e3 * section["time"], section["contact_force_y"], label="by its section")
    force.set(xlabel="time, ms", title="contact force, N", xlim=(31, 41), ylim=(-5, 125))
    with meshio.xdmf.TimeSeriesReader("out/pictures/ball-pressed/results.xdmf") as reader:
        points, _ = reader.read_points_cells()
        fields = reader.read_data(reader.num_steps - 1)[1]
    load = 2.8e-6 * 4.18878
    width = (0.75 * load * (1 - 0.3**2)) ** (1 / 3)
    touching = np.flatnonzero(fields["contact_status"] >= 0)
    radius = np.linspace(0, 1, 400)
    pressure.plot(radius, np.sqrt(1 - radius**2), label="Hertz", **EXACT)
    pressure.plot(points[touching, 0] / width, fields["contact_pressure"][touching] / (1.5 * load / (np.pi * width**2)), "o",
                  markersize=4, fillstyle="none", label="computed, degree 2")
    pressure.set(xlabel="distance from the axis / a", title="pressure / largest of Hertz", xlim=(0, 1.3), ylim=(-0.05, 1.15))
    for axis in (force, pressure):
        axis.legend(loc="upper right")
    save(figure, "cases/ball-axisymmetric/ball-axisymmetric.png")


def hertz_pressure():
    """Pressure over the radius of the pressed cylinder and ball, in every multiplier space that is stable there."""
    import meshio  # python3-meshio, for this picture only

    figure, axes = plt.subplots(2, 2, figsize=(10, 6.4), sharex=True, sharey=True)
    modulus = 1 / (1 - 0.3**2)
    for row, (body, parts) in enumerate((("cylinder", 2), ("sphere", 4))):
        for degree in (1, 2):
            axis = axes[row, degree - 1]
            radius = np.linspace(0, 1, 400)
            axis.plot(radius, np.sqrt(1 - radius**2), label="Hertz", **EXACT)
            for space, marker in (("nodal", "o"), ("dual", "x"), ("p1", "+"), ("p0", "s")):
                if space == "p0" and (body == "sphere" or degree == 1):
                    continue  # not stable
                mesh = f"{body}.msh" if degree == 1 else f"{body}-degree2.msh"
                name = f"hertz-{body}-{degree}-{space}"
                settings = (f"mesh.file={mesh}", f"mesh.degree={degree}", f"contact.0.multipliers={space}")
                history = run(f"hertz/{body}", name, *settings)
                load = parts * history["contact_force_y" if body == "cylinder" else "contact_force_z"][-1]
                if body == "cylinder":
                    width = (4 * load / (np.pi * modulus)) ** 0.5
                    peak = 2 * load / (np.pi * width)
                else:
                    width = (0.75 * load / modulus) ** (1 / 3)
                    peak = 1.5 * load / (np.pi * width**2)
                with meshio.xdmf.TimeSeriesReader(f"out/pictures/{name}/results.xdmf") as reader:
                    points, cells = reader.read_points_cells()
                    fields = reader.read_data(reader.num_steps - 1)[1]
                corners = 3 if body == "cylinder" else 4
                vertices = np.unique(cells[0].data[:, :corners])
                vertices = vertices[fields["contact_status"][vertices] >= 0]
                distance = np.linalg.norm(points[vertices, : corners - 2], axis=1)
                pressure = fields["contact_pressure"][vertices]
                axis.plot(distance / width, pressure / peak, marker, markersize=3.5, fillstyle="none", label=space)
            axis.set(title=f"{body}, degree {degree}", xlim=(0, 1.2), ylim=(-0.05, 1.35))
    for axis in axes[1]:
        axis.set(xlabel="distance from the axis / a")
    for axis in axes[:, 0]:
        axis.set(ylabel="pressure / largest of Hertz")
    axes[0, 1].legend(loc="upper right", ncol=2)
    save(figure, "cases/hertz/hertz.png")


def deformed(name):
    """Nodes, cells and the frames of results.h5: pairs of a time and its fields, the frames' times being those of results.xdmf."""
    import xml.etree.ElementTree

    import h5py  # python3-h5py, for pictures of bodies only

    tree = xml.etree.ElementTree.parse(f"out/pictures/{name}/results.xdmf")
    body = next(grid for grid in tree.iter("Grid") if grid.get("GridType") == "Collection")
    times = [float(entry.get("Value")) for entry in body.iter("Time")]
    with h5py.File(f"out/pictures/{name}/results.h5") as file:
        frames = [{key: np.array(values) for key, values in frame.items()} for _, frame in sorted(file["frames"].items())]
        return np.array(file["mesh/nodes"]), np.array(file["mesh/cells"]), list(zip(times, frames, strict=True))


def nearest(frames, time):
    return min(frames, key=lambda frame: abs(frame[0] - time))


def tumbling_block():
    from matplotlib.collections import PolyCollection

    history = run("tumbling-block/tumbling-block", "tumbling-block", "output.fields_every=1")
    nodes, cells, frames = deformed("tumbling-block")
    chosen = [nearest(frames, time) for time in (0.0135, 0.075, 0.134, 0.199, 0.44)]
    figure = plt.figure(figsize=(13, 6.2))
    grid = figure.add_gridspec(2, len(chosen) + 1, height_ratios=(1.2, 1.0), width_ratios=[1.0] * len(chosen) + [0.07])
    slope = np.radians(30)
    down = np.array([[np.cos(slope), np.sin(slope)], [-np.sin(slope), np.cos(slope)]])
    largest = 1e-3 * max(fields["von_mises"].max() for _, fields in chosen)
    for number, (time, fields) in enumerate(chosen):
        place = figure.add_subplot(grid[0, number])
        now = (nodes + fields["displacement"])[:, :2] @ down.T
        body = PolyCollection(now[cells], array=1e-3 * fields["von_mises"], cmap="viridis", edgecolor="0.3", linewidth=0.3)
        body.set_clim(0.0, largest)
        place.add_collection(body)
        place.plot(*(down @ np.array([[-1.0, 2.0], [0.0, 0.0]])), "0.3", linewidth=2)
        middle = now.mean(axis=0)
        place.set(aspect="equal", title=f"{1e3 * time:.0f} ms", xlim=middle[0] + np.array([-0.085, 0.085]), ylim=middle[1] + np.array([-0.09, 0.08]), xticks=[], yticks=[])
    figure.colorbar(body, cax=figure.add_subplot(grid[0, -1]), label="von Mises stress, kPa")
    energy = figure.add_subplot(grid[1, :-1])
    milliseconds, start = 1e3 * history["time"], history["total_energy"][0]
    energy.plot(milliseconds, history["total_energy"], label="total energy, with that of its height")
    energy.plot(milliseconds, start + history["friction_work"], "--", label="that of the start + friction work")
    energy.plot(milliseconds, history["elastic_energy"], label="elastic energy")
    energy.set(xlabel="time, ms", title="energy, J/m")
    energy.legend(loc="upper left", fontsize=8)
    save(figure, "cases/tumbling-block/tumbling-block.png")


def cut_of_ball(axis, nodes, cells, fields, limits=None):
    """The plane y = 0 of half a ball of tetrahedra of degree 2, deformed, with the von Mises stress of its cells."""
    edges = {(0, 1): 4, (1, 2): 5, (0, 2): 6, (0, 3): 7, (1, 3): 8, (2, 3): 9}
    triangles, stresses, sides = [], [], []
    on_cut = np.abs(nodes[:, 1]) < 1e-9
    for cell, stress in zip(cells, fields["von_mises"]):
        corners = [corner for corner in range(4) if on_cut[cell[corner]]]
        if len(corners) != 3:
            continue
        a, b, c = (cell[corner] for corner in corners)
        i, j, k = corners
        ab, bc, ac = cell[edges[i, j]], cell[edges[j, k]], cell[edges[i, k]]
        triangles += [(a, ab, ac), (b, bc, ab), (c, ac, bc), (ab, bc, ac)]
        stresses += 4 * [stress]
        sides += [(a, ab, b), (b, bc, c), (c, ac, a)]
    x, z = (1e3 * (nodes + fields["displacement"])[:, (0, 2)]).T
    drawn = axis.tripcolor(x, z, triangles, facecolors=np.array(stresses), cmap="viridis", vmin=0, vmax=limits)
    for side in sides:
        axis.plot(x[list(side)], z[list(side)], "0.2", linewidth=0.3)
    axis.axhline(0, color="0.3", linewidth=2)
    axis.set(aspect="equal")
    return drawn


def balls_at(case, times, path):
    history = run(f"{case}/{case}", case, "output.fields_every=1")
    nodes, cells, frames = deformed(case)
    deepest = history["time"][np.argmax(history["contact_force_z"])]
    figure, axes = plt.subplots(1, len(times) + 1, figsize=(13, 3.3), width_ratios=[1.0] * len(times) + [0.05])
    chosen = [nearest(frames, deepest if time is None else time) for time in times]
    largest = 1e-6 * max(fields["von_mises"].max() for _, fields in chosen)
    radius, top = 1e3 * nodes[:, 0].max(), 1e3 * nodes[:, 2].max()
    for axis, (time, fields) in zip(axes, chosen):
        drawn = cut_of_ball(axis, nodes, cells, {**fields, "von_mises": 1e-6 * fields["von_mises"]}, largest)
        middle = 1e3 * fields["displacement"][:, 0].mean()
        axis.set(title=f"{1e3 * time:.2f} ms", xlabel="x, mm", xlim=(middle - 1.25 * radius, middle + 1.25 * radius), ylim=(-0.06 * top, 1.3 * top))
    axes[0].set(ylabel="z, mm")
    figure.colorbar(drawn, cax=axes[-1], label="von Mises stress, MPa")
    save(figure, path)


def rubber_ball():
    balls_at("rubber-ball", (0.0, 0.6e-3, None, 2.6e-3, 3.6e-3), "cases/rubber-ball/rubber-ball.png")


def golf_ball():
    balls_at("golf-ball", (0.0, 0.12e-3, None, 0.5e-3, 0.8e-3), "cases/golf-ball/squeezed.png")


if __name__ == "__main__":
    known = {"puck": puck, "disc": disc, "rod": rod, "bar": bar, "ball": ball, "ball-axisymmetric": ball_axisymmetric, "hertz": hertz_pressure, "layer": layer, "incline": incline, "dragged": dragged,
             "conveyor": conveyor, "oblique": oblique, "ball-spin": ball_spin, "bowl": bowl,
             "bars-pair": bars_pair, "cradle": cradle, "balls": balls, "ball-block": ball_block, "stack": stack, "tied": tied,
             "golf-ball": golf_ball, "rubber-ball": rubber_ball, "tumbling-block": tumbling_block}
    for wanted in sys.argv[1:] or known:
        known[wanted]()
