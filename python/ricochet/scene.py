"""Draws a body and its obstacles: completely in the plane, their visible parts in space. Independent of the rest of the package,
since figure.py draws the animations of `ricochet plot` with it."""

import math
import os

import numpy

COLOURS = "viridis"
# Fraction of white in the colours in space, since shading is invisible at the dark end of a scale.
PALE = 0.22
NAMES = {"von_mises": "von Mises stress", "nodal_von_mises": "von Mises stress", "velocity": "speed"}
# Extent of a plane beyond the body, margins of the picture in the plane and in space, as fractions of the body's size; size of
# the window of a zoom relative to the touching points.
MARGIN, ROOM, ROOM_IN_SPACE, ZONE = 0.1, 0.06, 0.16, 1.3
# A scale is logarithmic if the largest value exceeds the value below which 95 % of the area, or half of it, lies by one of these
# factors; number of its decades.
OUTLYING, FAR_OUTLYING, DECADES = 3.0, 8.0, 3.0
FRAMES_PER_SECOND = 20


class Shot:
    """The body at one time: `points` (m x 3), `values` of the triangles, positions of the obstacles' corners (or None), and
    indices of the points under contact pressure (or None)."""

    def __init__(self, time, points, values, obstacles=None, touching=None):
        self.time, self.points, self.values = time, points, values
        self.obstacles, self.touching = obstacles, touching


class Scene:
    """Constant data of all shots: triangles (n x 3), the undeformed points (m x 3), and cells of the obstacles with the number
    of the obstacle of each (or None)."""

    def __init__(self, dimension, field, triangles, reference, obstacles=None, axisymmetric=False):
        self.dimension, self.triangles, self.reference = dimension, triangles, reference
        self.label = NAMES.get(field, field.replace("_", " "))
        self.cells, self.obstacle = obstacles if obstacles is not None else (None, None)
        self.axisymmetric = axisymmetric

    def mirrored(self):
        """Returns the scene of whole axisymmetric bodies: the section with its mirror image across the axis x = 0."""
        scene = Scene(self.dimension, "", numpy.concatenate([self.triangles, self.triangles + len(self.reference)]),
                      with_image(self.reference))
        scene.label = self.label
        if self.cells is not None:
            # A mirrored line has the obstacle on its other side: reverse it.
            count = 1 + self.cells.max()
            scene.cells = numpy.concatenate([self.cells, self.cells[:, ::-1] + count])
            scene.obstacle = numpy.concatenate([self.obstacle, self.obstacle + 1 + self.obstacle.max()])
        return scene


def with_image(points):
    return numpy.concatenate([points, points * [-1.0, 1.0, 1.0]])


def mirrored(shot):
    count = len(shot.points)
    return Shot(shot.time, with_image(shot.points), numpy.tile(shot.values, 2),
                None if shot.obstacles is None else with_image(shot.obstacles),
                None if shot.touching is None else numpy.concatenate([shot.touching, shot.touching + count]))


def view_axes(azimuth, elevation):
    """Returns the directions to the right, upwards and towards the viewer."""
    a, e = numpy.radians([azimuth, elevation])
    towards = numpy.array([numpy.cos(e) * numpy.cos(a), numpy.cos(e) * numpy.sin(a), numpy.sin(e)])
    right = numpy.array([-numpy.sin(a), numpy.cos(a), 0.0])
    return right, numpy.cross(towards, right), towards


def view_of_contact(scene, shots):
    """Returns the directions of a view from behind the touching facets, slightly from the side."""
    normals = numpy.zeros(3)
    for shot in shots:
        corners = shot.points[scene.triangles]
        middle = shot.points.mean(axis=0)
        touches = numpy.isin(scene.triangles, shot.touching).any(axis=1) if shot.touching is not None else []
        if not numpy.any(touches):
            continue
        areas = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[touches]
        outwards = numpy.sign(((corners.mean(axis=1)[touches] - middle) * areas).sum(axis=1))
        normals += (areas * outwards[:, None]).sum(axis=0)
    if not numpy.any(normals):
        return view_axes(-60.0, 20.0)
    out = normals / numpy.linalg.norm(normals)
    side = numpy.array([0.4, -1.0, 0.1])
    side -= (side @ out) * out
    towards = out + 0.5 * side / numpy.linalg.norm(side)
    towards /= numpy.linalg.norm(towards)
    right = numpy.cross([0.0, 0.0, 1.0], towards)
    right = numpy.array([1.0, 0.0, 0.0]) if numpy.linalg.norm(right) < 1e-6 else right / numpy.linalg.norm(right)
    return right, numpy.cross(towards, right), towards


def norm_of(scene, shots, limits=None):
    """Returns the norm of the colours for the values: logarithmic if a few of them would leave all others in one colour."""
    from matplotlib.colors import LogNorm, Normalize

    if limits is not None:
        return Normalize(*limits)
    values = numpy.concatenate([shot.values for shot in shots])
    corners = scene.reference[scene.triangles]
    areas = numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    areas = numpy.tile(areas, len(shots))[numpy.isfinite(values)]
    values = values[numpy.isfinite(values)]
    if values.size == 0:
        return Normalize(0.0, 1.0)
    low, high = float(values.min()), float(values.max())
    order = numpy.argsort(values)
    share = numpy.cumsum(areas[order])
    middle, usual = (float(values[order[min(int(numpy.searchsorted(share, part * share[-1])), values.size - 1)]])
                     for part in (0.5, 0.95))
    if low >= 0.0 and usual > 0.0 and (high > OUTLYING * usual or high > FAR_OUTLYING * middle):
        return LogNorm(max(high * 10.0 ** -DECADES, float(values[values > 0.0].min())), high)
    return Normalize(low, high if high > low else low + 1.0)


def map_of(scene, colours):
    """Returns the colour map of a name; without a name that of reports, paler in space."""
    from matplotlib import pyplot
    from matplotlib.colors import ListedColormap

    if colours is not None or scene.dimension == 2:
        return pyplot.get_cmap(colours or COLOURS)
    return ListedColormap(PALE + (1.0 - PALE) * pyplot.get_cmap(COLOURS)(numpy.linspace(0.0, 1.0, 256))[:, :3])


class Camera:
    """Directions of a picture, and the window that it shows: around the body in all shots, or around the touching points."""

    def __init__(self, scene, shots, view=None, zoom=False):
        self.zoom = zoom
        self.size = float(numpy.linalg.norm(numpy.ptp(scene.reference, axis=0)))
        if scene.dimension == 2:
            self.axes = tuple(numpy.eye(3))
        elif zoom and view is None:
            self.axes = view_of_contact(scene, shots)
        else:
            self.axes = view_axes(*(view or (-60.0, 20.0)))
        self.project = numpy.stack(self.axes[:2], axis=1)
        low = numpy.min([shot.points.min(axis=0) for shot in shots], axis=0)
        high = numpy.max([shot.points.max(axis=0) for shot in shots], axis=0)
        self.box = low, high
        corners = numpy.array([[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i in (0, 1) for j in (0, 1)
                               for k in (0, 1)]) if scene.dimension == 3 else numpy.array([low, high])
        seen = corners @ self.project
        if scene.dimension == 3:
            every = [shot.points @ self.project for shot in shots]
            seen = numpy.array([numpy.min([flat.min(axis=0) for flat in every], axis=0),
                                numpy.max([flat.max(axis=0) for flat in every], axis=0)])
        self.low, self.high = seen.min(axis=0), seen.max(axis=0)
        room = (ROOM if scene.dimension == 2 else ROOM_IN_SPACE) * (self.high - self.low).max()
        self.low, self.high = self.low - room, self.high + room
        if zoom:
            self.look_at_contact(scene, shots)

    def look_at_contact(self, scene, shots):
        """Chooses a window of one size for all shots. It follows the touching points, and stays where it is if there are none."""
        zones = [shot.points[shot.touching] for shot in shots if shot.touching is not None and len(shot.touching)]
        if not zones:
            return
        radius = max(0.5 * float(numpy.linalg.norm(numpy.ptp(zone, axis=0))) for zone in zones)
        radius = ZONE * min(max(radius, 0.03 * self.size), 0.5 * self.size)
        self.half = numpy.array([radius, radius])
        middle = zones[0].mean(axis=0)
        self.middles = {}
        for shot in shots:
            if shot.touching is not None and len(shot.touching):
                middle = shot.points[shot.touching].mean(axis=0)
            inwards = (shot.points.mean(axis=0) - middle) if scene.dimension == 2 else numpy.zeros(3)
            length = numpy.linalg.norm(inwards)
            # The window shows more of the body than of the obstacle.
            self.middles[id(shot)] = (middle + 0.5 * radius * inwards / (length or 1.0)) @ self.project

    def window(self, shot):
        middle = getattr(self, "middles", {}).get(id(shot))
        return (self.low, self.high) if middle is None else (middle - self.half, middle + self.half)


def is_plane(shapes):
    """Returns whether the cells represent a plane, which is one quadrilateral. A triangle repeats its last corner."""
    return len(shapes) == 1 and bool(numpy.any(shapes[0, 2] != shapes[0, -1]))


def resized_plane(corners, box, margin):
    """Returns the corners (4 x 3) of a rectangle that represents a plane, moved to the body: to the extent of the corners of its
    box, and a margin."""
    low, high = box
    points = numpy.array([[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    first, second = corners[1] - corners[0], corners[3] - corners[0]
    sides = numpy.linalg.norm(first), numpy.linalg.norm(second)
    along = (points - corners[0]) @ numpy.stack([first / sides[0], second / sides[1]], axis=1)
    a, b = along.min(axis=0) - margin, along.max(axis=0) + margin
    places = [(a[0], a[1]), (b[0], a[1]), (b[0], b[1]), (a[0], b[1])]
    return numpy.array([corners[0] + u * first / sides[0] + v * second / sides[1] for u, v in places])


def draw_plane(axes, a, b, low, high):
    """Draws the line through two points across the picture; the obstacle is on its right."""
    along = (b - a) / numpy.linalg.norm(b - a)
    middle = a + along * (((low + high) / 2 - a) @ along)
    far = 2 * along * (numpy.linalg.norm(high - low) + numpy.linalg.norm(middle - (low + high) / 2))
    inwards = numpy.array([far[1], -far[0]])
    axes.fill(*zip(middle - far, middle + far, middle + far + inwards, middle - far + inwards), color="0.93", lw=0, zorder=0)
    axes.plot(*zip(middle - far, middle + far), color="0.45", lw=1.5, zorder=0.5)


def draw_obstacles(axes, scene, shot, camera):
    """Draws obstacles: in the plane lines, in space the faces visible from the side of the bodies. Planes extend as far as the
    body, other obstacles are complete. The camera of a zoom sees through them."""
    from matplotlib.collections import LineCollection, PolyCollection

    if scene.dimension == 2:
        for number in numpy.unique(scene.obstacle):
            own = shot.obstacles[scene.cells[scene.obstacle == number]][:, :, :2]
            if len(own) == 1:
                draw_plane(axes, *own[0], *camera.window(shot))
            else:
                axes.add_collection(LineCollection(own, colors="0.45", linewidths=2.0))
        return
    towards = camera.axes[2]
    for number in numpy.unique(scene.obstacle):
        cells = scene.cells[scene.obstacle == number]
        shapes = shot.obstacles[cells]
        if is_plane(shapes):
            shapes = resized_plane(shapes[0], camera.box, MARGIN * camera.size)[None]
        normals = numpy.cross(shapes[:, 2] - shapes[:, 0], shapes[:, 3] - shapes[:, 1])
        lengths = numpy.linalg.norm(normals, axis=1)
        facing = (normals @ towards) / numpy.maximum(lengths, 1e-300)
        if cells.shape[1] == 4 and numpy.all(cells[:, 2] == cells[:, 3]):
            facing = abs(facing)  # triangles of a file, some of which may be inverted in a coarsened picture
        order = numpy.argsort(shapes.mean(axis=1) @ towards)
        seen = order[facing[order] > 0.0]
        if len(seen):
            grey = 0.80 + 0.14 * facing[seen]
            axes.add_collection(PolyCollection((shapes[seen] @ camera.project), facecolors=numpy.stack([grey] * 3, axis=1),
                                               edgecolors="0.7" if is_plane(shapes) else "face", linewidths=0.4, zorder=1))
        behind = order[facing[order] <= 0.0]
        if is_plane(shapes) and len(behind):
            axes.add_collection(PolyCollection(shapes[behind] @ camera.project, facecolors="none", edgecolors="0.7",
                                               linewidths=0.6, zorder=3))


def draw_body(axes, scene, shot, camera, norm, colours):
    from matplotlib.collections import PolyCollection

    corners, values = shot.points[scene.triangles], shot.values
    light = numpy.ones(len(corners))
    if scene.dimension == 3:
        _, up, towards = camera.axes
        normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        light = abs(normals @ (0.9 * towards + 0.44 * up))
        order = numpy.argsort(corners.mean(axis=1) @ towards)
        corners, values, light = corners[order], values[order], light[order]
    low = getattr(norm, "vmin", None)
    rgb = colours(norm(numpy.maximum(values, low) if low is not None and low > 0.0 else values))
    rgb[:, :3] *= 0.7 + 0.3 * light[:, None]
    axes.add_collection(PolyCollection(corners @ camera.project, facecolors=rgb, edgecolors=rgb, linewidths=0.3, zorder=2))


def draw_shot(axes, scene, shot, camera, norm, colours):
    from matplotlib.ticker import MaxNLocator

    if shot.obstacles is not None and scene.cells is not None:
        draw_obstacles(axes, scene, shot, camera)
    draw_body(axes, scene, shot, camera, norm, colours)
    low, high = camera.window(shot)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.grid(False)
    if scene.dimension == 3:
        axes.set_axis_off()
    else:
        axes.set_xlabel("x")
        axes.set_ylabel("y")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MaxNLocator(5))
    axes.set_title(f"t = {shot.time:.4g}", fontsize=9)


def draw_bar(axes, scene, norm, colours):
    from matplotlib import pyplot

    mapped = pyplot.cm.ScalarMappable(norm=norm, cmap=colours)
    return axes.figure.colorbar(mapped, ax=axes, label=scene.label, shrink=0.8)


def shown(scene, shots, half):
    """Returns the scene and shots to draw: of whole axisymmetric bodies, unless only the section is requested."""
    if not scene.axisymmetric or half:
        return scene, shots
    return scene.mirrored(), [mirrored(shot) for shot in shots]


class NoFfmpeg(Exception):
    """The program that makes .mp4 files is not installed."""

    def __init__(self):
        super().__init__("an .mp4 file requires ffmpeg, which is not installed: apt-get install ffmpeg, or write a .gif")


def axes_of_animation(figure, dimension, title):
    """Returns the axes of the body and of the colours, the same in every frame. Space for text is in centimetres, as its size
    does not depend on that of the figure."""
    width, height = (2.54 * side for side in figure.get_size_inches())
    left, bottom = (0.3, 0.3) if dimension == 3 else (1.7, 1.2)
    top, right = 1.4 if title else 0.8, 2.2

    def within(x, y, wide, high):
        return figure.add_axes((x / width, y / height, wide / width, high / height))

    tall = height - bottom - top
    if title:
        figure.text(0.5, 1.0 - 0.4 / height, title, fontsize=10, ha="center", va="center")
    return within(left, bottom, width - left - right - 0.3, tall), within(width - right, bottom + 0.1 * tall, 0.4, 0.8 * tall)


def animate(scene, shots, path, form, *, title="", size=None, view=None, limits=None, zoom=False):
    """Writes the shots as an animation: "gif" by Pillow, "mp4" by ffmpeg. The same shots produce the same .gif."""
    from matplotlib import animation, pyplot
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    if form == "mp4" and not animation.FFMpegWriter.isAvailable():
        raise NoFfmpeg()
    camera, norm, colours = Camera(scene, shots, view, zoom), norm_of(scene, shots, limits), map_of(scene, None)
    dpi = 100
    # The sides of an .mp4 picture have an even number of pixels.
    figure = pyplot.figure(figsize=[2 * math.ceil(side / 2.54 * dpi / 2) / dpi for side in size or (15.0, 12.0)], dpi=dpi)
    FigureCanvasAgg(figure)
    axes, bar = axes_of_animation(figure, scene.dimension, title)
    figure.colorbar(pyplot.cm.ScalarMappable(norm=norm, cmap=colours), cax=bar, label=scene.label)
    writer = animation.PillowWriter(fps=FRAMES_PER_SECOND) if form == "gif" else \
        animation.FFMpegWriter(fps=FRAMES_PER_SECOND, extra_args=["-pix_fmt", "yuv420p"])
    made = f"{path}.{form}"  # writers choose the format by the extension
    with writer.saving(figure, made, dpi):
        for shot in shots:
            axes.clear()
            draw_shot(axes, scene, shot, camera, norm, colours)
            writer.grab_frame()
    os.replace(made, path)
    pyplot.close(figure)


def scene_of_description(description):
    def places(numbers):
        return numpy.array(numbers, dtype=float).reshape(-1, 3)

    obstacles = description.get("obstacles")
    of_obstacles = None if obstacles is None else (numpy.array(obstacles["cells"]).reshape(-1, obstacles["corners"]),
                                                   numpy.array(obstacles["obstacle"]))
    scene = Scene(description["dimension"], description["field"], numpy.array(description["triangles"]).reshape(-1, 3),
                  places(description["reference"]), of_obstacles, description["axisymmetric"])
    shots = [Shot(frame["time"], places(frame["points"]), numpy.array(frame["values"], dtype=float),
                  places(frame["obstacles"]) if "obstacles" in frame else None,
                  numpy.array(frame["touching"], dtype=int) if "touching" in frame else None) for frame in description["frames"]]
    return scene, shots


def write_described(description, form, output):
    """Writes the animation that a description of the program requests, or the picture of its only frame."""
    from matplotlib import pyplot

    scene, shots = shown(*scene_of_description(description), description["half"])
    size = (description["width"], description["height"]) if description["width"] else None
    if form in ("gif", "mp4"):
        return animate(scene, shots, output, form, title=description["title"], size=size, zoom=description["zoom"])
    width, height = size or (13.0, 10.0)
    figure, axes = pyplot.subplots(figsize=(width / 2.54, height / 2.54), constrained_layout=True)
    camera, norm, colours = Camera(scene, shots, zoom=description["zoom"]), norm_of(scene, shots), map_of(scene, None)
    draw_shot(axes, scene, shots[0], camera, norm, colours)
    draw_bar(axes, scene, norm, colours)
    if description["title"]:
        figure.suptitle(description["title"], fontsize=10)
    figure.savefig(output, format=form, metadata={"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}[form])
