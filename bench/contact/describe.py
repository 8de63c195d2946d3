"""Sizes, conditioning and states of the problems."""

import h5py
import numpy as np

import fclib


def stored_solution(path):
    with h5py.File(path, "r") as file:
        group = file.get("solution", file["fclib_local"].get("solution"))
        return None if group is None else np.asarray(group["r"][()], dtype=float).reshape(-1)


def condition(problem):
    """Condition number of W scaled to unit size at every point."""
    diagonal = problem.operator.diagonal().reshape(problem.points, problem.dimension).mean(axis=1)
    factor = np.repeat(diagonal**-0.5, problem.dimension)
    values = np.linalg.eigvalsh(factor[:, None] * problem.operator * factor)
    return float(values[-1] / values[0]) if values[0] > 0 else float("inf")


def states(problem, reaction):
    """Numbers of points open, sticking (or closed without friction) and slipping."""
    r = np.asarray(reaction, dtype=float).reshape(problem.points, problem.dimension)
    normal, tangential = r[:, 0], np.sqrt((r[:, 1:] ** 2).sum(axis=1))
    pressed = normal > 1e-12 * max(normal.max(initial=0.0), np.finfo(float).tiny)
    slipping = pressed & (problem.coefficient > 0) & (tangential >= problem.coefficient * normal * (1 - 1e-9))
    return {
        "open": int((~pressed).sum()),
        "sticking": int((pressed & ~slipping).sum()),
        "slipping": int(slipping.sum()),
    }


def describe(path, reaction=None, with_condition=True):
    problem = fclib.read(path)
    reaction = stored_solution(path) if reaction is None else reaction
    return {
        "dimension": problem.dimension,
        "points": problem.points,
        "friction": float(problem.coefficient.max(initial=0.0)),
        "condition": condition(problem) if with_condition else None,
        **(states(problem, reaction) if reaction is not None else {}),
    }


if __name__ == "__main__":
    import sys

    for name in sys.argv[1:]:
        entry = describe(name, with_condition=fclib.read(name).points < 1000)
        print(name.rsplit("/", 1)[-1], {key: value if value is None else float(f"{value:.4g}") for key, value in entry.items()}, flush=True)
