"""Pictures of bodies that turn and stretch; pictures.py draws them."""
import numpy as np
import matplotlib.pyplot as plt

from picture_tools import EXACT, run, save


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


def balloon():
    from matplotlib.collections import PolyCollection

    history = run("balloon/balloon", "balloon", "output.fields_every=1")
    nodes, cells, frames = deformed("balloon")
    figure, (section, growth, small) = plt.subplots(1, 3, figsize=(13, 3.8), width_ratios=(1.0, 1.3, 1.3))
    corners = cells[:, [0, 4, 1, 5, 2, 6, 3, 7]]  # and the nodes between them
    for time, colour in ((0.0, "0.75"), (0.05, "tab:orange"), (1.0, "tab:blue")):
        time, fields = nearest(frames, time)
        now = 1e3 * (nodes + fields["displacement"])[:, :2]
        section.add_collection(PolyCollection(now[corners], facecolor="none", edgecolor=colour, linewidth=0.8))
        section.plot([], [], color=colour, label=f"{1e3 * time:.0f} ms")
    section.set(aspect="equal", xlim=(0, 35), ylim=(0, 35), xlabel="x, mm", ylabel="y, mm", title="section")
    section.legend(loc="upper right", fontsize=8)
    for place, exact in (("inner", 5.13738), ("outer", 2.67449)):
        growth.axhline(exact, **EXACT)
        growth.plot(1e3 * history["time"], 1e3 * history[f"{place}.displacement_x"], label=f"{place} radius")
    growth.set(xlabel="time, ms", ylabel="mm", title="growth of the radii; grey: the law alone")
    growth.legend(loc="center right", fontsize=8)
    creep = run("balloon/creep", "balloon-creep")
    time = creep["time"]
    rise, retardation = np.pi / 0.05, 1 / 0.1
    after = rise / 2 * rise * (np.exp(retardation * 0.05) + 1) / (retardation**2 + rise**2) * np.exp(-retardation * time)
    small.plot(1e3 * time[10:], (710.526 * (1 - after / 2) + 0.14)[10:], **EXACT, label="linear viscoelasticity")
    small.plot(1e3 * time, 1e9 * creep["inner.displacement_x"], label="creep.toml")
    small.set(xlabel="time, ms", ylabel="nm", title="inner radius, small pressure")
    small.legend(loc="lower right", fontsize=8)
    save(figure, "cases/balloon/balloon.png")
