"""Writes a mesh as .msh (4.1, binary), with notes for the user in the section $Notes.

Used by the converter and by the Python package.
"""

if __package__:
    from .file_mesh import NAMES_OF_CELLS, TYPES, Refusal, numpy
else:
    from file_mesh import NAMES_OF_CELLS, TYPES, Refusal, choices, numpy


def unique_rows(rows):
    """Returns the first index of each distinct row, and for each row the number of its distinct row.

    numpy.unique is several times slower.
    """
    order = numpy.lexsort(rows.T)
    is_first = numpy.ones(len(rows), dtype=bool)
    is_first[1:] = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    inverse = numpy.empty(len(rows), dtype=numpy.int64)
    inverse[order] = numpy.cumsum(is_first) - 1
    return order[is_first], inverse


class Facets:
    """Facets of one kind that belong to groups."""

    def __init__(self):
        self.nodes, self.ids, self.names = [], [], []

    def add(self, name, nodes, ids):
        self.nodes.append(nodes)
        self.ids.append(ids)
        self.names.append(name)


def boundary_facets(mesh, dimension):
    """Returns, by kind, the nodes of the facets that belong to one cell only."""
    found = {}
    for block in mesh.blocks:
        if block.dimension != dimension:
            continue
        for kind, local in TYPES[block.kind].facets:
            found.setdefault(kind, []).append(block.nodes[:, local])
    result = {}
    for kind, parts in found.items():
        nodes = numpy.concatenate(parts)
        first, inverse = unique_rows(numpy.sort(nodes[:, :TYPES[kind].vertices], axis=1))
        result[kind] = nodes[first[numpy.bincount(inverse) == 1]]
    return result


def collect_facets(mesh, dimension):
    facets = {}
    none = numpy.zeros(0, dtype=numpy.int64)

    def add(name, kind, nodes, ids=none):
        ids = ids if len(ids) else numpy.zeros(len(nodes), dtype=numpy.int64)
        if len(nodes):
            facets.setdefault(kind, Facets()).add(name, nodes, ids)

    names = set()
    for name, parts in mesh.cell_groups:
        for number, indices in parts.items():
            block = mesh.blocks[number]
            if block.dimension == dimension - 1 and len(indices):
                add(name, block.kind, block.nodes[indices], block.ids[indices])
                names.add(name)
    boundary = boundary_facets(mesh, dimension) if mesh.side_groups or mesh.node_groups else {}
    for name, parts in mesh.side_groups:
        names.add(name)
        for number, indices, facet in parts:
            block = mesh.blocks[number]
            all_facets = TYPES[block.kind].facets
            for own, local in all_facets if facet is None else [all_facets[facet]]:
                nodes = block.nodes[indices][:, local]
                if facet is None:  # the free surface of these cells
                    corners = TYPES[own].vertices
                    both = numpy.concatenate([boundary[own], nodes])[:, :corners]
                    _, inverse = unique_rows(numpy.sort(both, axis=1))
                    nodes = nodes[numpy.isin(inverse[len(boundary[own]):], inverse[:len(boundary[own])])]
                add(name, own, nodes)
    without = []
    for name, indices in mesh.node_groups:
        if name in names:
            continue  # a surface or a set of surface elements of that name takes precedence
        marked = numpy.zeros(len(mesh.points), dtype=bool)
        marked[indices] = True
        found = False
        for kind, nodes in boundary.items():
            whole = nodes[marked[nodes].all(axis=1)]
            found = found or len(whole) > 0
            add(name, kind, whole)
        if not found:
            without.append(name)
    if without:
        mesh.notes.append("note: no groups are made from sets of nodes that contain no whole boundary facet: "
                          + ", ".join(f'"{name}"' for name in without))
    return facets


def combine(count, groups):
    """Returns for each of `count` items the number of its combination of groups, and the groups of each combination.

    Combination 0 has no group.
    """
    numbers, combinations = numpy.zeros(count, dtype=numpy.int64), [()]
    for group, members in groups:
        mask = numpy.zeros(count, dtype=bool)
        mask[members] = True
        keys, inverse = numpy.unique(numbers * 2 + mask, return_inverse=True)
        combinations = [combinations[key // 2] + ((group,) if key % 2 else ()) for key in keys]
        numbers = inverse.reshape(-1)
        if combinations[0] != ():  # all items have groups: keep combination 0 empty
            combinations, numbers = [()] + combinations, numbers + 1
    return numbers, combinations


class MshWriter:
    """Writer of format 4.1. Each combination of groups becomes an entity."""

    def __init__(self, mesh):
        self.mesh, self.names, self.entities, self.elements = mesh, {}, [[], [], [], []], []

    def tag(self, dimension, name):
        return self.names.setdefault((dimension, name), sum(key[0] == dimension for key in self.names) + 1)

    def add(self, dimension, blocks, groups):
        """Adds elements; blocks: (kind, nodes, ids); groups: (name, numbers through all blocks)."""
        merged = {}
        for name, members in groups:
            merged.setdefault(self.tag(dimension, name), []).append(members)
        total = sum(len(ids) for _, _, ids in blocks)
        numbers, combinations = combine(total, [(tag, numpy.concatenate(parts)) for tag, parts in merged.items()])
        self.entities[dimension] = combinations
        first = 0
        for kind, nodes, ids in blocks:
            own = numbers[first:first + len(ids)]
            for entity in numpy.unique(own):
                here = own == entity
                rows = numpy.column_stack([ids[here], self.mesh.node_ids[nodes[here][:, TYPES[kind].order]]])
                self.elements.append((dimension, int(entity), TYPES[kind].gmsh, rows))
            first += len(ids)

    def write(self, path):
        mesh = self.mesh
        integers = lambda *values: numpy.array(values, dtype="<i4").tobytes()
        sizes = lambda *values: numpy.array(values, dtype="<u8").tobytes()
        with open(path, "wb") as file:
            text = lambda line: file.write((line + "\n").encode("utf-8", "surrogateescape"))
            text("$MeshFormat\n4.1 1 8")
            file.write(integers(1))
            text("\n$EndMeshFormat\n$Notes")
            for note in mesh.notes:
                text(note.replace("\n", " "))
            text("$EndNotes")
            if self.names:
                text(f"$PhysicalNames\n{len(self.names)}")
                for (dimension, name), tag in self.names.items():
                    text(f'{dimension} {tag} "{name}"')
                text("$EndPhysicalNames")
            text("$Entities")
            file.write(sizes(*[len(entities) for entities in self.entities]))
            for dimension, entities in enumerate(self.entities):
                for number, groups in enumerate(entities):
                    box = numpy.zeros(3 if dimension == 0 else 6).tobytes()
                    file.write(integers(number) + box + sizes(len(groups)) + integers(*groups) + sizes(0))
            text("\n$EndEntities\n$Nodes")
            count = len(mesh.node_ids)
            file.write(sizes(1, count, mesh.node_ids.min(), mesh.node_ids.max()) + integers(0, 0, 0) + sizes(count))
            file.write(mesh.node_ids.astype("<u8").tobytes())
            file.write(numpy.ascontiguousarray(mesh.points, dtype="<f8").tobytes())
            text("\n$EndNodes\n$Elements")
            total = sum(len(rows) for _, _, _, rows in self.elements)
            file.write(sizes(len(self.elements), total, 1, max(total, 1)))
            for dimension, entity, kind, rows in self.elements:
                file.write(integers(dimension, entity, kind) + sizes(len(rows)) + rows.astype("<u8").tobytes())
            text("\n$EndElements")


def refuse_kinds(mesh, dimension):
    counts = {}
    for block in mesh.blocks:
        if block.kind not in TYPES and block.dimension == dimension:
            counts[block.name] = counts.get(block.name, 0) + len(block.ids)
    if not counts:
        return
    listed = ", ".join(f"{count} of type {name}" for name, count in counts.items())
    kinds = {block.kind for block in mesh.blocks if block.name in counts}
    advice = (f"cells must be {NAMES_OF_CELLS}; mesh the part with these, for example with tetrahedra (C3D4 or C3D10 in "
              "Abaqus)")
    complete = [name for name, kind in TYPES.items() if kind.has_face_nodes]
    if {kind.rstrip("0123456789") for kind in kinds} <= {name.rstrip("0123456789") for name in complete}:
        advice = (f"second-order cells with quadrilateral faces need nodes on these and inside, too ({choices(complete)}); "
                  "write the mesh with cells of the first order (C3D8, CPS4, CPE4 in Abaqus), or with second-order "
                  "triangles and tetrahedra (C3D10, CPS6, CPE6)")
    raise Refusal(f"unsupported cells: {listed}; {advice}")


def write_msh(mesh, path):
    dimension = max([block.dimension for block in mesh.blocks if len(block.ids)], default=0)
    if dimension < 2:
        raise Refusal("the file has no cells of dimension 2 or 3")
    if len(mesh.points) == 0:
        raise Refusal("the file has no nodes")
    refuse_kinds(mesh, dimension)
    facets = collect_facets(mesh, dimension)
    writer = MshWriter(mesh)
    firsts, cells, total = {}, [], 0
    for number, block in enumerate(mesh.blocks):
        if block.dimension == dimension and len(block.ids):
            firsts[number] = total
            cells.append((block.kind, block.nodes, block.ids))
            total += len(block.ids)
    groups = [(name, firsts[number] + numpy.asarray(indices, dtype=numpy.int64))
              for name, parts in mesh.cell_groups for number, indices in parts.items()
              if number in firsts and len(indices)]
    writer.add(dimension, cells, groups)
    next_id = max(int(block.ids.max()) for block in mesh.blocks if len(block.ids)) + 1
    blocks, groups, total = [], [], 0
    for kind, found in facets.items():
        nodes, ids = numpy.concatenate(found.nodes), numpy.concatenate(found.ids)
        if kind not in TYPES:
            raise Refusal(f"facets of type {kind} in groups are not supported")
        first, inverse = unique_rows(numpy.sort(nodes[:, :TYPES[kind].vertices], axis=1))
        ids = ids[first]
        new = ids == 0
        ids[new] = numpy.arange(next_id, next_id + new.sum())
        next_id += int(new.sum())
        blocks.append((kind, nodes[first], ids))
        at = 0
        for name, part in zip(found.names, found.nodes):
            groups.append((name, total + numpy.unique(inverse[at:at + len(part)])))
            at += len(part)
        total += len(first)
    if blocks:
        writer.add(dimension - 1, blocks, groups)
    writer.write(path)
