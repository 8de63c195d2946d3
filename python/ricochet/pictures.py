"""Pictures and animations of the frames of a run."""

import os
import tempfile

import numpy

from .errors import UsageError
from .files import path_of, write_whole
from .scene import Camera, NoFfmpeg, Scene, Shot, animate, draw_bar, draw_shot, map_of, norm_of, shown

MOST_TRIANGLES = 20000


def on_triangles(run, frame, field, cells, nodes, triangles):
    """Returns the values of a field on triangles: those of their cells, or the means of their corners."""
    values = frame[field]
    if values.ndim == 2:
        values = numpy.linalg.norm(values, axis=1) if values.shape[1] <= 3 else values[:, 0]
    return values[nodes][triangles].mean(axis=1) if run.is_on_points(field) else values[cells]


def scene_of(frames, field, scale=1.0):
    """Returns the scene of some frames of a run, and their shots."""
    run = frames[0]._run
    nodes, triangles, cells = run._data.surface(MOST_TRIANGLES)
    reference = numpy.array(run._data.points)[nodes]
    shots, of_obstacles = [], None
    for frame in frames:
        displacement = frame["displacement"][nodes]
        points = reference.copy()
        points[:, :displacement.shape[1]] += scale * displacement
        obstacles = run._data.obstacles(frame.number)
        if obstacles is not None and of_obstacles is None:
            of_obstacles = obstacles[0], obstacles[2]
        touching = None
        if "contact_pressure" in run.fields:
            touching = numpy.flatnonzero(frame["contact_pressure"][nodes] > 0.0)
        shots.append(Shot(frame.time, points, on_triangles(run, frame, field, cells, nodes, triangles),
                          None if obstacles is None else obstacles[1], touching))
    axisymmetric = run.summary["parameters"].get("mesh.plane") == "axisymmetric"
    return Scene(run.dimension, field, triangles, reference, of_obstacles, axisymmetric), shots


def picture(frame, field="von_mises", *, axes=None, limits=None, scale=1.0, colours=None, view=None, bar=True, zoom=False,
            half=False):
    """Returns a matplotlib figure of the body at the time of a frame, coloured by a field.

    `limits`: range of the colours; by default the scale is logarithmic if a few values would leave all others in one colour.
    `scale`: factor of the displacement. `view`: azimuth and elevation in degrees, in space. `zoom`: shows the contact closely,
    in space from behind the obstacle. `half`: shows only the section of an axisymmetric body. `axes`: axes to draw in; by
    default those of a new figure.
    """
    from matplotlib import pyplot

    scene, shots = shown(*scene_of([frame], field, scale), half)
    if axes is None:
        _, axes = pyplot.subplots(figsize=(5, 4), constrained_layout=True)
    camera, norm, colours = Camera(scene, shots, view, zoom), norm_of(scene, shots, limits), map_of(scene, colours)
    draw_shot(axes, scene, shots[0], camera, norm, colours)
    if bar:
        draw_bar(axes, scene, norm, colours)
    return axes.figure


def animate_run(run, path, field="von_mises", *, time=None, title="", size=None, view=None, limits=None, zoom=False, half=False,
                most=200):
    """Writes the frames of a run as an animation to `path`, which ends with .gif or .mp4. Returns the path."""
    path = path_of(path, "animation")
    form = os.path.splitext(path)[1].lower()[1:]
    if form not in ("gif", "mp4"):
        raise UsageError(f"{path}: an animation must be a .gif or .mp4 file")
    frames = [frame for frame in run.frames if time is None or time[0] <= frame.time <= time[1]]
    if len(frames) < 2:
        raise UsageError(f"{run.directory}: there are fewer than two frames to show; set output.fields_every")
    scene, shots = shown(*scene_of(frames[::-(-len(frames) // most)], field), half)
    with tempfile.TemporaryDirectory() as folder:
        made = os.path.join(folder, f"animation.{form}")
        try:
            animate(scene, shots, made, form, title=title, size=size, view=view, limits=limits, zoom=zoom)
        except NoFfmpeg as problem:
            raise UsageError(str(problem)) from None
        with open(made, "rb") as file:
            write_whole(path, file.read())
    return path
