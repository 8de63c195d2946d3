#!/usr/bin/env python3
"""Draws the pictures of the cases' READMEs: runs the cases into out/pictures and plots their history.csv beside the
closed forms. From the repository root, with python3-matplotlib installed:

    /usr/bin/python3 cases/pictures.py [puck disc rod bar ball ball-axisymmetric hertz layer incline dragged conveyor oblique ball-spin bowl bars-pair cradle
        balls ball-block stack slide tied golf-ball rubber-ball tumbling-block balloon]
"""
import sys

import matplotlib.pyplot as plt
import numpy as np

from picture_tools import EXACT, run, save
from closed_forms_of_waves import STRIKING_BAR, SlidingLayer, bouncing_bar, released_rod
from hertz import PointImpact, contact_modulus
from pictures_at_finite_strain import balloon, golf_ball, rubber_ball, tumbling_block
from pictures_of_pairs import ball_block, balls, bars_pair, cradle, slide, stack, tied


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
    exact = np.array([released_rod(t) for t in time]).T
    displacement.plot(time, exact[0], **EXACT)
    pressure.plot(time, exact[1], label="closed form", **EXACT)
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
    axes[0, 0].plot(time, [5 + STRIKING_BAR.displacement(0.0, t) for t in time], **EXACT)
    axes[0, 1].plot(time, [STRIKING_BAR.force_at(t) / 0.5 for t in time], label="closed form", **EXACT)
    bounce = run("bar/bounce", "bar-bounce")
    time = np.linspace(0, 7.5, 15001)
    exact = np.array([bouncing_bar(t) for t in time]).T
    axes[1, 0].plot(time, 5 + exact[0], **EXACT)
    axes[1, 1].plot(time, exact[1], label="closed form", **EXACT)
    for row, history, name in ((0, impact, "impact"), (1, bounce, "bounce")):
        axes[row, 0].plot(history["time"], 5 + history["bottom.displacement_y"], linewidth=1)
        axes[row, 1].plot(history["time"], history["contact_force_y"] / 0.5, linewidth=1, label="computed")
        axes[row, 0].set(title=f"{name}: height of the bottom")
        axes[row, 1].set(title=f"{name}: contact pressure")
    for axis in axes[1]:
        axis.set(xlabel="time")
    axes[0, 1].legend(loc="upper right")
    save(figure, "cases/bar/bar.png")


def ball():
    history = run("ball/ball", "ball")
    figure, (height, force) = plt.subplots(1, 2, figsize=(10, 3.6))
    milliseconds = 1e3 * history["time"]
    height.plot(milliseconds, 5 + 1e3 * history["lowest.displacement_z"], label="lowest point")
    height.plot(milliseconds, 5 + 1e3 * history["centre.displacement_z"], "--", label="centre, less the radius")
    mass, drop = 0.5643067, 0.005
    touch = (2 * drop / 9.81) ** 0.5
    times, forces = PointImpact(contact_modulus((1.0e7, 0.4)), 0.05, mass, (2 * 9.81 * drop) ** 0.5).course(gravity=9.81)
    force.plot(1e3 * (touch + np.array(times)), forces, label="Hertz, with gravity", **EXACT)
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
        time, exact = np.arange(0, 8, 0.005), SlidingLayer(friction)
        axes[0, column].plot(time, [exact.velocity(t) for t in time], **EXACT)
        axes[1, column].plot(time, [exact.traction(t) for t in time], label="closed form", **EXACT)
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
    """Position of a rigid block under force cos(t) and friction, at these times: it sticks, or slips until it stops."""
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


if __name__ == "__main__":
    known = {"puck": puck, "disc": disc, "rod": rod, "bar": bar, "ball": ball, "ball-axisymmetric": ball_axisymmetric, "hertz": hertz_pressure, "layer": layer, "incline": incline, "dragged": dragged,
             "conveyor": conveyor, "oblique": oblique, "ball-spin": ball_spin, "bowl": bowl,
             "bars-pair": bars_pair, "cradle": cradle, "balls": balls, "ball-block": ball_block, "stack": stack, "slide": slide, "tied": tied,
             "golf-ball": golf_ball, "rubber-ball": rubber_ball, "tumbling-block": tumbling_block, "balloon": balloon}
    for wanted in sys.argv[1:] or known:
        known[wanted]()
