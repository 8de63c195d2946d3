"""Exceptions. Their messages state the problem, its position (file:line:column, or the entry of a dictionary) and a remedy."""

import difflib
import re
from typing import List, NamedTuple

from . import places


class Place(NamedTuple):
    """Position in a file. Columns count from 1."""

    file: str
    line: int
    column: int


class Error(Exception):
    """Base class of all errors of Ricochet. `exit_status` is the exit status of the program for the same problem."""

    exit_status = 1

    def __init__(self, message):
        super().__init__(message)
        self.message = message

    @property
    def places(self) -> List[Place]:
        """Positions in files that the message names."""
        found = re.finditer(r"^(.*?\.[A-Za-z0-9]+):(\d+):(\d+): ", self.message, re.MULTILINE)
        return [Place(match.group(1), int(match.group(2)), int(match.group(3))) for match in found]


class UsageError(Error, ValueError):
    """Wrong use of a function: arguments or calls that do not fit together."""

    exit_status = 1


class InputError(Error, ValueError):
    """An invalid case, mesh or file of results."""

    exit_status = 2


class NotConvergedError(Error, ArithmeticError):
    """No solution of a step was found. The state is the one before the step."""

    exit_status = 3


class FileAccessError(Error, OSError):
    """A file cannot be read or written."""

    exit_status = 4

    def __str__(self):
        return self.message


class ExpectationError(Error):
    """A run is complete, but an [[expect]] entry of its case does not hold."""

    exit_status = 5


KINDS = {kind.exit_status: kind for kind in (UsageError, InputError, NotConvergedError, FileAccessError, ExpectationError)}


def from_core(status, message):
    """Returns the exception for an error of the library."""
    return KINDS.get(status, Error)(places.translate(message))


def unknown_name(what, name, known):
    """Returns the KeyError for an unknown column or field, which lists similar names, or all names if none is similar."""
    near = difflib.get_close_matches(str(name), known, 3) or known
    return KeyError(f'there is no {what} "{name}"; choose from {", ".join(near)}')
