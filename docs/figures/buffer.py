#!/usr/bin/env python3
"""Runs docs/figures/buffer.toml, a steel ram whose rubber buffer strikes a stop, and draws docs/figures/buffer.png: the first
picture of the README and of the site. From the repository root, with gmsh, python3-h5py and python3-matplotlib installed (half a
minute):

    /usr/bin/python3 docs/figures/buffer.py

The results hardly depend on the mesh and the step: with cells of 1.5 mm, and with half the step, the restitution changes by 10⁻⁴ at
most, and the largest force and the largest stress change by less than 0.5 %.
"""
import csv
import json
import subprocess

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize

RUN = "out/buffer"
ELEVATION = np.radians(20)
WEDGE = np.radians(55)  # to either side of the direction of view, a wedge of the body is cut out
PIXELS = 14  # per mm
STEEL, STOP = np.array([0.70, 0.72, 0.75]), np.array([0.88, 0.88, 0.86])
STRESS, PRESSURE = plt.get_cmap("viridis"), plt.get_cmap("OrRd")
STOP_RADIUS, STOP_THICKNESS = 38.0, 6.0  # mm, as drawn: in the run the stop is a half-space
LIGHT = np.array([-0.45, 0.5, 0.74])  # to the right, up, towards the viewer


def in_space(x, y, angle):
    """Coordinates to the right, up and towards the viewer of points at a radius x, a height y and an angle from the viewer."""
    right, towards = x * np.sin(angle), x * np.cos(angle)
    return np.stack([right, y * np.cos(ELEVATION) - towards * np.sin(ELEVATION), y * np.sin(ELEVATION) + towards * np.cos(ELEVATION)], -1)


class Canvas:
    """A picture with a depth buffer; triangles are given in the coordinates of in_space, in mm."""

    def __init__(self, low, high):
        self.low, self.extent = np.array(low), (low[0], high[0], low[1], high[1])
        width, height = (int(PIXELS * (b - a)) for a, b in zip(low, high))
        self.colour, self.depth = np.ones((height, width, 3)), np.full((height, width), -np.inf)

    def draw(self, corners, colours, lit=True):
        """Triangles (n x 3 x 3) with a colour at each corner (n x 3 x 3), those that are lit darker where they turn away."""
        for triangle, colour in zip(corners, colours):
            p = (triangle[:, :2] - self.low) * PIXELS
            a, b = np.maximum(np.floor(p.min(0)).astype(int), 0), np.ceil(p.max(0)).astype(int) + 1
            (ux, uy), (vx, vy) = p[1] - p[0], p[2] - p[0]
            area = ux * vy - uy * vx
            if abs(area) < 1e-9:
                continue
            if lit:
                normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
                normal *= np.sign(normal[2]) / np.linalg.norm(normal)
                colour = colour * (0.62 + 0.38 * max(normal @ LIGHT, 0.0))
            x, y = np.meshgrid(np.arange(a[0], b[0]) + 0.5 - p[0, 0], np.arange(a[1], b[1]) + 0.5 - p[0, 1])
            s, t = (x * vy - y * vx) / area, (y * ux - x * uy) / area
            weights = np.stack([1 - s - t, s, t], -1)
            part = np.s_[a[1] : b[1], a[0] : b[0]]
            rows, columns = self.depth[part].shape
            weights = weights[:rows, :columns]
            depth = weights @ triangle[:, 2]
            seen = (weights.min(-1) > -1e-9) & (depth > self.depth[part])
            self.depth[part][seen] = depth[seen]
            self.colour[part][seen] = (weights @ colour)[seen]


def revolved(x, y, colours, begin, end, count=160):
    """Triangles and colours of the surface that a line sweeps from one angle to the other."""
    angles = np.linspace(begin, end, count)
    grid = np.stack([in_space(x, y, angle) for angle in angles])
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, :-1], grid[1:, 1:]
    tint = np.broadcast_to(colours, (count,) + colours.shape)
    e, f, g, h = tint[:-1, :-1], tint[:-1, 1:], tint[1:, :-1], tint[1:, 1:]
    corners = np.concatenate([np.stack([a, b, c], 2), np.stack([b, d, c], 2)]).reshape(-1, 3, 3)
    return corners, np.concatenate([np.stack([e, f, g], 2), np.stack([f, h, g], 2)]).reshape(-1, 3, 3)


class Results:
    def __init__(self):
        with open(f"{RUN}/summary.json") as file:
            self.summary = json.load(file)
        with open(f"{RUN}/history.csv", newline="") as file:
            rows = list(csv.reader(file))
        self.history = dict(zip(rows[0], np.array(rows[1:], dtype=float).T))
        self.file = h5py.File(f"{RUN}/results.h5")
        self.nodes, cells = 1e3 * self.file["mesh/nodes"][:, :2], self.file["mesh/cells"][:]
        self.cells = cells
        self.triangles = np.concatenate([cells[:, [0, 3, 5]], cells[:, [3, 1, 4]], cells[:, [5, 4, 2]], cells[:, [3, 4, 5]]])
        self.in_rubber = np.tile(self.nodes[cells[:, :3], 1].mean(1) < 40.0, 4)
        # The outline: edges of one cell that are not on the axis. Edges between rubber and steel are drawn, too.
        edges = np.sort(np.concatenate([self.triangles[:, [0, 1]], self.triangles[:, [1, 2]], self.triangles[:, [2, 0]]]), axis=1)
        owner = np.tile(np.arange(len(self.triangles)), 3)
        unique, first, count = np.unique(edges, axis=0, return_index=True, return_counts=True)
        outer = (count == 1) & ~np.all(self.nodes[unique, 0] < 1e-6, axis=1)
        self.outline, self.outline_in_rubber = unique[outer], self.in_rubber[owner[first[outer]]]
        rubber, steel = (np.unique(self.triangles[where]) for where in (self.in_rubber, ~self.in_rubber))
        bond = np.isin(unique, np.intersect1d(rubber, steel)).all(axis=1) & (count == 2)
        self.lines = np.concatenate([self.outline, unique[bond]])

    def frame(self, step):
        fields = self.file["frames"][sorted(self.file["frames"])[step]]
        return self.nodes + 1e3 * fields["displacement"][:, :2], 1e-6 * fields["nodal_von_mises"][:], 1e-6 * fields["contact_pressure"][:]

    def pressure(self, points, pressure):
        """Radii in mm and pressures in MPa along the contact boundary, from the axis outwards."""
        on = np.unique(self.file["mesh/contact_facets"][:])
        on = on[np.argsort(self.nodes[on, 0])]
        return points[on, 0], pressure[on]


def draw_body(axes, results, step, stress_norm, pressure_norm):
    points, stress, pressure = results.frame(step)
    canvas = Canvas((-40.0, -21.0), (40.0, 113.0))
    behind = WEDGE, 2 * np.pi - WEDGE

    # The stop: its top with the contact pressure, and its rim.
    radii, values = results.pressure(points, pressure)
    x = np.concatenate([np.linspace(0, 16, 161), [STOP_RADIUS]])
    p = np.interp(x, radii, values, right=0.0)
    tint = np.where((p > 0)[:, None], PRESSURE(pressure_norm(p))[:, :3], STOP)
    canvas.draw(*revolved(x, np.full_like(x, -0.02), tint, 0, 2 * np.pi), lit=False)
    canvas.draw(*revolved(np.full(2, STOP_RADIUS), np.array([-0.02, -STOP_THICKNESS]), np.tile(STOP, (2, 1)), 0, 2 * np.pi))

    # The surface of the body, and its section on both sides of the wedge.
    colours = STRESS(stress_norm(stress))[:, :3]
    for edge, is_rubber in zip(results.outline, results.outline_in_rubber):
        tint = colours[edge] if is_rubber else np.tile(STEEL, (2, 1))
        canvas.draw(*revolved(points[edge, 0], points[edge, 1], tint, *behind, count=100))
    tint = np.where(results.in_rubber[:, None, None], colours[results.triangles], STEEL)
    for angle in behind:
        canvas.draw(in_space(points[:, 0], points[:, 1], angle)[results.triangles], tint, lit=False)
        here = in_space(points[:, 0], points[:, 1], angle)
        for cell in results.cells:
            axes.plot(*here[cell[[0, 3, 1, 4, 2, 5, 0]], :2].T, color="black", linewidth=0.3, alpha=0.22, zorder=2)
        for line in results.lines:
            axes.plot(*here[line, :2].T, color="black", linewidth=0.9, zorder=3, solid_capstyle="round")
    axes.imshow(canvas.colour.clip(0, 1), extent=canvas.extent, origin="lower", interpolation="antialiased", zorder=1)
    axes.set(xlim=canvas.extent[:2], ylim=canvas.extent[2:])
    axes.axis("off")


def mark(axes, results, step, peak):
    """A ring at the position of the largest stress of the run, on the right half of the section."""
    points, _, _ = results.frame(step)
    cell = np.argmin(np.hypot(*(results.nodes[results.cells].mean(1) - 1e3 * np.array(peak["place"])).T))
    x, y = points[results.cells[cell]].mean(0)
    place = in_space(x, y, WEDGE)[:2]
    axes.plot(*place, "o", markersize=9, fillstyle="none", color="white", markeredgewidth=3.2, zorder=5)
    axes.plot(*place, "o", markersize=9, fillstyle="none", color="#d6006c", markeredgewidth=1.6, zorder=6)
    axes.annotate(f"largest:\n{1e-6 * peak['von_mises']:.2f} MPa", place, (27, -1.5), ha="center", va="center", color="#d6006c", zorder=6,
                  arrowprops={"arrowstyle": "-", "color": "#d6006c", "shrinkB": 6})


def main():
    command = ["build/ricochet", "run", "docs/figures/buffer.toml", "-o", RUN, "--force", "--quiet"]
    subprocess.run(command, check=True)
    results = Results()
    impact, peak = results.summary["impacts"][0], results.summary["peak_stress"]
    assert not results.summary["warnings"], results.summary["warnings"]
    time = 1e3 * results.history["time"]
    most = int(np.argmax(results.history["contact_force_y"]))
    points, stress, pressure = results.frame(most)
    radii, values = results.pressure(points, pressure)
    stress_norm, pressure_norm = Normalize(0, 1.5), Normalize(0, 2.5)

    plt.rcParams.update({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False})
    figure = plt.figure(figsize=(10.4, 6.0))
    for left, step, title in ((0.0, 0, "t = 0: it arrives at 2 m/s"), (0.315, most, f"t = {time[most]:.1f} ms: the largest force")):
        axes = figure.add_axes((left, 0.10, 0.315, 0.83))
        draw_body(axes, results, step, stress_norm, pressure_norm)
        axes.set_title(title, fontsize=11, y=0.985)
    mark(axes, results, most, peak)
    for left, norm, colours, label in ((0.03, stress_norm, STRESS, "von Mises stress in the rubber, MPa"),
                                       (0.345, pressure_norm, PRESSURE, "contact pressure on the stop, MPa")):
        bar = figure.colorbar(plt.cm.ScalarMappable(norm, colours), cax=figure.add_axes((left, 0.085, 0.255, 0.022)), orientation="horizontal")
        bar.set_label(label)
        bar.outline.set_visible(False)

    panels = [figure.add_axes((0.715, bottom, 0.275, 0.205)) for bottom in (0.745, 0.43, 0.085)]
    force, energy, along = panels
    force.plot(time, results.history["contact_force_y"], color="tab:red")
    force.set_title("contact force, N", fontsize=11, loc="left")
    text = f"largest {impact['largest_force']:.0f} N\nrestitution\n{impact['restitution']:.4f}"
    force.annotate(text, (0.99, 1.0), xycoords="axes fraction", ha="right", va="top")
    parts = ("kinetic_energy", "elastic_energy", "viscous_dissipation")
    energy.stackplot(time, *(results.history[part] for part in parts), colors=("#4f81bd", "#6aa84f", "#e69138"), alpha=0.9)
    energy.set_title("energy, J", fontsize=11, loc="left")
    for text, x, y in (("kinetic", 1.75, 0.7), ("elastic", 8.1, 0.95), ("heat", 14.1, 1.43)):
        energy.annotate(text, (x, y), ha="center", va="center", color="white", weight="bold")
    along.plot(radii, values, "o-", color="tab:orange", markersize=3)
    along.set(xlim=(0, 16), ylim=(0, None), xlabel="radius, mm")
    along.set_title(f"contact pressure at {time[most]:.1f} ms, MPa", fontsize=11, loc="left")
    for axes in (force, energy):
        axes.set(xlim=(0, 16), ylim=(0, None))
        axes.axvline(time[most], color="0.4", linewidth=0.8)
    energy.set_xlabel("time, ms", labelpad=1)
    force.set_xticklabels([])
    figure.savefig("docs/figures/buffer.png", dpi=140, facecolor="white")
    print(f"restitution {impact['restitution']:.4f}, {1e3 * impact['duration']:.2f} ms, {impact['largest_force']:.1f} N, "
          f"{1e-6 * peak['von_mises']:.3f} MPa at {1e3 * np.array(peak['place'])} mm, {1e3 * peak['time']:.2f} ms")


if __name__ == "__main__":
    main()
