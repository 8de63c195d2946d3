"""Falling bodies whose every step is a frame of results.xdmf, and these frames read back."""

import meshio

from harness import body_case, initial_velocity


def falling(mesh, lowest, highest, *, group="body", bottom="bottom", degree=1, scheme="midpoint"):
    """Returns a body that moves down on a floor just below it, with probes at these points."""
    up = [0] * (len(lowest) - 1) + [1]
    point = [0.0] * (len(lowest) - 1) + [lowest[-1] - 0.01]
    return body_case(mesh, point, up, initial_velocity(*(-x for x in up)), body=group, bottom=bottom, degree=degree,
                     scheme=scheme, step=0.002, end=0.06) + (
        f'[[probe]]\nname = "lowest"\nat = {lowest}\n[[probe]]\nname = "highest"\nat = {highest}\n'
        "[output]\nfields_every = 1\n")


def frames(results):
    """Returns (points, cell blocks, [(time, fields)]) as meshio reads them."""
    with meshio.xdmf.TimeSeriesReader(results / "results.xdmf") as reader:
        points, cells = reader.read_points_cells()
        read = [reader.read_data(k) for k in range(reader.num_steps)]
    return points, [(block.type, block.data) for block in cells], [(t, fields) for t, fields, _ in read]
