"""Meshes from arrays, for example those of the Python interfaces of Gmsh and meshio, without a file."""

import os
import shutil
import tempfile
import weakref
from collections.abc import Mapping

import numpy

from .arrays import numbers, whole_numbers
from .converter.file_mesh import TYPES, Block, FileMesh, Refusal, dimension_of
from .converter.write_msh import write_msh
from .errors import InputError, UsageError
from .files import file_access, path_of

GMSH_KINDS = {kind.gmsh: name for name, kind in TYPES.items()}


def in_our_order(kind, nodes):
    """Reorders the nodes of cells from Gmsh's order to meshio's."""
    result = numpy.empty_like(nodes)
    result[:, TYPES[kind].order] = nodes
    return result


class Mesh:
    """Nodes, cells and named groups.

    `points`: nodes x 2 or 3. `cells`: a list of (kind, cells x nodes) with meshio's names of kinds ("triangle", "tetra10",
    ...) and VTK's order of nodes, or a dictionary of these. `groups`: a dictionary with one of the following for each name:

    - {kind: cells x nodes}: facets (or cells), by their nodes;
    - an array of node numbers: all boundary facets whose nodes are among them;
    - {number of a block of `cells`: numbers of its cells}.

    The mesh is checked when a case uses it, like a mesh from a file.
    """

    def __init__(self, points, cells, groups=None):
        mesh = FileMesh()
        points = numbers(points, "mesh: points")
        if points.ndim != 2 or points.shape[1] not in (2, 3) or len(points) == 0:
            raise InputError(f"mesh: points must be an array of nodes x 2 or 3, not of shape {points.shape}")
        if not numpy.isfinite(points).all():
            first = int(numpy.argwhere(~numpy.isfinite(points).all(axis=1))[0, 0])
            raise InputError(f"mesh: point {first} is not finite: {points[first]}")
        mesh.points = numpy.zeros((len(points), 3))
        mesh.points[:, :points.shape[1]] = points
        mesh.node_ids = numpy.arange(1, len(points) + 1, dtype=numpy.int64)
        self._mesh, self._next, self._file = mesh, 1, None
        try:
            listed = [(kind, nodes) for kind, nodes in (cells.items() if isinstance(cells, Mapping) else cells)]
        except (TypeError, ValueError):
            raise InputError("mesh: cells must be a dictionary, {kind: cells x nodes}, or a list of (kind, cells x nodes)") from None
        for kind, nodes in listed:
            self._add_block(kind, nodes, "cells")
        if not any(len(block.ids) and block.dimension >= 2 for block in mesh.blocks):
            raise InputError("mesh: there are no cells of dimension 2 or 3")
        if not isinstance(groups or {}, Mapping):
            raise InputError("mesh: groups must be a dictionary, {name: members}")
        count = len(mesh.blocks)
        for name, members in (groups or {}).items():
            self._add_group(str(name), members, count)

    def _add_block(self, kind, nodes, what):
        if not isinstance(kind, str):
            raise InputError(f"mesh: {what}: the kind {kind!r} is not a name; kinds are {', '.join(TYPES)}")
        nodes = whole_numbers(nodes, f"mesh: {what}", "nodes")
        wanted = TYPES[kind].nodes if kind in TYPES else None
        if nodes.size == 0:
            nodes = numpy.zeros((0, wanted or 1), dtype=numpy.int64)
        if nodes.ndim != 2 or (wanted is not None and nodes.shape[1] != wanted):
            raise InputError(f"mesh: {what}: a {kind} has {wanted} nodes; the array has the shape {nodes.shape}")
        if nodes.size and (nodes.min() < 0 or nodes.max() >= len(self._mesh.points)):
            raise InputError(f"mesh: {what}: a {kind} has node {nodes.max() if nodes.min() >= 0 else nodes.min()}; nodes are "
                             f"numbered from 0 to {len(self._mesh.points) - 1}")
        try:
            dimension_of(kind)
        except Refusal as problem:
            raise InputError(f"mesh: {problem}; kinds are {', '.join(TYPES)}") from None
        ids = numpy.arange(self._next, self._next + len(nodes), dtype=numpy.int64)
        self._next += len(nodes)
        self._mesh.blocks.append(Block(kind, nodes, ids))
        return len(self._mesh.blocks) - 1

    def _add_group(self, name, members, blocks):
        if any(not c.isprintable() and not "\udc80" <= c <= "\udcff" for c in name):
            raise InputError(f"mesh: the name of the group {name!r} has characters that mesh files cannot contain; rename the group")
        if not isinstance(members, Mapping):
            nodes = whole_numbers(members, f'mesh: group "{name}"', "nodes")
            if nodes.ndim != 1:
                raise InputError(f'mesh: group "{name}": a one-dimensional array of node numbers, or a dictionary, is required')
            if nodes.size and (nodes.min() < 0 or nodes.max() >= len(self._mesh.points)):
                raise InputError(f'mesh: group "{name}": there is no node {nodes.max() if nodes.min() >= 0 else nodes.min()}')
            self._mesh.node_groups.append((name, nodes.astype(numpy.int64)))
            return
        chosen = {}
        for key, own in members.items():
            if isinstance(key, str):
                block = self._add_block(key, own, f'group "{name}"')
                chosen[block] = numpy.arange(len(self._mesh.blocks[block].ids))
                continue
            if not isinstance(key, (int, numpy.integer)) or not 0 <= key < blocks:
                raise InputError(f'mesh: group "{name}": there is no block {key} of cells')
            own = whole_numbers(own, f'mesh: group "{name}": block {key}', "cells").reshape(-1)
            if own.size and (own.min() < 0 or own.max() >= len(self._mesh.blocks[key].ids)):
                raise InputError(f'mesh: group "{name}": block {key} has {len(self._mesh.blocks[key].ids)} cells, numbered from 0')
            chosen[int(key)] = own
        self._mesh.cell_groups.append((name, chosen))

    @classmethod
    def from_meshio(cls, source):
        """Makes a Mesh from a meshio.Mesh. Its cell sets, its point sets and Gmsh's physical groups, by name, become groups."""
        if not all(hasattr(source, name) for name in ("points", "cells", "cell_data", "cell_sets", "point_sets")):
            raise UsageError(f"mesh: a meshio.Mesh is required, not a {type(source).__name__}")
        groups = {}
        names = {(int(tag), int(dimension)): name for name, (tag, dimension) in (getattr(source, "field_data", None) or {}).items()}
        tags = (source.cell_data or {}).get("gmsh:physical")
        if tags is not None:
            for number, (block, of_block) in enumerate(zip(source.cells, tags)):
                for tag in numpy.unique(of_block):
                    name = names.get((int(tag), dimension_of(block.type)), str(int(tag)))
                    groups.setdefault(name, {})[number] = numpy.flatnonzero(of_block == tag)
        for name, parts in (source.cell_sets or {}).items():
            if not name.startswith("gmsh:"):
                groups[name] = {number: part for number, part in enumerate(parts) if part is not None and len(part)}
        for name, nodes in (source.point_sets or {}).items():
            groups.setdefault(name, numpy.asarray(nodes))
        points = numpy.asarray(source.points)
        kinds = [(block.type, block.data) for block in source.cells if block.type != "vertex"]
        if len(kinds) < len(source.cells):
            kept = [number for number, block in enumerate(source.cells) if block.type != "vertex"]
            places = {old: new for new, old in enumerate(kept)}
            groups = {name: {places[k]: v for k, v in members.items() if k in places} if isinstance(members, dict) else members
                      for name, members in groups.items()}
        return cls(points, kinds, groups)

    @classmethod
    def from_gmsh(cls, model=None):
        """Makes a Mesh from the current model of the gmsh module. Its physical groups become groups."""
        if model is None:
            import gmsh

            model = gmsh.model
        tags, coordinates, _ = model.mesh.getNodes()
        if len(tags) == 0:
            raise InputError("mesh: Gmsh's current model has no nodes; generate them with gmsh.model.mesh.generate()")
        number = numpy.full(int(tags.max()) + 1, -1, dtype=numpy.int64)
        number[tags.astype(numpy.int64)] = numpy.arange(len(tags))
        cells, groups, placed = [], {}, {}

        def add(dimension, entity):
            if (dimension, entity) not in placed:
                placed[dimension, entity] = []
                kinds, _, nodes = model.mesh.getElements(dimension, entity)
                for kind, of_kind in zip(kinds, nodes):
                    if int(kind) == 15:
                        continue
                    if int(kind) not in GMSH_KINDS:
                        raise InputError(f"mesh: elements of Gmsh's type {kind} are not supported")
                    name = GMSH_KINDS[int(kind)]
                    table = number[of_kind.astype(numpy.int64)].reshape(-1, TYPES[name].nodes)
                    placed[dimension, entity].append((len(cells), len(table)))
                    cells.append((name, in_our_order(name, table)))
            return placed[dimension, entity]

        top = max((dimension for dimension, _ in model.getEntities()), default=0)
        for dimension, entity in model.getEntities(top):
            add(dimension, entity)
        for dimension, tag in model.getPhysicalGroups():
            if dimension == 0:
                continue
            name = model.getPhysicalName(dimension, tag) or str(tag)
            members = groups.setdefault(name, {})
            for entity in model.getEntitiesForPhysicalGroup(dimension, tag):
                for block, count in add(dimension, int(entity)):
                    members[block] = numpy.arange(count)
        points = coordinates.reshape(-1, 3)
        return cls(points[:, :2] if top == 2 and not points[:, 2].any() else points, cells, groups)

    @property
    def points(self):
        return self._mesh.points

    @property
    def groups(self):
        """Names of the groups."""
        return [name for name, _ in self._mesh.cell_groups + self._mesh.node_groups]

    def write(self, path):
        """Writes a .msh file (version 4.1, binary). Returns its path."""
        try:
            with file_access(path):
                write_msh(self._mesh, path_of(path, "mesh"))
        except Refusal as problem:
            raise InputError(f"mesh: {problem}") from None
        return path

    @property
    def path(self):
        """Path of a file with this mesh, for sessions to read. The file exists as long as the mesh."""
        if self._file is None:
            with file_access():
                folder = tempfile.mkdtemp(prefix="ricochet-mesh-")
            path = os.path.join(folder, "mesh.msh")
            weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
            self.write(path)
            self._file = path
        return self._file

    def __repr__(self):
        cells = ", ".join(f"{len(block.ids)} x {block.kind}" for block in self._mesh.blocks)
        return f"<Mesh of {len(self.points)} points: {cells}>"
