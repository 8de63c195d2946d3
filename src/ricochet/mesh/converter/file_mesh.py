"""Content of a mesh file of another program: nodes, cells, groups. Shared by the readers and convert_mesh.py."""

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


# Cell types in meshio's (VTK's) order of nodes: Gmsh's type, dimension, the vertices at whose mean each node lies,
# Gmsh's order of nodes, and the facets by vertices, in the order in which Abaqus numbers the faces S1, S2, ...
TRIANGLE_EDGES = [(0, 1), (1, 2), (2, 0)]
QUAD_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]
TETRA_EDGES = TRIANGLE_EDGES + [(0, 3), (1, 3), (2, 3)]
HEXAHEDRON_EDGES = QUAD_EDGES + [(4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
HEXAHEDRON_FACES = [(0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (3, 2, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7)]
TETRA_FACETS = [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]
HEXAHEDRON_FACETS = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]


class CellType:
    def __init__(self, gmsh, dimension, vertices, higher=(), order=None, facets=()):
        self.gmsh, self.dimension, self.vertices, self.facets = gmsh, dimension, vertices, facets
        self.places = [(v,) for v in range(vertices)] + [tuple(sorted(place)) for place in higher]
        self.order = list(range(len(self.places))) if order is None else order

    def facet_nodes(self, number):
        """Returns the cell's nodes on a facet, in meshio's order of the facet's own nodes."""
        facet = self.facets[number]
        own = {2: TYPES["line3"], 3: TYPES["triangle6"], 4: TYPES["quad9"]}[len(facet)]
        places = own.places if len(self.places) > self.vertices else own.places[:own.vertices]
        return [self.places.index(tuple(sorted(facet[v] for v in place))) for place in places]


TYPES = {
    "line": CellType(1, 1, 2),
    "line3": CellType(8, 1, 2, [(0, 1)]),
    "triangle": CellType(2, 2, 3, facets=TRIANGLE_EDGES),
    "triangle6": CellType(9, 2, 3, TRIANGLE_EDGES, facets=TRIANGLE_EDGES),
    "quad": CellType(3, 2, 4, facets=QUAD_EDGES),
    "quad9": CellType(10, 2, 4, QUAD_EDGES + [(0, 1, 2, 3)], facets=QUAD_EDGES),
    "tetra": CellType(4, 3, 4, facets=TETRA_FACETS),
    "tetra10": CellType(11, 3, 4, TETRA_EDGES, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8], TETRA_FACETS),
    "hexahedron": CellType(5, 3, 8, facets=HEXAHEDRON_FACETS),
    "hexahedron27": CellType(12, 3, 8, HEXAHEDRON_EDGES + HEXAHEDRON_FACES + [tuple(range(8))],
                             [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14, 24, 22, 20, 21, 23,
                              25, 26], HEXAHEDRON_FACETS),
}
FACET_TYPES = {(2, False): "line", (2, True): "line3", (3, False): "triangle", (3, True): "triangle6",
               (4, False): "quad", (4, True): "quad9"}
# Dimension of types that are known but not supported.
OTHERS = {"quad8": 2, "hexahedron20": 3, "hexahedron24": 3, "wedge": 3, "wedge12": 3, "wedge15": 3, "wedge18": 3,
          "pyramid": 3, "pyramid13": 3, "pyramid14": 3, "polygon": 2, "polyhedron": 3}


def dimension_of(kind):
    """Returns the dimension of a kind of cells; raises Refusal for an unknown kind."""
    if kind in TYPES:
        return TYPES[kind].dimension
    if kind in OTHERS:
        return OTHERS[kind]
    for prefix, dimension in (("vertex", 0), ("line", 1), ("triangle", 2), ("quad", 2), ("polygon", 2), ("tetra", 3),
                              ("hexahedron", 3), ("wedge", 3), ("pyramid", 3), ("polyhedron", 3)):
        if kind.lower().startswith(prefix) or kind.lower().startswith("vtk_lagrange_" + prefix):
            return dimension
    raise Refusal(f"cells of type {kind} are not supported")


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
