"""The program `ricochet`, with which studies make their runs, and its shared files."""

import os
import shutil
import sys

from .errors import FileAccessError

HERE = os.path.dirname(os.path.abspath(__file__))


def program():
    """Returns the path of the program: in the package, in the build tree, or installed."""
    candidates = [os.path.join(HERE, "bin", "ricochet"), os.path.join(HERE, "..", "..", "ricochet"), shutil.which("ricochet"),
                  os.path.join(os.path.dirname(sys.executable), "ricochet")]
    for candidate in candidates:
        if candidate and os.path.isfile(candidate) and os.access(candidate, os.X_OK):
            return os.path.realpath(candidate)
    raise FileAccessError("the program ricochet is not found; install it (Debian's package ricochet)")


def shared_file(name):
    """Returns the path of a file in share/ricochet of the program."""
    folder = os.path.dirname(program())
    for place in (os.path.join(folder, "share"), os.path.join(os.path.dirname(folder), "share")):
        path = os.path.join(place, "ricochet", name)
        if os.path.exists(path):
            return path
    raise FileAccessError(f"share/ricochet/{name} is missing beside the program {program()}; install Ricochet again")
