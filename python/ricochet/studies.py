"""Studies: runs of one case with different values, several at a time, and their table."""

import html
import os
from collections.abc import Mapping

import numpy

from . import _core
from .case import Case, change_texts, toml_value
from .errors import UsageError, unknown_name
from .files import library_path
from .program import program


def as_numbers(texts):
    """Returns the values of a key, which are strings in the table, as numbers if all of them are numbers."""
    try:
        return [float(text) for text in texts]
    except (TypeError, ValueError):
        return texts


class Study(Mapping):
    """The table of a study: study["restitution"] is a column as a numpy array. `notes` state the meaning of columns and why runs
    failed; `warnings` are those of the runs."""

    def __init__(self, directory, parts):
        self.directory = directory
        self.columns, self.rows, self.notes, self.warnings, self.done = parts

    def __getitem__(self, name):
        if name not in self.columns:
            raise unknown_name("column of the table", name, self.columns)
        at = self.columns.index(name)
        values = [row[at] for row in self.rows]
        if at < self.columns.index("run"):
            values = as_numbers(values)
        if all(value is None or isinstance(value, (int, float)) for value in values):
            return numpy.array([numpy.nan if value is None else value for value in values])
        return numpy.array(["" if value is None else str(value) for value in values])

    def __iter__(self):
        return iter(self.columns)

    def __len__(self):
        return len(self.columns)

    @property
    def runs(self):
        """List of the runs that can be read, in the order of the rows."""
        from .results import Run

        return [Run(os.path.join(self.directory, "runs", str(name))) for name in self["run"]
                if _core.holds_run(os.path.join(self.directory, "runs", str(name)))]

    def to_pandas(self):
        import pandas

        return pandas.DataFrame({name: self[name] for name in self.columns})

    @property
    def table(self):
        """A pandas.DataFrame if pandas is installed; otherwise this study, whose columns are numpy arrays."""
        try:
            return self.to_pandas()
        except ImportError:
            return self

    def plot(self, *what, **options):
        """Returns a matplotlib figure of this study; see ricochet.plot."""
        from .figures import plot

        return plot([self], *what, **options)

    def __repr__(self):
        return f"<Study {self.directory}: {self.done} of {len(self.rows)} runs done; {', '.join(self.columns)}>"

    def _repr_html_(self):
        head = "".join(f"<th>{html.escape(name)}</th>" for name in self.columns)
        cell = lambda value: "" if value is None else f"{value:.5g}" if isinstance(value, float) else html.escape(str(value))
        rows = "".join("<tr>" + "".join(f"<td>{cell(value)}</td>" for value in row) + "</tr>" for row in self.rows)
        return f"<table><tr>{head}</tr>{rows}</table>"


def axis_of(key, values):
    """Returns a key (or a tuple of keys that change together) and its values in the form of the library."""
    keys = [key] if isinstance(key, str) else list(key)
    if isinstance(values, str) or not hasattr(values, "__iter__"):
        raise UsageError(f"study: the values of {key} must be a list, not {values!r}")
    rows = [[value] if isinstance(key, str) or not isinstance(value, (list, tuple)) else list(value) for value in values]
    for row in rows:
        if len(row) != len(keys):
            raise UsageError(f"study: {', '.join(keys)} change together: each value must be a tuple of {len(keys)}, not {row!r}")
    return keys, [["-" if value is None else toml_value(value, (key,)) for key, value in zip(keys, row)] for row in rows]


def study(source, vary, directory, changes=None, *, mesh=None, jobs=0, threads=1, quantities=(), exact=None, reference="", compare=(),
          order="", resume=False, force=False):
    """Runs a case with all combinations of values, several at a time, each in its own process, and returns the Study.

    `vary`: {"time.step": [1e-3, 5e-4], ("mesh.file", "time.step"): [("a.msh", 1e-3), ("b.msh", 5e-4)]}; None stands for the value
    in the case. `jobs`: number of simultaneous runs; 0: as many as the cores allow. `quantities`, `exact`, `reference`, `compare`,
    `order`: additional contents of the table, as the options of `ricochet study`. `resume` continues the study in the directory,
    also with more values; `force` starts anew.
    """
    directory = library_path(directory, "study")
    for name, value, least in (("jobs", jobs, 0), ("threads", threads, 1)):
        if not isinstance(value, (int, numpy.integer)) or not least <= value <= 1024:
            raise UsageError(f"study: {name} must be an integer from {least} to 1024, not {value!r}")
    if not isinstance(vary, Mapping):
        raise UsageError(f"study: vary must be a dictionary of keys and lists of values, not {vary!r}")
    case = source if isinstance(source, Case) and changes is None and mesh is None else Case(source, changes, mesh=mesh)
    axes = [axis_of(key, values) for key, values in vary.items()]
    if case.text is None:
        path = os.path.abspath(case.path)
    else:
        path = os.path.join(os.path.abspath(directory), "case.toml")
        # Without force or resume an existing study keeps its case; the library then refuses the new one.
        if resume or force or not (_core.holds_study(directory) or _core.holds_run(directory)):
            case.write(directory)
    questions = {"quantities": list(quantities), "exact": list((exact or {}).items()), "reference": reference, "compare": list(compare),
                 "order": order}
    parts = _core.conduct_study(directory, path, change_texts(case.changes), axes, questions, jobs, threads, resume, force, program())
    return Study(directory, parts)


def open_study(directory):
    """Returns the Study in a directory, as far as its runs have come."""
    directory = library_path(directory, "open_study")
    return Study(directory, _core.read_study(directory))
