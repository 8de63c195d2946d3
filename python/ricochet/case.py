"""Cases: read from a file or made from dictionaries, with the same checks and messages."""

import contextlib
import json
import math
import os
from collections.abc import Mapping

import numpy

from . import _core, places
from .errors import FileAccessError, InputError, UsageError
from .files import file_access, library_path, path_of, write_whole
from .mesh import Mesh

FIRST_LINE = "# A case of a program in Python."

# Keys that name files. Paths in a dictionary are relative to Python's working directory.
FILE_KEYS = ("file", "table")


def toml_value(value, path):
    """Returns a value in the notation of TOML."""
    if isinstance(value, (bool, numpy.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, numpy.integer)):
        if not -2**63 <= value < 2**63:
            raise InputError(f"{places.entry(path)}: integers in a case are limited to 64 bits; this one is larger")
        return str(int(value))
    if isinstance(value, (float, numpy.floating)):
        number = float(value)
        return repr(number) if math.isfinite(number) else {math.inf: "inf", -math.inf: "-inf"}.get(number, "nan")
    if isinstance(value, (str, os.PathLike)):
        return toml_text(os.fspath(value))
    if isinstance(value, numpy.ndarray):
        value = value.tolist()
        if not isinstance(value, list):
            return toml_value(value, path)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(entry, path) for entry in value) + "]"
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{toml_key(key)} = {toml_value(entry, path)}" for key, entry in value.items()) + " }"
    raise InputError(f"{places.entry(path)}: a value of type {type(value).__name__} is not allowed in a case; use numbers, "
                     "strings, booleans, lists, arrays or dictionaries")


def toml_text(text):
    escapes = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}
    return '"' + "".join(escapes.get(c, c if c.isprintable() else f"\\U{ord(c):08x}") for c in text) + '"'


def toml_key(key):
    if not isinstance(key, str):
        raise InputError(f"the key {key!r} of a case is not a string")
    return key if key and all(c.isascii() and (c.isalnum() or c in "-_") for c in key) else toml_text(key)


def is_list_of_tables(value):
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(entry, Mapping) for entry in value)


class Writer:
    """Writes nested dictionaries as TOML, one line per entry, and records the entry of each line."""

    def __init__(self):
        self.lines, self.entries = [], []

    def line(self, text, path):
        self.lines.append(text)
        self.entries.append(path)

    def table(self, name, table, path):
        simple = {key: value for key, value in table.items() if not isinstance(value, Mapping) and not is_list_of_tables(value)}
        for key, value in simple.items():
            self.line(f"{toml_key(key)} = {toml_value(value, path + (key,))}", path + (key,))
        for key, value in table.items():
            below = name + (toml_key(key),)
            if isinstance(value, Mapping):
                self.line(f"[{'.'.join(below)}]", path + (key,))
                self.table(below, value, path + (key,))
            elif is_list_of_tables(value):
                for number, entry in enumerate(value):
                    self.line(f"[[{'.'.join(below)}]]", path + (key, number))
                    self.table(below, entry, path + (key, number))


def with_whole_paths(table, folder):
    """Returns a copy of a table whose file paths are absolute."""
    result = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            value = with_whole_paths(value, folder)
        elif is_list_of_tables(value):
            value = [with_whole_paths(entry, folder) for entry in value]
        elif key in FILE_KEYS and isinstance(value, (str, os.PathLike)):
            value = os.path.join(folder, os.fspath(value))
        result[key] = value
    return result


def change_texts(changes):
    """Returns changes of a case ({"time.step": 1e-4}, or strings in the form of --set) as strings in the form of --set."""
    if changes is None:
        return []
    if isinstance(changes, str):
        raise UsageError(f'changes must be a dictionary, {{"time.step": 1e-4}}, or a list of strings, not the string {changes!r}')
    if not isinstance(changes, Mapping):
        return [str(change) for change in changes]
    return [f"{key}={toml_value(value, (key,))}" for key, value in changes.items()]


class Case:
    """Definition of a simulation.

    `source` is the path of a case file or a dictionary of its sections. `mesh` is the body, instead of a mesh file.
    `changes` are values by key path, as for --set: {"time.step": 1e-4, "contact.0.friction": 0.2}. The case is checked as a
    whole; InputError lists every problem found.
    """

    def __init__(self, source, changes=None, *, mesh=None):
        if isinstance(source, Case):
            if mesh is None:
                mesh = source.mesh
            changes = source.changes + change_texts(changes)
            source = source.path if source.dictionary is None else source.dictionary
        self.changes = change_texts(changes)
        self.mesh, self.dictionary, self.text, self._lines = mesh, None, None, None
        if isinstance(source, Mapping):
            try:
                self._read_dictionary(source)
            except RecursionError:
                raise InputError("case: a dictionary or list contains itself or is nested too deeply") from None
        elif isinstance(source, (str, os.PathLike)):
            if mesh is not None:
                raise UsageError("a case file names its own mesh; use `mesh` with a dictionary, or change mesh.file")
            self._core, self.warnings = _core.read_case(library_path(source, "case"), self.changes)
        else:
            raise UsageError(f"a case must be a path or a dictionary, not a {type(source).__name__}")

    def _read_dictionary(self, source):
        table = with_whole_paths(source, os.getcwd())
        if self.mesh is not None:
            if not isinstance(self.mesh, Mesh):
                raise UsageError("mesh: a ricochet.Mesh is required; make one with Mesh.from_meshio or Mesh.from_gmsh")
            section = dict(table.get("mesh", {}))
            if "file" in section:
                raise UsageError('case["mesh"]["file"]: the argument `mesh` already defines the mesh; remove one of the two')
            table["mesh"] = {"file": self.mesh.path, **section}
        self.dictionary = source
        self._table = table
        writer = Writer()
        writer.line(FIRST_LINE, ())  # the line of messages about the whole case
        writer.table((), table, ())
        self._lines = places.Lines(writer.entries)
        self.text = "\n".join(writer.lines) + "\n"
        self._core, self.warnings = _core.read_case_text(self.text, self._lines.name, self.changes)

    @property
    def path(self):
        """Path of the case file; for a dictionary, its name in messages."""
        return self._core.path

    @property
    def title(self):
        return self._core.title

    @property
    def values(self):
        """All values in effect, including defaults and changes, as strings by key path."""
        return self._core.values

    def write(self, folder, name="case.toml"):
        """Writes the case, and a mesh made from arrays, to a folder. Returns the path of the case file."""
        if self.text is None:
            raise UsageError(f"{self.path} is already a file; only cases from dictionaries can be written")
        with file_access():
            os.makedirs(folder, exist_ok=True)
        path = os.path.join(path_of(folder, "write"), name)
        text = self.text
        if self.mesh is not None:
            own = os.path.splitext(name)[0] + ".msh"
            self.mesh.write(os.path.join(folder, own))
            text = text.replace(f"file = {toml_text(self.mesh.path)}", f"file = {toml_text(own)}", 1)
        write_whole(path, text.encode())
        return path

    def refuse_to_replace(self, folder):
        """Raises FileAccessError if write() would replace a file that no earlier run has written."""
        own = os.path.join(folder, "case.toml")
        with file_access():
            if os.path.isfile(own):
                with open(own, encoding="utf-8", errors="replace") as file:
                    if file.readline().rstrip() == FIRST_LINE:
                        return
        # An earlier program may have been stopped before it wrote its case.
        with contextlib.suppress(OSError, ValueError, AttributeError):
            with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
                if json.load(file).get("case_path") == os.path.abspath(own):
                    return
        for name in ("case.toml",) if self.mesh is None else ("case.toml", "case.msh"):
            if os.path.isfile(os.path.join(folder, name)):
                raise FileAccessError(f"{os.path.join(folder, name)}: no earlier run has written this file, and the case of this run "
                                      "would replace it; choose another directory, or rename the file")

    def check(self):
        """Reads the mesh and builds the problem, as a run would. Returns the warnings."""
        from .session import Session

        session = Session(self)
        session.build()
        return list(session.warnings)

    def __repr__(self):
        return f"<Case {self.title or self.path!r}>"
