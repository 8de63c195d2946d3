"""Figures and reports of runs, drawn by the code of `ricochet plot` and `ricochet report`."""

import json
import os
from collections.abc import Iterable

from . import _core
from .errors import UsageError
from .files import library_path, path_of, write_whole
from .messages import logger
from .program import shared_file


def directories_of(runs):
    runs = [runs] if isinstance(runs, (str, bytes, os.PathLike)) or hasattr(runs, "directory") else runs
    if not isinstance(runs, Iterable):
        raise UsageError(f"runs or their directories are required, not {runs!r}")
    directories = [library_path(getattr(run, "directory", run), "run") for run in runs]
    if not directories:
        raise UsageError("the list of runs is empty; name at least one run")
    return directories


def plot(runs, *what, labels=None, title="", time=None, logarithmic=False, size=None):
    """Returns a matplotlib figure of one or more runs, or of one study.

    Each argument in `what` is one panel: "energy", "force", "momentum", "pressure", "pressure-map", "probe:NAME.COLUMN" or any
    column of the history; for a study "COLUMN-against-KEY", "order" or "work-precision". The default is energy and force.
    `labels`: names of the runs. `time`: the interval shown, (first, last). `size`: width and height in cm.
    """
    from . import figure

    directories = directories_of(runs)
    width, height = size or (0.0, 0.0)
    if any(_core.holds_study(directory) for directory in directories):
        if len(directories) > 1 or labels or time:
            raise UsageError("plot: a figure of a study shows one study alone; omit other runs, `labels` and `time`")
        return figure.draw(json.loads(_core.describe_study(directories[0], list(what), title, logarithmic, width, height)))
    text = _core.describe_runs(directories, list(what) or ["energy", "force"], list(labels or []), title, time, logarithmic, width,
                               height)
    return figure.draw(json.loads(text))


def write_report(runs, path):
    """Writes the report of one or more runs for a browser, a single self-contained file. Returns its path."""
    html, thinned = _core.make_report(directories_of(runs), shared_file("viewer.html"))
    for sentence in thinned:
        logger.info("%s", sentence)
    path = path_of(path, "report")
    write_whole(path, html.encode("utf-8", "surrogateescape"))
    return path
