"""Files that the package reads and writes in Python."""

import os
from contextlib import contextmanager

from .errors import Error, FileAccessError, UsageError


def _error_of(problem, path):
    name = problem.filename or path
    result = FileAccessError(f"{os.fsdecode(name)}: {problem.strerror}" if name and problem.strerror else str(problem))
    result.errno, result.filename = problem.errno, name
    return result


@contextmanager
def file_access(path=None):
    """Context in which an OSError, for a file that cannot be read or written, becomes a FileAccessError."""
    try:
        yield
    except OSError as problem:
        if isinstance(problem, Error):
            raise
        raise _error_of(problem, path) from problem


def path_of(path, what):
    """Returns a path as a string. Raises UsageError if it is not a path."""
    try:
        text = os.fsdecode(path)
    except TypeError:
        raise UsageError(f"{what}: a path is required, not {path!r}") from None
    if not text or "\0" in text:
        raise UsageError(f"{what}: {text!r} is not a path")
    return text


def library_path(path, what):
    """Returns a path for the library, whose messages are UTF-8. Raises UsageError if the path is not UTF-8."""
    text = path_of(path, what)
    try:
        text.encode()
    except UnicodeEncodeError:
        raise UsageError(f"{what}: the name {text!r} is not UTF-8; choose another name") from None
    return text


def write_whole(path, content):
    """Writes bytes to a file, which on failure stays as it was. A device or a pipe is written to, not replaced."""
    with file_access(path):
        path = os.path.realpath(path)
        if os.path.exists(path) and not os.path.isfile(path):
            with open(path, "wb") as file:
                file.write(content)
            return
        part = path + ".part"
        try:
            with open(part, "wb") as file:
                file.write(content)
            os.replace(part, path)
        except OSError:
            if os.path.isfile(part):
                os.remove(part)
            raise
