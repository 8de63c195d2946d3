"""Pictures of bodies against bodies; pictures.py draws them."""
import numpy as np
import matplotlib.pyplot as plt

from picture_tools import EXACT, run, save
from closed_forms_of_contacts import BlockInBowl
from closed_forms_of_waves import TwoBars, sliding_plates
from hertz import PointImpact


def steps(axis, breaks, values, **style):
    """A piecewise constant closed form: values[i] from breaks[i] to breaks[i + 1]."""
    axis.plot(np.repeat(breaks, 2)[1:-1], np.repeat(values, 2), **{**EXACT, **style})


def bars_pair():
    figure, axes = plt.subplots(2, 2, figsize=(11, 6.4))
    speed, height = 0.01, 0.05
    for row, (case, bodies, transit, end) in enumerate((("pair", ("one", "two"), (2.0, 2.0), 3.0), ("hammer", ("hammer", "pile"), (2.0, 8.0), 10.0))):
        history = run(f"bars-pair/{case}", f"bars-pair-{case}")
        bars = TwoBars((3.0, 1.0), transit, (1.0, 0.0), 0.05, end)
        breaks = [piece[0] for piece in bars.pieces] + [end]
        steps(axes[row, 0], breaks, [piece[2] for piece in bars.pieces], label="closed form")
        axes[row, 0].plot(history["time"], history["contact.force_x"] / height / speed, linewidth=1, label="computed")
        for number, body in enumerate(bodies):
            axes[row, 1].plot(breaks, [bars.mean_velocity(number, time) for time in breaks], label=None if number else "closed form", **EXACT)
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


def impact_of_two(axes, history, elastic, radii, masses, color, label):
    """Force and velocities of two bodies, a quarter of which is computed, beside Hertz; the first one comes with 1 m/s."""
    force, velocity = axes
    times, forces = map(np.array, PointImpact.of_bodies(elastic, radii, masses, 1.0).course())
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
        impact_of_two(axes, run(f"balls/{case}", f"balls-{case}"), (steel, steel), (0.01, radius),
                      (density * 0.01**3, density * radius**3), color,
                      (f"radii 10 and {1000 * radius:.0f} mm", f"the striking ball, 10 mm ({case})", f"the struck ball, {1000 * radius:.0f} mm ({case})"))
    axes[0].set(xlabel="time, µs", title="contact force, N")
    axes[1].set(xlabel="time, µs", title="velocities of the centres of mass, m/s", ylim=(-0.9, 1.75))
    axes[0].legend(loc="lower center")
    axes[1].legend(loc="upper right", fontsize=8, ncol=2)
    save(figure, "cases/balls/balls.png")


def ball_block():
    figure, axes = plt.subplots(1, 2, figsize=(11, 3.8))
    impact_of_two(axes, run("ball-block/ball-block", "ball-block"), ((2.1e11, 0.3), (7e10, 0.33)), (0.01, np.inf),
                  (7800 * 4 / 3 * np.pi * 0.01**3, 2700 * 0.04**3), 0, ("computed", "ball", "block"))
    axes[0].set(xlabel="time, µs", title="contact force, N")
    axes[1].set(xlabel="time, µs", title="velocities of the centres of mass, m/s")
    axes[0].legend(loc="lower center")
    axes[1].legend(loc="upper right")
    save(figure, "cases/ball-block/ball-block.png")


def stack():
    history = run("stack/stack", "stack")
    figure, (velocity, friction) = plt.subplots(1, 2, figsize=(11, 3.8))
    breaks, phases = [0, 2, 4, 6, 8], sliding_plates((1.0, 3.0), 1.0, 0.225)
    for axis, number in ((velocity, 1), (velocity, 2), (friction, 0)):
        steps(axis, breaks, [phase[number] for phase in phases], label=None if number == 2 else "closed form")
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


def quarter_swing(bowl, start=0.6, gravity=9.81, count=4000):
    """Times and velocities of the block in the bowl, from rest at -start to the bottom."""
    phase = (np.arange(count) + 0.5) * np.pi / 2 / count
    x = -start * np.cos(phase)
    heights, rates = zip(*((bowl.place(each)[1], bowl.rate(each)) for each in x))
    inertia = np.array([bowl.inertia(rate) for rate in rates])
    speed = np.sqrt(2 * gravity * (bowl.place(-start)[1] - np.array(heights)) / inertia)
    return np.cumsum(start * np.sin(phase) / speed) * np.pi / 2 / count, speed * np.array([rate[0] for rate in rates])


def slide():
    figure, (velocity, force) = plt.subplots(1, 2, figsize=(11, 3.8))
    history = run("slide/slide", "slide")
    time, speed = quarter_swing(BlockInBowl())
    half = np.concatenate([time, 2 * time[-1] - time[::-1]]), np.concatenate([speed, speed[::-1]])
    velocity.plot(np.concatenate([half[0], 2 * time[-1] + half[0]]), np.concatenate([half[1], -half[1]]), label="rigid", **EXACT)
    velocity.plot(history["time"], history["momentum.block_x"] / 0.06, linewidth=1.2, label="computed")
    velocity.set(xlabel="time / s", title="block: horizontal velocity / (m/s)")
    velocity.legend(loc="upper right")
    history = run("slide/ironing", "ironing")
    force.plot(history["time"], history["die.force_y"], linewidth=1, label="vertical")
    force.plot(history["time"], -history["die.force_x"], linewidth=1, label="horizontal, against the motion")
    force.axvline(1, color="0.6", linewidth=1)
    force.set(xlabel="time / s (drawn from 1 s on)", title="die: force of the slab / (N/m)")
    force.legend(loc="center right")
    save(figure, "cases/slide/slide.png")
