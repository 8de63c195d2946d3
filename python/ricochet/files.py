"""Files that Python writes and reads itself."""

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
    """Within it, what Python says of files that cannot be read or written is a FileAccessError."""
    try:
        yield
    except OSError as problem:
        if isinstance(problem, Error):
            raise
        raise _error_of(problem, path) from problem


def path_of(path, what):
    """A path as text. Raises UsageError where it is none."""
    try:
        text = os.fsdecode(path)
    except TypeError:
        raise UsageError(f"{what}: a path is needed, not {path!r}") from None
    if not text or "\0" in text:
        raise UsageError(f"{what}: {text!r} is no path")
    return text


def library_path(path, what):
    """One that the library is given, whose messages are UTF-8."""
    text = path_of(path, what)
    try:
        text.encode()
    except UnicodeEncodeError:
        raise UsageError(f"{what}: the name {text!r} is not UTF-8; choose another one") from None
    return text


def write_whole(path, content):
    """Writes bytes: the file is there whole or as it was. A device, or a pipe, is written to; it is not replaced."""
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
