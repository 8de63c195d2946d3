"""Pictures of a body: in the plane as it is, in space what can be seen of it."""

import numpy

MOST_TRIANGLES = 20000
COLOURS = "viridis"
NAMES = {"von_mises": "von Mises stress", "nodal_von_mises": "von Mises stress"}


def on_triangles(run, frame, field, cells, nodes, triangles):
    """The values of a field for triangles: those of their cells, or means of their corners."""
    values = frame[field]
    if values.ndim == 2:
        values = numpy.linalg.norm(values, axis=1) if values.shape[1] <= 3 else values[:, 0]
    return values[nodes][triangles].mean(axis=1) if run.is_on_points(field) else values[cells]


def view_axes(azimuth, elevation):
    """To the right, up, and towards who looks."""
    a, e = numpy.radians([azimuth, elevation])
    towards = numpy.array([numpy.cos(e) * numpy.cos(a), numpy.cos(e) * numpy.sin(a), numpy.sin(e)])
    right = numpy.array([-numpy.sin(a), numpy.cos(a), 0.0])
    return right, numpy.cross(towards, right), towards


def picture(frame, field="von_mises", *, axes=None, limits=None, scale=1.0, colours=COLOURS, view=(-60.0, 20.0), bar=True):
    """A matplotlib figure of the body at the time of a frame, coloured by a field.

    `limits`: of the colours. `scale`: of the displacement. `view`: azimuth and elevation in degrees, in space. `axes`: where
    to draw; else in a new figure.
    """
    from matplotlib import pyplot
    from matplotlib.collections import PolyCollection

    run = frame._run
    nodes, triangles, cells = run._data.surface(MOST_TRIANGLES)
    points = numpy.array(run._data.points)
    displacement = frame["displacement"]
    points[:, :displacement.shape[1]] += scale * displacement
    values = on_triangles(run, frame, field, cells, nodes, triangles)
    corners = points[nodes][triangles]
    obstacles = run._data.obstacles(frame.number)
    if axes is None:
        _, axes = pyplot.subplots(figsize=(5, 4), constrained_layout=True)
    light = numpy.ones(len(corners))
    if run.dimension == 3:
        right, up, towards = view_axes(*view)
        normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        light = 0.55 + 0.45 * abs(normals @ (0.8 * towards + 0.6 * up))
        order = numpy.argsort(corners.mean(axis=1) @ towards)
        corners, values, light = corners[order], values[order], light[order]
        project = numpy.stack([right, up], axis=1)
    else:
        project = numpy.eye(3)[:, :2]
    if obstacles is not None:
        draw_obstacles(axes, *obstacles, project, run.dimension)
    low, high = limits or (float(numpy.nanmin(values)), float(numpy.nanmax(values)))
    scale_of_colours = pyplot.Normalize(low, high if high > low else low + 1.0)
    colour_map = pyplot.get_cmap(colours)
    rgb = colour_map(scale_of_colours(values))
    rgb[:, :3] *= light[:, None]
    flat = corners @ project
    axes.add_collection(PolyCollection(flat, facecolors=rgb, edgecolors=rgb, linewidths=0.3))
    frame_of = flat.reshape(-1, 2)
    room = 0.06 * (frame_of.max(axis=0) - frame_of.min(axis=0)).max()
    axes.set_xlim(frame_of[:, 0].min() - room, frame_of[:, 0].max() + room)
    axes.set_ylim(frame_of[:, 1].min() - room, frame_of[:, 1].max() + room)
    axes.set_aspect("equal")
    if run.dimension == 3:
        axes.set_axis_off()
    else:
        axes.set_xlabel("x")
        axes.set_ylabel("y")
    axes.set_title(f"t = {frame.time:.4g}", fontsize=9)
    if bar:
        mapped = pyplot.cm.ScalarMappable(norm=scale_of_colours, cmap=colour_map)
        axes.figure.colorbar(mapped, ax=axes, label=NAMES.get(field, field.replace("_", " ")), shrink=0.8)
    return axes.figure


def draw_obstacles(axes, cells, points, project, dimension):
    from matplotlib.collections import LineCollection, PolyCollection

    shapes = points[cells] @ project
    if dimension == 2:
        axes.add_collection(LineCollection(shapes, colors="0.45", linewidths=2.0))
    else:
        axes.add_collection(PolyCollection(shapes, facecolors=(0.75, 0.75, 0.75, 0.35), edgecolors="none"))
