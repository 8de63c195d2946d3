"""Meshes from arrays yield the results of the same mesh from a file."""

import os

import meshio
import numpy
import pytest

import ricochet as rc
from ricochet.converter.file_mesh import TYPES

CASE = {
    "material": [{"group": "all", "density": 1000.0, "young": 1e6, "poisson": 0.3}],
    "obstacle": {"floor": {"type": "plane", "point": [0, 0], "normal": [0, 1]}},
    "contact": [{"group": "bottom", "obstacle": "floor"}],
    "initial": {"velocity": [0.1, -1.0]},
    "mass": {"type": "lumped"},
    "time": {"scheme": "contact-stabilized", "step": 1e-4, "end": 5e-3},
}


def square(n=4):
    x, y = numpy.meshgrid(numpy.linspace(0, 1, n + 1), numpy.linspace(0.001, 1.001, n + 1))
    points = numpy.column_stack([x.reshape(-1), y.reshape(-1)])
    first = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)).reshape(-1)
    return points, numpy.column_stack([first, first + 1, first + n + 2, first + n + 1])


def history_of(source, changes=None, mesh=None, folder=None):
    return rc.run(source, folder, changes, mesh=mesh).history


def test_the_same_mesh_three_ways(tmp_path, cases):
    path = cases / "puck/puck.msh"
    changes = {"time.end": 6e-4}
    table = {
        "mesh": {"plane": "stress"},
        "material": [{"group": "puck", "density": 1200.0, "young": 5e7, "poisson": 0.4}],
        "obstacle": {"wall": {"type": "plane", "point": [0, 0], "normal": [0, 1]}},
        "contact": [{"group": "skin", "obstacle": "wall", "friction": 0.3}],
        "initial": {"velocity": [1.5, -0.5]},
        "time": {"step": 1e-6, "end": 1.0},
    }
    from_file = rc.run({**table, "mesh": {"plane": "stress", "file": path}}, tmp_path / "file", changes)
    from_meshio = rc.run(table, tmp_path / "meshio", changes, mesh=rc.Mesh.from_meshio(meshio.read(path)))
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        gmsh.open(str(path))
        by_gmsh = rc.Mesh.from_gmsh()
    finally:
        gmsh.finalize()
    from_gmsh = rc.run(table, tmp_path / "gmsh", changes, mesh=by_gmsh)
    for other in (from_meshio, from_gmsh):
        assert other.history["contact_force_y"].max() > 0
        for name in from_file.history:
            scale = abs(from_file.history[name]).max()
            assert other.history[name] == pytest.approx(from_file.history[name], rel=1e-9, abs=1e-9 * scale), name


@pytest.mark.parametrize("case", ["disc/degree2.toml", "hertz/sphere.toml", "ball/ball.toml", "rod/quadrilaterals.toml"])
def test_meshes_of_every_kind_of_cell(cases, case):
    """The order of their nodes is right: a wrong order yields another stiffness, or inverted cells."""
    import tomllib

    path = cases / case
    table = tomllib.loads(path.read_text())
    file = path.parent / table["mesh"].pop("file")
    for section in ("probe", "expect"):
        table.pop(section, None)
    first = rc.Session(path)
    second = rc.Session(table, mesh=rc.Mesh.from_meshio(meshio.read(file)))
    assert abs(first.mass - second.mass).max() < 1e-12 * abs(first.mass).max()
    assert abs(first.stiffness() - second.stiffness()).max() < 1e-12 * abs(first.stiffness()).max()


def test_groups_by_nodes_cells_and_facets(tmp_path):
    points, quads = square()
    bottom = numpy.flatnonzero(points[:, 1] < 0.01)
    facets = numpy.column_stack([bottom[:-1], bottom[1:]])
    histories = []
    for number, group in enumerate((bottom, {"line": facets})):
        mesh = rc.Mesh(points, {"quad": quads}, {"bottom": group, "half": {0: numpy.arange(8)}})
        assert set(mesh.groups) == {"bottom", "half"}
        histories.append(history_of(CASE, mesh=mesh, folder=tmp_path / str(number)))
    assert (histories[0]["kinetic_energy"] == histories[1]["kinetic_energy"]).all()
    assert histories[0]["contact_force_y"].max() > 0


def test_a_run_with_a_mesh_of_arrays_goes_on_anywhere(tmp_path, program):
    import subprocess

    points, quads = square()
    mesh = rc.Mesh(points, {"quad": quads}, {"bottom": numpy.flatnonzero(points[:, 1] < 0.01)})
    with rc.Session(CASE, mesh=mesh) as session:
        session.write_to(tmp_path / "out")
        session.run(lambda s: s.step_number < 20)
    del session, mesh
    assert sorted(os.listdir(tmp_path / "out"))[:2] == ["case.msh", "case.toml"]
    outcome = subprocess.run([program, "run", "--resume", tmp_path / "out"], capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stderr
    assert rc.open(tmp_path / "out").summary["steps"] == 50


def test_files_of_meshes_go_with_them():
    points, quads = square()
    mesh = rc.Mesh(points, {"quad": quads})
    path = mesh.path
    assert os.path.exists(path)
    del mesh
    assert not os.path.exists(os.path.dirname(path))


@pytest.mark.parametrize(
    "points, cells, groups, message",
    [
        ([[0, 0], [1, 0]], {"triangle": [[0, 1, 2]]}, {}, "node 2; nodes are numbered from 0 to 1"),
        ([[0, 0], [1, 0], [0, numpy.nan]], {"triangle": [[0, 1, 2]]}, {}, "point 2 is not finite"),
        ([[0], [1]], {"triangle": [[0, 1, 2]]}, {}, "nodes x 2 or 3"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1]]}, {}, "a triangle has 3 nodes"),
        ([[0, 0], [1, 0], [0, 1]], {"tringle": [[0, 1, 2]]}, {}, "kinds are line"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2.5]]}, {}, "must be integers"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a": [5]}, "there is no node 5"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a": {3: [0]}}, "there is no block 3"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a": {0: [4]}}, "block 0 has 1 cells"),
        ([[0, 0], [1, 0], [0, 1j]], {"triangle": [[0, 1, 2]]}, {}, "points: real numbers"),
        ([[0, 0], [1, 0], [0, None]], {"triangle": [[0, 1, 2]]}, {}, "points: real numbers"),
        ([["a", "b"]], {"triangle": [[0, 1, 2]]}, {}, "points: real numbers"),
        ([[0, 0], [1]], {"triangle": [[0, 1, 2]]}, {}, "points: the values do not form an array"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1], [0, 1, 2]]}, {}, "cells: the values do not form an array"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": []}, {}, "no cells of dimension 2 or 3"),
        ([[0, 0], [1, 0], [0, 1]], {"line": [[0, 1]]}, {}, "no cells of dimension 2 or 3"),
        ([[0, 0], [1, 0], [0, 1]], None, {}, "cells must be a dictionary"),
        ([[0, 0], [1, 0], [0, 1]], [1, 2], {}, "cells must be a dictionary"),
        ([[0, 0], [1, 0], [0, 1]], {3: [[0, 1, 2]]}, {}, "the kind 3 is not a name"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, [1], "groups must be a dictionary"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a": {None: [0]}}, "there is no block None"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a": {0: [0.7]}}, "block 0: numbers of cells must be integers, not float64"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a": {0: [2**70]}}, "numbers of cells must be integers"),
        # Converted to integers, a mask would select the cells 0 and 1.
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a": {0: [True]}}, "numpy.flatnonzero"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a": [True, True, False]}, "numpy.flatnonzero"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a\nb": [0]}, "characters that mesh files cannot contain"),
        ([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]}, {"a\ud800b": [0]}, "characters that mesh files cannot contain"),
    ],
)
def test_what_is_wrong_is_said(points, cells, groups, message):
    with pytest.raises(rc.InputError, match=message):
        rc.Mesh(points, cells, groups)


def test_arrays_that_change_later_leave_the_mesh_alone(tmp_path):
    points, quads = square()
    bottom = numpy.flatnonzero(points[:, 1] < 0.01)
    mesh, same = (rc.Mesh(points.copy(), {"quad": cells}, {"bottom": nodes}) for cells, nodes in ((quads.copy(), bottom.copy()), (quads, bottom)))
    quads[:], bottom[:], points[:] = 77, 0, numpy.nan
    assert open(mesh.write(tmp_path / "a.msh"), "rb").read() == open(same.write(tmp_path / "b.msh"), "rb").read()


def test_what_is_no_mesh_of_another_library():
    with pytest.raises(rc.UsageError, match="a meshio.Mesh is required, not a int"):
        rc.Mesh.from_meshio(3)
    import gmsh

    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        with pytest.raises(rc.InputError, match="has no nodes"):
            rc.Mesh.from_gmsh()
    finally:
        gmsh.finalize()


def test_a_case_with_a_file_takes_no_mesh(cases):
    points, quads = square()
    mesh = rc.Mesh(points, {"quad": quads})
    with pytest.raises(rc.UsageError):
        rc.Case(cases / "puck/puck.toml", mesh=mesh)
    with pytest.raises(rc.UsageError, match="already defines the mesh"):
        rc.Case({**CASE, "mesh": {"file": "a.msh"}}, mesh=mesh)


def test_types_of_cells_agree_with_meshio():
    """The table comes from the C++ descriptions of the shapes; meshio has its own."""
    from meshio.gmsh import common

    for kind, cell in TYPES.items():
        assert common._gmsh_to_meshio_type[cell.gmsh] == kind
        assert cell.nodes == meshio._mesh.num_nodes_per_cell[kind]
        assert cell.dimension == meshio._mesh.topological_dimension[kind]
        numbers = numpy.arange(cell.nodes).reshape(1, -1)
        assert common._meshio_to_gmsh_order(kind, numbers)[0].tolist() == cell.order
        for own, nodes in cell.facets:
            assert TYPES[own].dimension == cell.dimension - 1 and len(nodes) == TYPES[own].nodes
            assert len(set(nodes)) == len(nodes) and max(nodes) < cell.nodes
            assert max(nodes[:TYPES[own].vertices]) < cell.vertices
