"""Writes the mesh of a file as .msh (4.1, binary) for Ricochet: convert_mesh.py INPUT OUTPUT, or --version.

Exit status: 0; 2: refused, the last line says why; 3: a package is missing, the last line names it. Notes for the user
are written to the section $Notes of OUTPUT, behind $MeshFormat, one per line, so that a cached mesh repeats them.
"""

import re
import sys

from file_mesh import Missing, Refusal, numpy
from read_abaqus import InpReader
from read_by_meshio import read_by_meshio
from write_msh import write_msh


def version():
    from importlib import metadata
    try:
        return f"meshio {metadata.version('meshio')}, numpy {numpy.__version__}"
    except metadata.PackageNotFoundError:
        raise Missing("python3-meshio")


def main():
    try:
        if sys.argv[1:] == ["--version"]:
            print(version())
            return 0
        path, output = sys.argv[1:]
        is_inp = path.lower().endswith(".inp")
        write_msh(InpReader(path).read() if is_inp else read_by_meshio(path), output)
        return 0
    except Refusal as problem:
        message = " ".join(str(problem).split("\n"))
        print(message if re.match(r"\S.*?:\d+: ", message) or message.startswith(sys.argv[1]) else
              f"{sys.argv[1]}: {message}")
        return 2
    except Missing as problem:
        print(problem)
        return 3


if __name__ == "__main__":
    sys.exit(main())
