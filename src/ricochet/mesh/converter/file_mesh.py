"""Content of a mesh file of another program: nodes, cells, groups. Shared by the readers and convert_mesh.py."""

import json
import os
import sys

try:
    import numpy
except ImportError:
    print("python3-meshio")
    sys.exit(3)


class Refusal(Exception):
    """A problem that the user can correct."""


class Missing(Exception):
    """A Debian package that is missing."""


def read_types():
    """Returns the types of cells as the C++ descriptions of the shapes give them (converter_files.hpp)."""
    if __package__:
        from .. import _core

        return json.loads(_core.cell_types())
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "cell_types.json"), encoding="utf-8") as file:
        return json.load(file)


class CellType:
    """A type of cells, with nodes in meshio's (VTK's) order. `order`: for each of Gmsh's nodes its number here; `facets`: kind
    and nodes of each facet, in the order in which Abaqus numbers the faces S1, S2, ...; `exodus_sides`: numbers in `facets`.
    """

    def __init__(self, gmsh, dimension, vertices, order, facets, exodus_sides, has_face_nodes):
        self.gmsh, self.dimension, self.vertices, self.order = gmsh, dimension, vertices, order
        self.facets = [(facet["kind"], facet["nodes"]) for facet in facets]
        self.exodus_sides, self.has_face_nodes = exodus_sides, has_face_nodes
        self.nodes = len(order)


DESCRIBED = read_types()
NAMES_OF_CELLS = DESCRIBED["names"]
TYPES = {name: CellType(**of) for name, of in DESCRIBED["types"].items()}


def dimension_of(kind):
    """Returns the dimension of a kind of cells; raises Refusal for an unknown kind."""
    if kind in TYPES:
        return TYPES[kind].dimension
    for prefix, dimension in (("vertex", 0), ("line", 1), ("triangle", 2), ("quad", 2), ("polygon", 2), ("tetra", 3),
                              ("hexahedron", 3), ("wedge", 3), ("pyramid", 3), ("polyhedron", 3)):
        if kind.lower().startswith(prefix) or kind.lower().startswith("vtk_lagrange_" + prefix):
            return dimension
    raise Refusal(f"cells of type {kind} are not supported")


def choices(names):
    """Returns "a, b or c"."""
    return " or ".join(filter(None, (", ".join(names[:-1]), *names[-1:])))


class Block:
    """Cells of one kind; `name` is the name of the kind in the file."""

    def __init__(self, kind, nodes, ids, name=None):
        self.kind, self.name = kind, name or kind
        nodes = numpy.asarray(nodes, dtype=numpy.int64)
        self.nodes = nodes.reshape(len(ids), -1 if nodes.size else nodes.shape[-1])
        self.ids = numpy.asarray(ids, dtype=numpy.int64)
        self.dimension = dimension_of(kind)


class FileMesh:
    """Mesh of a file. Groups are lists of (name, ...); nodes and cells are indices."""

    def __init__(self):
        self.points, self.node_ids, self.blocks = None, None, []
        self.cell_groups = []  # (name, {block: indices})
        self.side_groups = []  # (name, [(block, indices, facet)]), facet: number in CellType.facets
        self.node_groups = []  # (name, indices)
        self.notes = []
