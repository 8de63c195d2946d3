"""FCLib's local problems in HDF5, as far as the benchmark needs them, read independently of Ricochet's own reader."""

from dataclasses import dataclass

import h5py
import numpy as np


@dataclass
class Problem:
    """u = q + W r, points of `dimension` rows (normal first), coefficient F per point; K* contains û ⟂ r in K."""

    dimension: int
    operator: np.ndarray  # W, dense, rows × rows
    offset: np.ndarray  # q
    coefficient: np.ndarray  # F
    title: str = ""

    @property
    def points(self):
        return self.coefficient.size


def _number(node):
    return int(np.asarray(node[()]).reshape(-1)[0])


def _matrix(group):
    rows, columns, kind = (_number(group[name]) for name in ("m", "n", "nz"))
    starts, indices, values = (np.asarray(group[name][()]) for name in ("p", "i", "x"))
    dense = np.zeros((rows, columns))
    if kind >= 0:  # triplets
        np.add.at(dense, (starts[:kind], indices[:kind]), values[:kind])
        return dense
    line = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    if kind == -1:  # compressed columns
        np.add.at(dense, (indices[: line.size], line), values[: line.size])
    elif kind == -2:  # compressed rows
        np.add.at(dense, (line, indices[: line.size]), values[: line.size])
    else:
        raise ValueError(f"{group.name}/nz is {kind}: not -2, -1 or a number of triplets")
    return dense


def read(path):
    with h5py.File(path, "r") as file:
        root = file["fclib_local"]
        vectors = root["vectors"]
        title = ""
        if "info" in root and "title" in root["info"]:
            title = np.asarray(root["info/title"][()]).reshape(-1)[0]
            title = title.decode() if isinstance(title, bytes) else str(title)
        return Problem(
            dimension=_number(root["spacedim"]),
            operator=_matrix(root["W"]),
            offset=np.asarray(vectors["q"][()], dtype=float).reshape(-1),
            coefficient=np.asarray(vectors["mu"][()], dtype=float).reshape(-1),
            title=title,
        )


def write(path, problem, title=""):
    """Writes rescaled copies of exported problems, with W as compressed columns and every entry stored."""
    rows = problem.offset.size
    with h5py.File(path, "w") as file:
        root = file.create_group("fclib_local")
        root.create_dataset("spacedim", data=np.array([problem.dimension], dtype=np.int32))
        matrix = root.create_group("W")
        for name, value in (("nzmax", rows * rows), ("m", rows), ("n", rows), ("nz", -1)):
            matrix.create_dataset(name, data=np.array([value], dtype=np.int32))
        matrix.create_dataset("p", data=np.arange(0, rows * rows + 1, rows, dtype=np.int32))
        matrix.create_dataset("i", data=np.tile(np.arange(rows, dtype=np.int32), rows))
        matrix.create_dataset("x", data=problem.operator.T.reshape(-1))
        vectors = root.create_group("vectors")
        vectors.create_dataset("q", data=problem.offset)
        vectors.create_dataset("mu", data=problem.coefficient)
        vectors.create_dataset("s", data=np.zeros(rows))
        if title or problem.title:
            root.create_group("info").create_dataset("title", data=np.bytes_(title or problem.title))
