"""Runs, finished or in progress, read from their directories."""

import json
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple, Optional, Tuple

import numpy

from . import _core
from .converter.file_mesh import TYPES
from .errors import Error, ExpectationError, InputError, UsageError, unknown_name
from .files import library_path
from .messages import logger

if TYPE_CHECKING:
    from ._summary import Summary


def unknown_field(what, name, written, known):
    """Returns the KeyError for a name that is none of the known ones, among them the fields that a run has written. A field
    that it could have written is named as such."""
    possible = json.loads(_core.case_schema())["properties"]["output"]["properties"]["fields"]["items"]["enum"]
    if name == "all" or name not in possible:
        return unknown_name(what, name, known)
    return KeyError(f'the run has not written the field "{name}": add it to output.fields of the case and run it again; '
                    f'the frames have {", ".join(written) or "no fields"}')


class Maximum(NamedTuple):
    """The largest value of a field or column, its time, and its position in the undeformed body: for a cell its centre, for a
    column of the history None. `among` names the range of the search: "every state" of the run, "N of M states", "frames" or
    "rows of the history"."""

    value: float
    time: float
    place: Optional[Tuple[float, ...]]
    among: str


class Entries(dict):
    """Entries of summary.json; the KeyError for an unknown one lists similar names."""

    def __missing__(self, name):
        raise unknown_name("entry", name, self)


class History(Mapping):
    """Columns of a run's history, and of its probes that have rows of their own, as numpy arrays without copies."""

    def __init__(self, data):
        self._data, self._names = data, list(data.column_names)

    def _check(self, name):
        if name not in self._names:
            raise unknown_name("column of the history", name, self._names)

    def __getitem__(self, name):
        self._check(name)
        return self._data.column(name)

    def times_of(self, name):
        """Returns the times of a column's rows. Probes with an interval of their own have fewer or more rows than the history."""
        self._check(name)
        return self._data.times_of(name)

    def __iter__(self):
        return iter(self._names)

    def __len__(self):
        return len(self._names)

    def to_pandas(self):
        """Returns a pandas.DataFrame of the columns of history.csv, indexed by time."""
        import pandas

        times = self["time"]
        same = {name: self[name] for name in self if len(self[name]) == len(times) and name != "time"}
        return pandas.DataFrame(same, index=pandas.Index(times, name="time"))

    def __repr__(self):
        return f"<History of {len(self['time'])} rows: {', '.join(self._names)}>"


class Frame(Mapping):
    """Fields at one time. frame["von_mises"] is a numpy array, on points (points x components) or on cells."""

    def __init__(self, run, number):
        self._run, self.number, self.time = run, number, run._data.frame_times[number]

    def __getitem__(self, name):
        if name not in self._run.fields:
            raise unknown_field("field", name, self._run.fields, self._run.fields)
        return self._run._data.read_field(self.number, name)

    def __iter__(self):
        return iter(self._run.fields)

    def __len__(self):
        return len(self._run.fields)

    @property
    def points(self):
        """Positions of the points in the undeformed body, points x dimension."""
        return self._run.points

    @property
    def positions(self):
        """Current positions of the points, points x dimension."""
        return self.points + self["displacement"][:, :self._run.dimension]

    @property
    def cells(self):
        """List of (kind, cells x points), one for each block, with meshio's names and VTK's order."""
        return self._run.cells

    def to_meshio(self):
        """Returns a meshio.Mesh of this frame."""
        import meshio

        run = self._run
        points = numpy.zeros((len(run.points), 3))
        points[:, :run.dimension] = run.points
        at_points = {name: self[name] for name in run.fields if run.is_on_points(name)}
        borders = numpy.cumsum([len(nodes) for _, nodes in self.cells])[:-1]
        at_cells = {name: numpy.split(self[name], borders) for name in run.fields if not run.is_on_points(name)}
        return meshio.Mesh(points, list(self.cells), point_data=at_points, cell_data=at_cells)

    def plot(self, field="von_mises", **options):
        """Returns a matplotlib figure of the deformed body, coloured by a field. The options are those of the function
        ricochet.picture: axes, limits, scale, colours, view, bar, zoom, half."""
        from .pictures import picture

        return picture(self, field, **options)

    def __repr__(self):
        return f"<Frame {self.number} at t = {self.time:.6g}: {', '.join(self._run.fields)}>"


class Frames:
    """Sequence of all frames of a run."""

    def __init__(self, run):
        self._run = run

    def __len__(self):
        return len(self._run._data.frame_times)

    def __getitem__(self, number):
        if isinstance(number, slice):
            return [Frame(self._run, k) for k in range(*number.indices(len(self)))]
        if not -len(self) <= number < len(self):
            raise IndexError(f"frame {number} does not exist: the run has {len(self)} frames")
        return Frame(self._run, int(number) % len(self))

    @property
    def times(self):
        return numpy.array(self._run._data.frame_times)

    def __repr__(self):
        return f"<{len(self)} frames>"


class Run:
    """Results of a run, finished or in progress, in its directory."""

    summary: "Summary"

    def __init__(self, directory):
        self.directory = library_path(directory, "open")
        self.reload()

    def reload(self):
        """Reads the results of a run in progress again. Arrays obtained before do not change. Returns this run."""
        self._data = _core.read_run(self.directory)
        self.summary = json.loads(self._data.summary_json, object_hook=Entries)
        self.history = History(self._data)
        return self

    @property
    def status(self):
        """One of "done", "running", "failed" and "interrupted"; the last also if the run was killed or its session dropped."""
        status = self.summary["status"]
        return "interrupted" if status == "running" and not _core.is_in_use(self.directory) else status

    @property
    def time(self):
        """Times of the rows of the history."""
        return self.history["time"]

    @property
    def warnings(self):
        return list(self.summary["warnings"]) + list(self._data.notes)

    @property
    def dimension(self):
        return self._data.dimension

    @property
    def fields(self):
        """Names of the fields in the frames."""
        return [name for name, _, _ in self._data.fields]

    def is_on_points(self, field):
        """Returns whether a field has values on points, not on cells."""
        return next(on_points for name, on_points, _ in self._data.fields if name == field)

    @property
    def points(self):
        """Positions of the points in the undeformed body, points x dimension."""
        return self._data.points[:, :self.dimension]

    @property
    def cells(self):
        """List of (kind, cells x points), one for each block, with meshio's names and VTK's order."""
        return self._data.cells

    @property
    def contact_facets(self):
        """Facets of the contact boundary, in the form of `cells`."""
        return self._data.contact_facets

    @property
    def frames(self):
        return Frames(self)

    def frame(self, t=None, *, number=None):
        """Returns the frame nearest to the time `t`, or the frame with a number (-1: the last)."""
        frames = self.frames
        if len(frames) == 0:
            raise InputError(f"{self.directory}: the run has written no fields; set output.fields_every")
        if (t is None) == (number is None):
            raise UsageError("frame: pass either a time or a number")
        if number is not None:
            return frames[number]
        if not isinstance(t, (int, float, numpy.number)):
            raise UsageError(f"frame: {t!r} is not a time; select a field from a frame: run.frame(t=0.1)[{t!r}]")
        times = frames.times
        if not numpy.isfinite(t) or t < times[0] - 1e-9 * abs(times[-1]) or t > times[-1] * (1 + 1e-9):
            raise UsageError(f"frame: the time {t} is outside the range of the frames, from {times[0]:.9g} to {times[-1]:.9g}")
        return frames[int(numpy.abs(times - t).argmin())]

    def maximum(self, name):
        """Returns the largest value of a field, with its time and position, or of a column of the history, with its time. The
        search covers all states that the run evaluated for the von Mises stress, and only the frames for other fields. Vectors
        are compared by their lengths."""
        peak = self.summary["peak_stress"]
        if name == "von_mises" and peak:
            return Maximum(peak["von_mises"], peak["time"], tuple(peak["place"]), "every state" if peak["states_looked_at"] ==
                           peak["states"] else f"{peak['states_looked_at']} of {peak['states']} states")
        if name in self.fields:
            return self._largest_in_frames(name)
        if name not in self.history:
            raise unknown_field("field or column of the history", name, self.fields, self.fields + list(self.history))
        values = self.history[name]
        at = int(numpy.nanargmax(values))
        return Maximum(float(values[at]), float(self.history.times_of(name)[at]), None, "rows of the history")

    def _largest_in_frames(self, name):
        best = None
        for frame in self.frames:
            values = frame[name]
            if values.ndim == 2:
                if values.shape[1] > 3:
                    raise UsageError(f'maximum: the field "{name}" is a tensor; use one of its components from the frames')
                values = numpy.linalg.norm(values, axis=1)
            if values.size == 0 or numpy.isnan(values).all():
                continue
            at = int(numpy.nanargmax(values))
            if best is None or values[at] > best[0]:
                best = (float(values[at]), frame.time, at)
        if best is None:
            raise InputError(f'{self.directory}: the field "{name}" has no value in any frame')
        place = self.points[best[2]] if self.is_on_points(name) else self._centre(best[2])
        return Maximum(best[0], best[1], tuple(float(x) for x in place), "frames")

    def _centre(self, cell):
        for kind, nodes in self.cells:
            if cell < len(nodes):
                own = nodes[cell][:TYPES[kind].vertices]
                return self.points[own].mean(axis=0)
            cell -= len(nodes)
        raise IndexError(cell)

    @property
    def impacts(self):
        """List of dictionaries, one for each impact: begin, duration, restitution, largest_force, normal_velocity_before, ..."""
        return self.summary["impacts"]

    @property
    def expectations(self):
        """List of dictionaries, one for each [[expect]] entry: quantity, value, wanted, checked, holds, note."""
        return self.summary["expectations"]

    def _broken_expectations(self):
        return [entry for entry in self.expectations if entry["checked"] and not entry["holds"]]

    def _warn_of_expectations(self):
        for entry in self._broken_expectations():
            logger.warning("%s", self._text_of(entry))

    def _text_of(self, entry):
        found = entry["note"] or f"found {entry['value']:.9g}"
        return f"{entry['location']}: expected {entry['name'] or entry['quantity']} to be {entry['wanted']}, {found}"

    def check(self):
        """Raises ExpectationError if an applicable [[expect]] entry does not hold, and Error with the message of the run if the
        run has failed. Returns this run."""
        if self.status == "failed":
            raise Error(f"{self.directory}: the run has failed: {self.summary['message']}")
        broken = self._broken_expectations()
        if broken:
            raise ExpectationError("\n".join(self._text_of(entry) for entry in broken))
        return self

    def plot(self, *what, **options):
        """Returns a matplotlib figure of this run; see ricochet.plot."""
        from .figures import plot

        return plot([self], *what, **options)

    def animate(self, path, field="von_mises", **options):
        """Writes the frames as an animation, a .gif file or, if ffmpeg is installed, an .mp4 file. Returns its path. Options:
        `time` (first, last), `title`, `size` in cm, and `view`, `limits`, `zoom` and `half` as for the plot of a frame."""
        from .pictures import animate_run

        return animate_run(self, path, field, **options)

    def report(self, path=None):
        """Writes the report for a browser, a single file, by default report.html in the directory of the run. Returns its path."""
        from .figures import write_report

        return write_report([self], path or os.path.join(self.directory, "report.html"))

    def __repr__(self):
        return f"<Run {self.directory}: {self.status}, {self.summary['steps']} steps to t = {self.time[-1]:.6g}>"

    def _repr_html_(self):
        from .page import page_of

        return page_of(self)


def open(directory):
    """Returns the Run in a directory, finished or in progress."""
    return Run(directory)
