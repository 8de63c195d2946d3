"""Reads files through meshio, and the groups that it loses: families of MED, blocks and side sets of Exodus."""

import os

import numpy

from file_mesh import TYPES, Block, FileMesh, Missing, Refusal

MOST_VALUES = 256


def text_of(characters):
    return b"".join(characters).split(b"\0")[0].decode("utf-8", "replace").strip()


def add_families(mesh, source):
    """Adds the groups of MED: a family is a combination of groups, and a number assigned to cells or nodes."""
    tags = source.cell_data.get("cell_tags")
    for family, names in (getattr(source, "cell_tags", {}) or {}).items() if tags is not None else ():
        parts = {number: numpy.nonzero(numpy.asarray(values) == family)[0] for number, values in enumerate(tags)}
        for name in names:
            mesh.cell_groups.append((name.strip("\0 "), parts))
    tags = source.point_data.get("point_tags")
    groups = {}
    for family, names in (getattr(source, "point_tags", {}) or {}).items() if tags is not None else ():
        for name in names:
            groups.setdefault(name.strip("\0 "), []).append(numpy.nonzero(numpy.asarray(tags) == family)[0])
    mesh.node_groups += [(name, numpy.concatenate(parts)) for name, parts in groups.items()]


def add_exodus_sets(mesh, path):
    import netCDF4

    def names_of(file, key, ids_key, what):
        ids = file.variables[ids_key][:].tolist() if ids_key in file.variables else []
        names = [""] * len(ids)
        if key in file.variables:
            file.variables[key].set_auto_mask(False)
            names = [text_of(row) for row in file.variables[key][:]]
        return [name or f"{what} {number}" for name, number in zip(names, ids)]

    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)
        for number, name in enumerate(names_of(file, "eb_names", "eb_prop1", "block")):
            if number < len(mesh.blocks):
                mesh.cell_groups.append((name, {number: numpy.arange(len(mesh.blocks[number].ids))}))
        firsts = numpy.cumsum([0] + [len(block.ids) for block in mesh.blocks])
        for number, name in enumerate(names_of(file, "ss_names", "ss_prop1", "side set")):
            if f"elem_ss{number + 1}" not in file.variables:
                continue
            elements = file.variables[f"elem_ss{number + 1}"][:] - 1
            sides = file.variables[f"side_ss{number + 1}"][:] - 1
            blocks, parts = numpy.searchsorted(firsts, elements, side="right") - 1, []
            for block in numpy.unique(blocks):
                kind = mesh.blocks[block].kind
                table = TYPES[kind].exodus_sides if kind in TYPES else []
                if not table:
                    continue  # refused by name later, or of a lower dimension
                for side in numpy.unique(sides[blocks == block]):
                    if side >= len(table):
                        raise Refusal(f'the side set "{name}" names side {side + 1} of a {kind}, which is not supported')
                    here = (blocks == block) & (sides == side)
                    parts.append((int(block), elements[here] - firsts[block], table[side]))
            mesh.side_groups.append((name, parts))
        for number, name in enumerate(names_of(file, "ns_names", "ns_prop1", "node set")):
            if f"node_ns{number + 1}" in file.variables:
                mesh.node_groups.append((name, file.variables[f"node_ns{number + 1}"][:] - 1))


def add_cell_data(mesh, source):
    """Makes groups "ARRAY VALUE" of an array of integers, one per cell, which usually classifies the cells."""
    for name, parts in source.cell_data.items():
        parts = [numpy.asarray(part) for part in parts]
        parts = [part[:, 0] if part.ndim == 2 and part.shape[1] == 1 else part for part in parts]
        if name == "cell_tags" or len(parts) != len(mesh.blocks) or any(part.ndim != 1 for part in parts):
            continue
        if not all(numpy.issubdtype(part.dtype, numpy.integer) for part in parts):
            continue
        values = numpy.unique(numpy.concatenate(parts))
        if len(values) > MOST_VALUES:
            mesh.notes.append(f'note: no groups are made from the integer array "{name}", which has {len(values)} '
                              f"different values (at most {MOST_VALUES} are supported)")
            continue
        for value in values:
            mesh.cell_groups.append((f"{name} {value}", {number: numpy.nonzero(part == value)[0]
                                                         for number, part in enumerate(parts)}))


def read_by_meshio(path):
    try:
        import meshio
    except ImportError:
        raise Missing("python3-meshio")
    try:
        source = meshio.read(path)
    except ImportError as problem:
        raise Missing({"h5py": "python3-h5py", "netCDF4": "python3-netcdf4", "lxml": "python3-lxml"}.get(
            problem.name, f"the Python module {problem.name}"))
    except (Exception, SystemExit) as problem:  # some of its readers exit
        reason = "" if isinstance(problem, SystemExit) else f" ({type(problem).__name__}: {problem})"
        raise Refusal(f"meshio could not read this file{reason}{gmsh_advice(path)}")
    mesh = FileMesh()
    mesh.points = numpy.zeros((len(source.points), 3))
    points = numpy.asarray(source.points, dtype=float)
    mesh.points[:, :points.shape[1]] = points
    mesh.node_ids = numpy.arange(1, len(points) + 1)
    first = 1
    for cells in source.cells:
        mesh.blocks.append(Block(cells.type, numpy.asarray(cells.data), numpy.arange(first, first + len(cells.data))))
        first += len(cells.data)
    extension = os.path.splitext(path)[1].lower()
    if extension in (".e", ".exo", ".ex2"):
        if any(block.kind in TYPES and TYPES[block.kind].has_face_nodes for block in mesh.blocks):
            raise Refusal("cells of the Exodus types HEX27 and QUAD9 are not supported: their node order differs; "
                          "use HEX8, QUAD4, TETRA10 or TRI6")
        try:
            add_exodus_sets(mesh, path)
        except ImportError:
            raise Missing("python3-netcdf4")
    else:
        for name, parts in (source.cell_sets or {}).items():
            chosen = {number: numpy.asarray(indices, dtype=numpy.int64) for number, indices in enumerate(parts)
                      if indices is not None and len(indices)}
            mesh.cell_groups.append((name, chosen))
        mesh.node_groups += [(name, numpy.asarray(indices, dtype=numpy.int64))
                             for name, indices in (source.point_sets or {}).items()]
    add_families(mesh, source)
    add_cell_data(mesh, source)
    return mesh


def gmsh_advice(path):
    extension = os.path.splitext(path)[1].lower()
    if extension in (".bdf", ".nas", ".mesh", ".vtk"):
        return f"; Gmsh may be able to: gmsh {os.path.basename(path)} -save -format msh41 -o NEW.msh"
    return ""
