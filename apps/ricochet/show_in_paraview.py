"""Shows a run in ParaView: the deformed body coloured by von Mises stress, with a range over all times and cut open in
space, dots at the nodes under contact pressure, coloured by it, and the obstacles in grey. Supports both formats of
fields (results.xdmf, results.vtkhdf).

    pvbatch show_in_paraview.py DIR PICTURE.png [TIME]    # a picture of the frame nearest to the time, else of the last
    pvpython show_in_paraview.py DIR                      # describes the results
    RICOCHET_RUN=DIR paraview --script=show_in_paraview.py

As a macro (in ParaView: Macros, Import new macro) it shows the run whose results.xdmf or results.vtkhdf is open and
selected, else that of the directory RICOCHET_RUN.

ParaView 5.12 and later reads the times of vtkhdf files; earlier versions show the first frame."""

import os
import sys

STRESS, PRESSURE, DISPLACEMENT = "von_mises", "contact_pressure", "displacement"
GREY, WHITE, BLACK = [0.62, 0.62, 0.62], [1.0, 1.0, 1.0], [0.0, 0.0, 0.0]


class Problem(Exception):
    """Error message for the user, in one sentence."""


def find_files(directory):
    """Returns the files of the body and of the obstacles; the latter is None if there are no obstacles."""
    for body, obstacles in (("results.vtkhdf", "obstacles.vtkhdf"), ("results.xdmf", "obstacles.xdmf")):
        path = os.path.join(directory, body)
        if os.path.exists(path):
            beside = os.path.join(directory, obstacles)
            return path, beside if os.path.exists(beside) else None
    raise Problem(f"{directory}: contains neither results.xdmf nor results.vtkhdf: name the output directory of a run "
                  "that has written fields")


def directory_of_run(simple, arguments):
    if arguments:
        return arguments[0]
    selected = simple.GetActiveSource()
    files = [value for name in ("FileName", "FileNames") for value in (getattr(selected, name, None) or [])
             if isinstance(value, str)] if selected is not None else []
    if isinstance(getattr(selected, "FileName", None), str):
        files = [selected.FileName]
    if files and os.path.basename(files[0]).split(".")[0] in ("results", "obstacles"):
        return os.path.dirname(files[0])
    if "RICOCHET_RUN" in os.environ:
        return os.environ["RICOCHET_RUN"]
    raise Problem("no run is selected: open its results.xdmf or results.vtkhdf and select it, name its directory, or set "
                  "RICOCHET_RUN to it")


def open_file(simple, path):
    path = os.path.abspath(path)
    if path.endswith(".vtkhdf"):
        return simple.VTKHDFReader(registrationName=os.path.basename(path), FileName=[path])
    return simple.XDMFReader(registrationName=os.path.basename(path), FileNames=[path])


def times_of(reader):
    values = getattr(reader, "TimestepValues", None)
    if values is None:
        return []
    return list(values) if hasattr(values, "__len__") else [values]


class Body:
    """The deformed body, and the ranges of its fields over all times."""

    def __init__(self, simple, path, has_obstacles):
        self.reader = open_file(simple, path)
        self.reader.UpdatePipeline()
        self.times = times_of(self.reader)
        source = self.reader
        if has_obstacles and path.endswith(".xdmf"):  # shows the obstacles as well
            source = simple.MergeBlocks(Input=simple.ExtractBlock(Input=source, Selectors=["/Root/body"]))
            source.UpdatePipeline(self.times[0] if self.times else 0.0)
        self.shown = source
        if source.PointData.GetArray(DISPLACEMENT) is not None:
            self.shown = simple.WarpByVector(registrationName="body", Input=source, Vectors=["POINTS", DISPLACEMENT])
        self.ranges = {}
        self.bounds = None
        for time in self.times or [0.0]:
            self.measure(time)

    def fields(self):
        return {**{array.Name: ("CELLS", array) for array in self.shown.CellData},
                **{array.Name: ("POINTS", array) for array in self.shown.PointData}}

    def measure(self, time):
        self.shown.UpdatePipeline(time)
        for name, (_, array) in self.fields().items():
            low, high = array.GetRange(0)
            if low <= high:
                before = self.ranges.get(name, (low, high))
                self.ranges[name] = (min(before[0], low), max(before[1], high))
        bounds = self.shown.GetDataInformation().GetBounds()
        if self.bounds is None:
            self.bounds = list(bounds)
        self.bounds = [(min, max)[i % 2](self.bounds[i], bounds[i]) for i in range(6)]

    def is_plane(self):
        return self.bounds[5] - self.bounds[4] <= 1e-9 * (self.bounds[1] - self.bounds[0])

    def stress(self):
        return next((name for name in (STRESS, "nodal_" + STRESS) if name in self.ranges), None)


def colour(simple, view, display, place, name, limits, preset, title, bar_at, inverted=False):
    simple.ColorBy(display, (place, name))
    table = simple.GetColorTransferFunction(name)
    table.ApplyPreset(preset, True)
    if inverted:
        table.InvertTransferFunction()
    table.RescaleTransferFunction(limits[0], limits[1] if limits[1] > limits[0] else limits[0] + 1.0)
    table.AutomaticRescaleRangeMode = "Never"
    display.SetScalarBarVisibility(view, True)
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = BLACK
    bar.WindowLocation = "Any Location"
    bar.Position, bar.ScalarBarLength = bar_at, 0.33


def flat_axis(obstacle_bounds):
    """Returns the axis across which the obstacles are flat, which points up in space; z if they are not flat."""
    if obstacle_bounds is None:
        return 2
    extents = [obstacle_bounds[2 * k + 1] - obstacle_bounds[2 * k] for k in range(3)]
    return extents.index(min(extents)) if min(extents) < 0.01 * max(extents) else 2


def cut_open(simple, body, up):
    """Returns the half away from the camera: stress is largest inside, above the support of the body."""
    clip = simple.Clip(registrationName="half of the body", Input=body.shown, ClipType="Plane")
    bounds = body.shown.GetDataInformation().GetBounds()
    clip.ClipType.Origin = [0.5 * (bounds[2 * k] + bounds[2 * k + 1]) for k in range(3)]
    clip.ClipType.Normal = [0.0, 1.0, 0.0] if up == 2 else [0.0, 0.0, -1.0]
    clip.Invert = 0
    return clip


def show_body(simple, view, body, shown):
    display = simple.Show(shown, view)
    few = body.shown.GetDataInformation().GetNumberOfCells() < 20000
    display.Representation = "Surface With Edges" if few else "Surface"
    display.EdgeColor = [0.35, 0.35, 0.35]
    display.Ambient = 0.3
    name = body.stress()
    if name is None:
        display.ColorArrayName = ["POINTS", ""]
        return
    colour(simple, view, display, body.fields()[name][0], name, (0.0, body.ranges[name][1]), "Viridis (matplotlib)",
           "von Mises stress", [0.87, 0.58])


def show_pressure(simple, view, body):
    """Shows dots at nodes under contact pressure; nothing if the run has none."""
    largest = body.ranges.get(PRESSURE, (0.0, 0.0))[1]
    if largest <= 0.0:
        return
    nodes = simple.MaskPoints(Input=body.shown, OnRatio=1, GenerateVertices=1, SingleVertexPerCell=1)
    nodes.MaximumNumberofPoints = max(body.shown.GetDataInformation().GetNumberOfPoints(), 1)
    pressed = simple.Threshold(registrationName="contact", Input=nodes, Scalars=["POINTS", PRESSURE])
    pressed.ThresholdMethod, pressed.UpperThreshold = "Above Upper Threshold", 1e-6 * largest
    display = simple.Show(pressed, view)
    display.Representation = "Points"
    display.PointSize, display.RenderPointsAsSpheres = 9.0, 1
    colour(simple, view, display, "POINTS", PRESSURE, (0.0, largest), "Reds", "contact pressure", [0.87, 0.1], inverted=True)  # dark where it is large


def show_obstacles(simple, view, path):
    """Shows the obstacles. Returns their bounds, or None."""
    if path is None:
        return None
    reader = open_file(simple, path)
    reader.UpdatePipeline()
    display = simple.Show(reader, view)
    display.ColorArrayName = ["POINTS", ""]
    display.DiffuseColor = display.AmbientColor = GREY
    display.LineWidth = 3.0
    display.Ambient = 0.3
    return reader.GetDataInformation().GetBounds()


def set_camera(view, body, up):
    """Sets the camera so that all of the motion is visible: from the front in the plane, from above in space."""
    low, high = body.bounds[0::2], body.bounds[1::2]
    centre = [0.5 * (a + b) for a, b in zip(low, high)]
    size = sum((b - a) ** 2 for a, b in zip(low, high)) ** 0.5 or 1.0
    plane = body.is_plane()
    direction = ([0.0, 0.0, 1.0] if plane else
                 {0: [0.3, 0.4, 0.87], 1: [0.4, 0.3, 0.87], 2: [0.4, -0.87, 0.3]}[up])
    view.CameraFocalPoint = centre
    view.CameraPosition = [c + 1.8 * size * d for c, d in zip(centre, direction)]
    view.CameraViewUp = [0.0, 1.0, 0.0] if plane else [1.0 if k == up else 0.0 for k in range(3)]
    view.CameraParallelProjection = 1 if plane else 0
    view.CameraParallelScale = 0.62 * size


def show_run(simple, directory, time=None):
    """Returns the view and a description of the run."""
    body_file, obstacle_file = find_files(directory)
    body = Body(simple, body_file, obstacle_file is not None)
    view = simple.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground, view.Background = 0, WHITE
    view.OrientationAxesLabelColor = BLACK
    if body.times:
        chosen = body.times[-1] if time is None else min(body.times, key=lambda each: abs(each - time))
        simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
        simple.GetAnimationScene().AnimationTime = chosen
        view.ViewTime = chosen
        body.shown.UpdatePipeline(chosen)
    up = flat_axis(show_obstacles(simple, view, obstacle_file))
    show_body(simple, view, body, body.shown if body.is_plane() else cut_open(simple, body, up))
    show_pressure(simple, view, body)
    simple.Render(view)  # the first rendering sets a camera of its own
    set_camera(view, body, up)
    simple.Render(view)
    told = [f"{os.path.abspath(body_file)}: {max(len(body.times), 1)} frames"]
    if body.times:
        told[0] += f", from t = {body.times[0]:g} to {body.times[-1]:g}, shown at {chosen:g}"
    elif body_file.endswith(".vtkhdf"):
        told.append("this ParaView finds no times in the file: it has one frame, or ParaView is older than 5.12 and "
                    "shows only the first")
    for name in (body.stress(), PRESSURE):
        if name in body.ranges:
            told.append("{}: from {:.6g} to {:.6g}".format(name, *body.ranges[name]))
    return view, told


def main(arguments):
    from paraview import simple  # here: tests import this file without ParaView
    try:
        if len(arguments) > 3:
            raise Problem("too many arguments: at most DIR PICTURE.png TIME are accepted")
        time = float(arguments[2]) if len(arguments) == 3 else None
        view, told = show_run(simple, directory_of_run(simple, arguments), time)
    except (Problem, ValueError) as problem:
        print(f"show_in_paraview.py: {problem}", file=sys.stderr)
        return 2
    print("\n".join(told))
    if len(arguments) > 1:
        view.ViewSize = [1200, 800]
        simple.SaveScreenshot(arguments[1], view)
    return 0


if __name__ in ("__main__", "__vtkconsole__"):
    status = main(sys.argv[1:])
    if status != 0 and len(sys.argv) > 1:
        sys.exit(status)
