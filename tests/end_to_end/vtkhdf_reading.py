"""VTKHDF files of unstructured grids that change in time, read in two ways: by the published description of the format
(docs.vtk.org, "VTKHDF File Format"), with h5py, and by VTK's own reader.

VTK 9.1, Debian's, reads files without steps (version 1.0), and of those with steps only the first. view() makes such a
file for any step: with links to the data in the file and virtual data sets for the step's rows, so that VTK reads the
file's own bytes."""

import h5py
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOHDF import vtkHDFReader

GROUPS = ("PointData", "CellData")
MESH = ("Points", "Connectivity", "Offsets", "Types")


class Step:
    """A step: the start and length of its parts of the data sets, and the values."""

    def __init__(self, root, number):
        steps = root["Steps"]
        at = {name: int(steps[name][number]) for name in ("PartOffsets", "PointOffsets", "CellOffsets",
                                                          "ConnectivityIdOffsets")}
        assert int(steps["NumberOfParts"][number]) == 1
        part = at["PartOffsets"]
        points, cells, nodes = (int(root[name][part])
                                for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"))
        self.time = float(steps["Values"][number])
        self.rows = {"Points": (at["PointOffsets"], points), "Types": (at["CellOffsets"], cells),
                     "Offsets": (at["CellOffsets"] + part, cells + 1),
                     "Connectivity": (at["ConnectivityIdOffsets"], nodes)}
        self.fields = {}
        for group, count in zip(GROUPS, (points, cells)):
            for name in root[group]:
                table = steps[f"{group}Offsets"][name]
                self.rows[f"{group}/{name}"] = (int(table[number]), count)
                self.fields[name] = f"{group}/{name}"
        for name, (begin, count) in self.rows.items():
            assert 0 <= begin and begin + count <= len(root[name]), (number, name)

    def read(self, root, name):
        begin, count = self.rows[self.fields.get(name, name)]
        return root[self.fields.get(name, name)][begin:begin + count]


def check_steps(root, killed=False):
    """Checks the description's demands on the group /VTKHDF. Returns all its steps. Tables of a run that was killed may
    have an entry for a step that does not count yet."""
    assert list(root.attrs["Version"]) == [2, 0] and root.attrs["Version"].dtype.kind == "i"
    kind = root.attrs.get_id("Type")
    assert kind.get_type().get_class() == h5py.h5t.STRING and not kind.get_type().is_variable_str()
    assert kind.get_type().get_cset() == h5py.h5t.CSET_ASCII and kind.shape == ()
    assert root.attrs["Type"] == b"UnstructuredGrid"
    count = int(root["Steps"].attrs["NSteps"])
    for name in ("Values", "NumberOfParts", "PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets"):
        length, = root["Steps"][name].shape
        assert length == count or killed and length in (count, count + 1) or killed and name == "Values", name
    count = min(count, len(root["Steps/Values"]))
    for group in GROUPS:
        for name, table in root[f"Steps/{group}Offsets"].items():
            assert len(table) - count in ((0, 1) if killed else (0,)), name
    assert root["Types"].dtype == numpy.uint8 and root["Points"].shape[1:] == (3,)
    steps = [Step(root, number) for number in range(count)]
    for step in steps[:1] + steps[-1:]:
        offsets, nodes = step.read(root, "Offsets"), step.read(root, "Connectivity")
        assert offsets[0] == 0 and offsets[-1] == len(nodes) and (numpy.diff(offsets) > 0).all()
        assert nodes.min() >= 0 and nodes.max() < step.rows["Points"][1]
    return steps


def view(path, number, place):
    """Makes a file of VTKHDF 1.0 that shows one step of another one."""
    with h5py.File(path) as file, h5py.File(place, "w", libver="latest") as new:
        root, shown = file["VTKHDF"], new.create_group("VTKHDF")
        step = Step(root, number)
        shown.attrs["Version"] = numpy.array([1, 0])
        shown.attrs.create("Type", b"UnstructuredGrid", dtype=h5py.string_dtype("ascii", 16))
        for name, row in (("NumberOfPoints", "Points"), ("NumberOfCells", "Types"),
                          ("NumberOfConnectivityIds", "Connectivity")):
            shown[name] = numpy.array([step.rows[row][1]])
        for name, (begin, count) in step.rows.items():
            source = root[name]
            layout = h5py.VirtualLayout((count, *source.shape[1:]), source.dtype)
            layout[:] = h5py.VirtualSource(path, f"/VTKHDF/{name}", source.shape)[begin:begin + count]
            shown.create_virtual_dataset(name, layout)
    return place


class Grid:
    """The contents of a file as read by VTK's reader."""

    def __init__(self, path):
        reader = vtkHDFReader()
        assert reader.CanReadFile(str(path)), path
        reader.SetFileName(str(path))
        reader.Update()
        grid = reader.GetOutput()
        assert isinstance(grid, vtkUnstructuredGrid), path
        self.points = vtk_to_numpy(grid.GetPoints().GetData()).copy()
        self.types = vtk_to_numpy(grid.GetCellTypesArray()).copy()
        self.offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray()).copy()
        self.connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).copy()
        self.fields = {}
        for data in (grid.GetPointData(), grid.GetCellData()):
            for i in range(data.GetNumberOfArrays()):
                self.fields[data.GetArrayName(i)] = vtk_to_numpy(data.GetArray(i)).copy()
