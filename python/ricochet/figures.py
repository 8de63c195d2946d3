"""Figures and reports of runs, drawn by the code that `ricochet plot` and `ricochet report` have."""

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
        raise UsageError(f"runs, or their directories, are needed, not {runs!r}")
    directories = [library_path(getattr(run, "directory", run), "a run") for run in runs]
    if not directories:
        raise UsageError("there is no run to be shown")
    return directories


def plot(runs, *what, labels=None, title="", time=None, logarithmic=False, size=None):
    """A matplotlib figure of one run or several, or of one study.

    `what`, a panel for each: "energy", "force", "momentum", "pressure", "pressure-map", "probe:NAME.COLUMN" or any column of
    the history (of a study "COLUMN-against-KEY", "order", "work-precision"). Without any: energy and force. `labels`: of the
    runs. `time`: the part that is shown, (first, last). `size`: width and height in cm.
    """
    from . import figure

    directories = directories_of(runs)
    width, height = size or (0.0, 0.0)
    if any(_core.holds_study(directory) for directory in directories):
        if len(directories) > 1 or labels or time:
            raise UsageError("plot: a figure of a study shows this study alone, without labels and time")
        return figure.draw(json.loads(_core.describe_study(directories[0], list(what), title, logarithmic, width, height)))
    text = _core.describe_runs(directories, list(what) or ["energy", "force"], list(labels or []), title, time, logarithmic, width,
                               height)
    return figure.draw(json.loads(text))


def write_report(runs, path):
    """Writes the report of one run or several for a browser: one file with all that it needs. Returns its path."""
    html, thinned = _core.make_report(directories_of(runs), shared_file("viewer.html"))
    for sentence in thinned:
        logger.info("%s", sentence)
    path = path_of(path, "report")
    write_whole(path, html.encode("utf-8", "surrogateescape"))
    return path
