"""Small structured or distorted meshes of triangles, quadrilaterals, tetrahedra and hexahedra, and their Gmsh files."""

import dataclasses
import itertools

from quantities import LENGTH

TYPES = {"line": 1, "triangle": 2, "quadrilateral": 3, "tetrahedron": 4, "hexahedron": 5}
FACETS = {2: "line", 3: "triangle", 4: "quadrilateral"}  # by number of nodes
# An order of nodes that turns a cell inside out, as a reflection does, and one that rotates the cell.
MIRRORED = {"triangle": (0, 2, 1), "quadrilateral": (0, 3, 2, 1), "tetrahedron": (0, 2, 1, 3),
            "hexahedron": (0, 3, 2, 1, 4, 7, 6, 5)}
ROTATED = {"triangle": (1, 2, 0), "quadrilateral": (1, 2, 3, 0), "tetrahedron": (1, 2, 0, 3),
           "hexahedron": (1, 2, 3, 0, 5, 6, 7, 4)}
SIDES = ("left", "right", "front", "back", "bottom", "top")


@dataclasses.dataclass
class Mesh:
    name: str
    kind: str
    points: list
    cells: list
    facets: list  # of (side, nodes)
    version: str = "4.1"

    @property
    def dimension(self):
        return len(self.points[0])

    def seen(self, frame):
        points = [frame.apply(p, "point", LENGTH) for p in self.points]
        order = MIRRORED[self.kind] if frame.handedness() < 0 else range(len(self.cells[0]))
        return dataclasses.replace(self, points=points, cells=[tuple(cell[k] for k in order) for cell in self.cells])

    def renumbered(self, random):
        """Returns the same mesh with other numbers of nodes, cells and facets, and other first nodes of cells."""
        order = list(range(len(self.points)))
        random.shuffle(order)
        place = {node: k for k, node in enumerate(order)}
        turns = lambda cell: tuple(cell[k] for k in ROTATED[self.kind]) if random.random() < 0.5 else cell
        cells = [turns(tuple(place[n] for n in cell)) for cell in self.cells]
        facets = [(side, tuple(place[n] for n in nodes)) for side, nodes in self.facets]
        random.shuffle(cells)
        random.shuffle(facets)
        return dataclasses.replace(self, points=[self.points[n] for n in order], cells=cells, facets=facets)

    def perturbed(self, random, size, on_axis):
        """Returns the mesh with each node moved by about that much, except for coordinates that are zero on an axis."""
        moved = [tuple(x if k == 0 and on_axis and x == 0 else x + size * random.uniform(-1, 1) for k, x in enumerate(p))
                 for p in self.points]
        return dataclasses.replace(self, points=moved)

    def text(self):
        return text_22([self]) if self.version == "2.2" else text_41([self])


def box(name, random, counts, low, high, kind, distortion=0.0, form=None):
    """Returns a box of counts cells, possibly distorted inside, mapped by `form`."""
    d = len(counts)
    strides = [1]
    for count in counts[:-1]:
        strides.append(strides[-1] * (count + 1))
    points = []
    for place in itertools.product(*(range(c + 1) for c in reversed(counts))):
        place = place[::-1]
        inside = all(0 < i < c for i, c in zip(place, counts))
        moved = [i + (distortion * random.uniform(-1, 1) if inside else 0.0) for i in place]
        unit = [2 * i / c - 1 for i, c in zip(moved, counts)]
        unit = form(unit) if form else unit
        points.append(tuple(a + (b - a) * (u + 1) / 2 for a, b, u in zip(low, high, unit)))
    node = lambda place: sum(i * s for i, s in zip(place, strides))
    cells, facets = [], []
    for place in itertools.product(*(range(c) for c in counts)):
        cells += cut([node([i + o for i, o in zip(place, offset)]) for offset in itertools.product((0, 1), repeat=d)], kind)
        for axis in range(d):
            for end in (0, 1):
                if place[axis] == (counts[axis] - 1 if end else 0):
                    corners = [node([i + o for i, o in zip(place, offset)])
                               for offset in itertools.product((0, 1), repeat=d) if offset[axis] == end]
                    side = SIDES[(2 * axis if axis < d - 1 else 4) + end]
                    facets += [(side, f) for f in cut_facet(corners, kind)]
    return Mesh(name, kind, points, cells, facets)


def cut(corners, kind):
    """Returns the cells of a box, given by its corners in the order of itertools.product((0, 1), repeat=d), with
    positive volume."""
    if kind == "quadrilateral":
        return [tuple(corners[k] for k in (0, 2, 3, 1))]
    if kind == "triangle":
        return [(corners[0], corners[2], corners[3]), (corners[0], corners[3], corners[1])]
    if kind == "hexahedron":
        return [tuple(corners[k] for k in (0, 4, 6, 2, 1, 5, 7, 3))]
    cells = []
    for axes in itertools.permutations((4, 2, 1)):  # Kuhn's six: paths from corner 0 to corner 7 along the axes
        way = (0, axes[0], axes[0] + axes[1], 7)
        odd = axes in ((4, 1, 2), (2, 4, 1), (1, 2, 4))
        way = (way[0], way[2], way[1], way[3]) if odd else way
        cells.append(tuple(corners[k] for k in way))
    return cells


def cut_facet(corners, kind):
    """Returns the facets of cells on the side of a box, with the diagonals of Kuhn's tetrahedra."""
    if kind in ("triangle", "quadrilateral"):
        return [tuple(corners)]
    if kind == "hexahedron":
        return [(corners[0], corners[2], corners[3], corners[1])]
    return [(corners[0], corners[2], corners[3]), (corners[0], corners[3], corners[1])]


def rounded(share):
    """Returns the map of a cube that moves it a fraction of the way to a ball."""
    def form(u):
        squares = [x * x for x in u]
        result = []
        for k, x in enumerate(u):
            others = [s for m, s in enumerate(squares) if m != k]
            inside = 1 - sum(others) / 2 + (others[0] * others[1] / 3 if len(others) == 2 else 0)
            result.append((1 - share) * x + share * x * max(inside, 0.0)**0.5)
        return result
    return form


def gathered(meshes):
    """Returns points, cells and facets of several meshes without shared nodes, with the groups of their parts in a
    case."""
    points, cells, facets, shift = [], [], [], 0
    for mesh in meshes:
        points += mesh.points
        cells += [(f"{mesh.name}.body", mesh.kind, tuple(n + shift for n in c)) for c in mesh.cells]
        facets += [(f"{mesh.name}.{side}", FACETS[len(nodes)], tuple(n + shift for n in nodes)) for side, nodes in mesh.facets]
        shift += len(mesh.points)
    return points, cells, facets


def groups_of(meshes):
    """Returns all nodes, and physical groups by name: (dimension, number, [(type of the element, nodes)]), facets
    first."""
    d = meshes[0].dimension
    if len(meshes) == 1:
        mesh = meshes[0]
        points, cells = mesh.points, [("body", mesh.kind, c) for c in mesh.cells]
        facets = [(side, FACETS[len(nodes)], nodes) for side, nodes in mesh.facets]
    else:
        points, cells, facets = gathered(meshes)
    groups = {}
    for dimension, elements in ((d - 1, facets), (d, cells)):
        for name, kind, nodes in elements:
            group = groups.setdefault(name, (dimension, len(groups) + 1, []))
            group[2].append((TYPES[kind], nodes))
    return points, groups


def coordinates(p):
    return " ".join(f"{x:.17g}" for x in (*p, 0.0)[:3])


def names_text(groups):
    return [f"$PhysicalNames\n{len(groups)}"] + [f'{d} {n} "{name}"' for name, (d, n, _) in groups.items()] + ["$EndPhysicalNames"]


def text_22(meshes):
    points, groups = groups_of(meshes)
    lines = ["$MeshFormat\n2.2 0 8\n$EndMeshFormat", *names_text(groups), f"$Nodes\n{len(points)}"]
    lines += [f"{k} {coordinates(p)}" for k, p in enumerate(points, 1)]
    elements = [(kind, n, nodes) for _, n, members in groups.values() for kind, nodes in members]
    lines += [f"$EndNodes\n$Elements\n{len(elements)}"]
    lines += [f"{k} {kind} 2 {n} {n} " + " ".join(str(node + 1) for node in nodes) for k, (kind, n, nodes) in enumerate(elements, 1)]
    return "\n".join([*lines, "$EndElements", ""])


def text_41(meshes):
    points, groups = groups_of(meshes)
    d = meshes[0].dimension
    lines = ["$MeshFormat\n4.1 0 8\n$EndMeshFormat", *names_text(groups), "$Entities"]
    count = [sum(1 for dimension, _, _ in groups.values() if dimension == k) for k in range(4)]
    lines.append(" ".join(map(str, count)))
    lines += [f"{n} 0 0 0 0 0 0 1 {n} 0" for _, n, _ in groups.values()]
    lines += [f"$EndEntities\n$Nodes\n1 {len(points)} 1 {len(points)}\n{d} {len(groups)} 0 {len(points)}"]
    lines += [str(k) for k in range(1, len(points) + 1)] + [coordinates(p) for p in points]
    blocks = [(dimension, n, kind, [nodes for k, nodes in members if k == kind])
              for dimension, n, members in groups.values() for kind in sorted({k for k, _ in members})]
    total = sum(len(nodes) for _, _, _, nodes in blocks)
    lines.append(f"$EndNodes\n$Elements\n{len(blocks)} {total} 1 {total}")
    number = 0
    for dimension, n, kind, members in blocks:
        lines.append(f"{dimension} {n} {kind} {len(members)}")
        for nodes in members:
            number += 1
            lines.append(f"{number} " + " ".join(str(node + 1) for node in nodes))
    return "\n".join([*lines, "$EndElements", ""])
