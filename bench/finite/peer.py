"""Runs Ricochet and GetFEM on one problem, and compares their results."""

import pathlib

import h5py
import numpy as np

import ours
import problems
from measurement import history, processor_seconds, record_of_peer

HERE = pathlib.Path(__file__).resolve().parent
# GetFEM's contact forces are compared with tractions per undeformed area.
FIELDS = '["displacement", "nominal_contact_pressure", "nominal_friction_traction"]'


def numbers(points, of):
    """Returns the index of each of `points` among those `of`, found by position, as the programs number nodes
    differently."""
    places = {tuple(key): k for k, key in enumerate(np.round(of * 1e8).astype(int))}
    return np.array([places[tuple(key)] for key in np.round(points * 1e8).astype(int)])


def arrays(case, directory, dimension):
    """Returns points and cells, and per frame displacement, pressure, friction traction, of a run that writes all
    steps."""
    ours.run(case, directory, {"output.fields": FIELDS})
    with h5py.File(directory / "results.h5") as file:
        points, cells = file["mesh/nodes"][:, :dimension], file["mesh/cells"][:]
        frames = [file["frames"][name] for name in sorted(file["frames"])]
        take = lambda name: np.array([frame[name][:] for frame in frames if name in frame])
        return points, cells, take("displacement")[..., :dimension], take("nominal_contact_pressure"), take("nominal_friction_traction")[..., :dimension]


def largest_stretch(points, cells, displacement):
    """Returns the largest |principal stretch - 1| of any linear cell in any frame."""
    d, largest = points.shape[1], 0.0
    corner = points[cells[:, :d + 1]]
    inverse = np.linalg.inv(corner[:, 1:] - corner[:, :1])
    for frame in displacement:
        moved = corner + frame[cells[:, :d + 1]]
        gradient = inverse @ (moved[:, 1:] - moved[:, :1])  # transpose of F
        largest = max(largest, float(abs(np.linalg.svd(gradient, compute_uv=False) - 1.0).max()))
    return largest


def getfem(action, mesh, dimension, friction, file, kernels, **options):
    """Returns the record that getfem_finite.py prints, or {"failed": why}; arrays are in `file`."""
    command = [HERE / "getfem_finite.py", action, mesh, dimension, "--friction", repr(friction), "--arrays", file]
    for name, value in options.items():
        command += [f"--{name}", repr(value)]
    return record_of_peer(command, kernels)


def differences(mine, file, first, bound):
    """Returns the largest differences of displacement and forces, over all steps and nodes, relative to the largest
    value. `first`: the frame of ours that is GetFEM's first one. `bound`: the coefficient of friction."""
    points, _, displacement, pressure, traction = mine
    with np.load(file) as theirs:
        moved = displacement[first:] - (displacement[0] if first else 0.0)
        other = theirs["displacement"][:, numbers(points, theirs["points"])]
        contact = numbers(theirs["contact_points"], points)
        force = pressure[first:][:, contact] * theirs["weights"]
        count = min(len(moved), len(other))
        result = {"displacement": abs(moved[:count] - other[:count]).max() / abs(moved).max(),
                  "force": abs(force[:count] - theirs["force"][:count, :, 0]).max() / force.max(),
                  "total": abs(force[:count].sum(axis=1) - theirs["force"][:count, :, 0].sum(axis=1)).max() / force.sum(axis=1).max(),
                  "largest_force": force.sum(axis=1).max(), "beyond": beyond(moved[:count], other[:count], force[:count], theirs["force"][:count, :, 0]), "pressed": int((force[:count] > 0.0).sum(axis=1).max())}
        if theirs["force"].shape[2] > 1:
            friction = traction[first:][:count][:, contact, :-1] * theirs["weights"][:, None]
            result["friction_force"] = abs(friction - theirs["force"][:count, :, 1:]).max() / force.max()
            result["at_bound"] = at_bound(force[count - 1], friction[count - 1], bound)
        return {name: float(value) for name, value in result.items()}


def beyond(moved, other, force, theirs):
    """Returns the step from which differences exceed 10^-8 of the largest value so far; 0 if none."""
    for k in range(len(moved)):
        if abs(moved[k] - other[k]).max() > 1e-8 * abs(moved[:k + 1]).max() or abs(force[k] - theirs[k]).max() > 1e-8 * force[:k + 1].max():
            return k + 1
    return 0


def at_bound(force, friction, bound):
    """Returns the number of pressed nodes whose friction is at its limit."""
    pressed = force > 1e-9 * force.max(initial=0.0)
    return int((np.linalg.norm(friction[pressed], axis=1) > bound * force[pressed] * (1.0 - 1e-6)).sum())


def step_seconds(case, directory, steps):
    """Returns the processor time of a step with contact: a run of all steps less one of the steps before contact, with
    rows of the history only at the end."""
    def seconds(**more):
        return processor_seconds(ours.run, case, directory, {"output.history_every": 1000000} | more, fields=False)

    short = seconds(**{"time.end": repr(problems.FLIGHT * problems.STEP)})
    return (seconds() - short) / (steps - problems.FLIGHT)


def newton_rounds(directory):
    """Returns the Newton iterations of the steps with contact of a run with all rows."""
    return [int(rounds) for rounds in history(directory)["newton_rounds"][problems.FLIGHT + 1:]]


def rounds_by_phase(directory):
    """Returns the iterations by whether contact is open, changes or is unchanged, as ricochet_step_bench classifies
    steps."""
    columns, phases = history(directory), {"open": [], "changing": [], "closed": []}
    for rounds, active, before in list(zip(columns["newton_rounds"], columns["active_contacts"], [0] + columns["active_contacts"]))[2:]:
        phases["open" if active == before == 0 else "closed" if active == before else "changing"].append(int(rounds))
    return phases
