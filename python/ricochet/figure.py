"""Draws the figures that the program and the Python package describe. Requires matplotlib.

As a script: figure.py FORMAT OUTPUT < DESCRIPTION. It ends with status 3 if matplotlib is missing, and with status 5 if ffmpeg,
which makes .mp4 files, is missing. The same description produces the same bytes.
"""

import json
import math
import sys

try:
    import matplotlib
    import matplotlib.pyplot as plt
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.lines import Line2D
    from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator, ScalarFormatter
except ImportError as problem:
    if __name__ != "__main__":
        raise
    print(problem)
    sys.exit(3)

CENTIMETRE = 1 / 2.54
# Colours of Okabe and Ito, distinguishable with any kind of colour vision; the same as in reports.
ALONE = "#1b1f24"
COLOURS = ["#c8460a", "#0068b0", "#00785a", "#a8519a", "#8a6d00", "#2a8fbf", "#6b4c9a", "#5b5b5b"]
# With more runs than colours, the colours repeat with another pattern of the lines.
PATTERNS = ["-", (0, (6, 2)), (0, (1.5, 1.5)), (0, (7, 2, 1.5, 2)), (0, (7, 2, 1.5, 2, 1.5, 2)), (0, (12, 3)), (0, (3, 3)), (0, (1.5, 4))]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]

STYLE = {
    "font.size": 9, "axes.titlesize": 9, "legend.fontsize": 8, "font.family": "DejaVu Sans",
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.3, "grid.linewidth": 0.5,
    "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6, "svg.hashsalt": "ricochet",
    "pdf.fonttype": 42, "savefig.dpi": 200, "agg.path.chunksize": 10000, "path.simplify": False,
}


def widths(panel):
    """Returns the line widths. Smooth curves, which may coincide, are wider the further below they lie; rattling curves are thin.
    More than three curves have one width: it could not show which lies below, and differences would seem to have a meaning."""
    if len(panel["curves"]) > 3:
        return [1.2] * len(panel["curves"])
    result, above = [], 0
    for curve in reversed(panel["curves"]):
        result.append(0.6 if curve["rattles"] else 0.9 + 0.9 * above)
        above += not curve["rattles"]
    if panel["y_label"] == "total energy":
        return [1.4 if len(result) > 1 else 0.8] * len(result)  # and the top curve is dashed
    return result[::-1] if len(result) > 1 else [0.8]


def literal(text):
    """Returns a name or title for literal display: without mathematics, and in a legend even if empty or with a leading "_"."""
    text = text.replace("$", r"\$")
    return f" {text}" if not text or text.startswith("_") else text


def in_powers(value):
    if 1e-3 <= abs(value) < 1e4:
        return f"{value:.4g}"
    mantissa, exponent = f"{value:.2e}".split("e")
    return rf"${float(mantissa):g} \cdot 10^{{{int(exponent)}}}$"


def handle_length(count):
    """Returns a length that suffices to distinguish the patterns."""
    return 2.0 if count <= len(COLOURS) else 3.5


def draw_curves(axes, panel, several):
    count = len(panel["curves"])
    for i, (curve, width) in enumerate(zip(panel["curves"], widths(panel))):
        # Where curves coincide, the one below shows through the dashes of the top curve.
        dashed = 1 < count <= 3 and i == count - 1 and panel["y_label"] == "total energy"
        colour = COLOURS[curve["run"] % len(COLOURS)] if several else ALONE
        pattern = PATTERNS[curve["run"] // len(COLOURS) % len(PATTERNS)]
        axes.plot(curve["x"], [math.nan if y is None else y for y in curve["y"]], color=colour, label=literal(curve["label"]),
                  lw=width, ls=(0, (5, 4)) if dashed else pattern)
    axes.set_xlabel(panel["x_label"])
    axes.set_ylabel(literal(panel["y_label"]))
    if panel["logarithmic"]:
        axes.set_yscale("log")
    else:
        if "range" in panel:
            axes.set_ylim(*panel["range"])
        axes.yaxis.set_major_formatter(ScalarFormatter(useMathText=True))
        axes.ticklabel_format(axis="y", scilimits=(-3, 4))
    first, last = panel["times"]
    margin = 0.02 * (last - first)
    axes.set_xlim(first - margin, last + margin)
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.xaxis.set_major_formatter(ScalarFormatter(useMathText=True))
    axes.ticklabel_format(axis="x", scilimits=(-3, 4), useOffset=False)
    notes = ", ".join(f"{literal(name)} reaches {in_powers(value)}" for name, value in panel.get("notes", []))
    axes.set_title(notes, loc="right", fontsize=7, color="0.35")


def draw_legend(axes, panel):
    """Draws the legend inside the axes, where the curves leave room for short names."""
    handles, labels = axes.get_legend_handles_labels()
    order = sorted(range(len(handles)), key=lambda i: panel["curves"][i]["run"])
    legend = axes.legend([handles[i] for i in order], [labels[i] for i in order], frameon=False, handlelength=handle_length(len(order)))
    legend.set_in_layout(False)  # the axes keep their width


def borders(places):
    """Returns the midpoints between positions, and one point as far beyond each end."""
    between = [(a + b) / 2 for a, b in zip(places, places[1:])]
    return [2 * places[0] - between[0], *between, 2 * places[-1] - between[-1]]


def draw_map(figure, axes, panel, is_first):
    pieces = [*panel["pieces"], len(panel["y"])]
    x = borders(panel["x"])
    for begin, end in zip(pieces, pieces[1:]):
        if end - begin < 2:
            continue
        values = [[math.nan if row[i] is None else row[i] for row in panel["values"]] for i in range(begin, end)]
        image = axes.pcolormesh(x, borders(panel["y"][begin:end]), values, cmap="viridis", vmin=0, vmax=panel["high"],
                                rasterized=True)
    axes.set_xlim(panel["x"][0], panel["x"][-1])
    axes.set_xlabel(panel["x_label"])
    axes.set_ylabel(panel["y_label"] if is_first else "")
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.set_title(literal(panel["title"]))
    axes.grid(False)
    most = max((value for row in panel["values"] for value in row if value is not None), default=0)
    power = 0 if 1e-3 <= panel["high"] < 1e4 else math.floor(math.log10(panel["high"]))
    label = panel["value_label"] + (rf", $\times 10^{{{power}}}$" if power else "")
    bar = figure.colorbar(image, ax=axes, location="bottom", aspect=30, label=label,
                          extend="max" if most > 1.02 * panel["high"] else "neither")
    bar.ax.xaxis.set_major_locator(MaxNLocator(4))
    bar.ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / 10 ** power:g}"))
    bar.outline.set_linewidth(0.6)


def draw_slopes(axes, panel):
    """Draws guides of integer orders from a common point, below all curves."""
    points = [point for curve in panel["curves"] for point in zip(curve["x"], curve["y"])]
    left, right = min(x for x, _ in points), max(x for x, _ in points)
    right = left * (right / left) ** 0.5  # leaves most of the panel to the curves
    start = 0.5 * min(y * (left / min(x, right)) ** order for x, y in points if x <= 2.5 * right for order in panel["slopes"])
    for order in panel["slopes"]:
        end = start * (right / left) ** order
        axes.plot([left, right], [start, end], color="0.55", lw=0.8, ls=(0, (4, 3)), zorder=1)
        axes.annotate(f"order {order}", (right, end), xytext=(4, 0), textcoords="offset points", fontsize=7, color="0.4",
                      va="center", annotation_clip=False)


def name_steps(axes, panel):
    """Uses the values themselves as ticks of a logarithmic scale, if there is room for them."""
    values = sorted({x for curve in panel["curves"] for x in curve["x"]})
    axes.xaxis.set_minor_locator(NullLocator())
    if len(values) <= 8 and all(b / a > 1.3 for a, b in zip(values, values[1:])):
        every = 1 if len(values) <= 4 else 2
        axes.set_xticks(values, ["" if i % every else in_powers(x) for i, x in enumerate(values)])
    else:
        name_decades(axes.xaxis)
    if values[-1] < 3 * values[0]:
        axes.set_xlim(values[0] / 1.15, values[-1] * 1.15)


def name_decades(axis):
    """Labels the decades of an axis, and 2 and 5 times each if there are at most two."""
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1.0,) if high > 100 * low else (1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: in_powers(value)))
    axis.set_minor_formatter(NullFormatter())


def folded(label):
    """Returns a label, on two lines if it is long."""
    if len(label) < 26:
        return literal(label)
    middle = len(label) // 2
    at = label.index(" of ") + 4 if " of " in label else label.find(".", middle) + 1
    return literal(label[:at].rstrip()) + "\n" + literal(label[at:])


def look(i, labels, panel):
    return {"color": COLOURS[i % len(COLOURS)] if len(labels) > 1 else ALONE, "marker": MARKERS[i % len(MARKERS)], "ms": 4,
            "lw": 0 if panel["categories"] else 1.1, "ls": PATTERNS[i // len(COLOURS) % len(PATTERNS)]}


def labels_of(panels):
    return list(dict.fromkeys(curve["label"] for panel in panels for curve in panel.get("curves", [])))


def draw_lines(axes, panel, labels):
    """Draws the lines of a panel. `labels`: labels of the lines of all panels; their order determines colours and markers."""
    curves = panel["curves"]
    for curve in curves:
        i = labels.index(curve["label"])
        # Categories have no order: their points are not joined, and those of one category are side by side.
        x = [x + 0.08 * (i - (len(labels) - 1) / 2) for x in curve["x"]] if panel["categories"] else curve["x"]
        axes.plot(x, curve["y"], zorder=2, **look(i, labels, panel))
    axes.set_xlabel(literal(panel["x_label"]))
    axes.set_ylabel(folded(panel["y_label"]))
    if panel["log_y"]:
        axes.set_yscale("log")
        name_decades(axes.yaxis)
    else:
        axes.yaxis.set_major_formatter(ScalarFormatter(useMathText=True))
        axes.ticklabel_format(axis="y", scilimits=(-3, 4), useOffset=False)
    if panel["categories"]:
        axes.set_xticks(range(len(panel["categories"])), [literal(name) for name in panel["categories"]])
        axes.set_xlim(-0.5, len(panel["categories"]) - 0.5)
    elif panel["log_x"]:
        axes.set_xscale("log")
        name_steps(axes, panel) if panel["names_steps"] else name_decades(axes.xaxis)
    else:
        axes.xaxis.set_major_locator(MaxNLocator(4))
    if panel["slopes"]:
        draw_slopes(axes, panel)
    axes.set_title(panel["note"], loc="right", fontsize=7, color="0.35")


def legend_width(labels):
    """Returns the width of one column of a legend in cm."""
    return 1.4 + 0.16 * max(map(len, labels))


def curve_lines(panels):
    """Returns the lines and labels of runs for a legend, in the order of the runs."""
    runs = sorted({(curve["run"], curve["label"]) for panel in panels for curve in panel.get("curves", [])})
    return [Line2D([], [], color=COLOURS[run % len(COLOURS)], ls=PATTERNS[run // len(COLOURS) % len(PATTERNS)], lw=1.2) for run, _ in runs], \
        [label for _, label in runs]


def common_legend(panels, panel_width):
    """Returns lines and labels of a legend for all panels: for studies always, for runs if their names would hide the curves."""
    if panels[0]["kind"] == "lines":
        labels = labels_of(panels)
        return [Line2D([], [], **look(i, labels, panels[0])) for i in range(len(labels))], labels
    handles, labels = curve_lines(panels)
    is_large = len(labels) > 1 and (legend_width(labels) > 0.5 * panel_width or len(labels) > len(COLOURS))
    return (handles, labels) if is_large else ([], [])


def add_head(figure, handles, labels, title, width, height, may_grow):
    """Adds title and legend above all panels, since no space inside them is certainly free. The figure grows by their height,
    unless its size is prescribed."""
    if labels == [""]:
        labels = []
    columns = max(1, min(len(labels), int((width - 0.5) / legend_width(labels)))) if labels else 1
    title_room = 0.75 if title else 0.0
    room = title_room + (0.45 * -(-len(labels) // columns) + 0.25 if labels else 0.0)
    whole = height + room if may_grow else height
    figure.set_size_inches(width * CENTIMETRE, whole * CENTIMETRE)
    top = max(0.3, 1 - room / whole)
    figure.get_layout_engine().set(rect=(0, 0, 1, top))
    if labels:
        figure.legend(handles, list(map(literal, labels)), loc="lower left", bbox_to_anchor=(0.01, top), ncol=columns, frameon=False,
                      borderaxespad=0.0, handlelength=handle_length(len(labels)))
    if title:
        figure.text(0.5, 1 - 0.5 * title_room / whole, literal(title), fontsize=10, ha="center", va="center")


def overlap(axes, renderer):
    """Returns whether labels of ticks below the axes touch each other."""
    boxes = sorted((label.get_window_extent(renderer) for label in axes.get_xticklabels() if label.get_text() and label.get_visible()),
                   key=lambda box: box.x0)
    return any(a.x1 + 0.3 * a.height > b.x0 for a, b in zip(boxes, boxes[1:]))


def spread_ticks(figure, grid):
    """Reduces the number of tick labels that overlap, or rotates them if they are words."""
    canvas = figure.canvas if hasattr(figure.canvas, "get_renderer") else FigureCanvasAgg(figure)
    renderer = canvas.get_renderer()
    for bins in (3, 2):
        figure.draw_without_rendering()
        crowded = [axes for axes in grid.flat if axes.axison and overlap(axes, renderer)]
        for axes in crowded:
            if isinstance(axes.xaxis.get_major_locator(), MaxNLocator):
                axes.xaxis.set_major_locator(MaxNLocator(bins))
            elif isinstance(axes.xaxis.get_major_locator(), FixedLocator):
                plt.setp(axes.get_xticklabels(), rotation=25, ha="right", rotation_mode="anchor")
        if not crowded:
            break


def draw(description):
    """Returns the figure of a description (a dictionary). A user's settings for other figures have no effect on it, and stay."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        plt.rcParams.update(STYLE)
        return draw_panels(description)


def draw_panels(description):
    panels = description["panels"]
    columns = len(panels) if len(panels) <= 3 else 2
    rows = -(-len(panels) // columns)
    width = description["width"] or (9 if columns == 1 else 17)
    height = description["height"] or (6.2 if columns < 3 else 5.2) * rows
    figure, grid = plt.subplots(rows, columns, figsize=(width * CENTIMETRE, height * CENTIMETRE), squeeze=False,
                                constrained_layout=True)
    handles, labels = common_legend(panels, width / columns)
    for i, axes in enumerate(grid.flat):
        if i >= len(panels):
            axes.set_axis_off()
        elif panels[i]["kind"] == "map":
            draw_map(figure, axes, panels[i], i % columns == 0 or panels[i - 1]["kind"] != "map")
        elif panels[i]["kind"] == "lines":
            draw_lines(axes, panels[i], labels_of(panels))
        else:
            several = len(panels[i]["curves"]) > 1
            draw_curves(axes, panels[i], several)
            if several and not labels:
                draw_legend(axes, panels[i])
            if "time" in description:
                axes.set_xlim(*description["time"])
    add_head(figure, handles, labels, description["title"], width, height, not description["height"])
    spread_ticks(figure, grid)
    return figure


def draw_scene(description, form, output):
    """Draws a moving body with scene.py, which is beside this script. Exits with status 5 if the format requires a missing program."""
    import scene

    try:
        scene.write_described(description, form, output)
    except scene.NoFfmpeg as problem:
        print(problem)
        sys.exit(5)


def main(form, output):
    matplotlib.use("Agg")
    matplotlib.rcdefaults()
    plt.rcParams.update(STYLE)
    description = json.load(sys.stdin)
    if "frames" in description:
        return draw_scene(description, form, output)
    figure = draw_panels(description)
    # Metadata must not change from day to day.
    metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}[form]
    figure.savefig(output, format=form, metadata=metadata)


if __name__ == "__main__":
    main(*sys.argv[1:])
