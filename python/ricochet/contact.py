"""The contact solvers alone, on matrices of numpy and scipy.

Find reactions r and motions u = q + W r such that, at every point, 0 <= r_N, u_N >= 0, r_N u_N = 0 and Coulomb's law
``|r_T| <= F r_N`` hold, where u_T is opposite to r_T if it slips. The rows of a point follow one another: its normal, then its
tangents.
"""

import threading
from typing import NamedTuple

import numpy

from . import _core
from .arrays import numbers
from .errors import InputError, NotConvergedError, UsageError
from .sparse import is_sparse, parts, require_symmetry

OPEN, CLOSED, STICK, SLIP = range(4)


class Solution(NamedTuple):
    """`reaction` and `motion`: points x rows of a point. `status`: per point OPEN, CLOSED (without friction), STICK or SLIP.
    `residual`: the largest violation of a point's conditions over that of r = 0. A residual below `rounding_floor` says no
    more. `reason`: why not, where it is not solved. `contradiction`: points whose conditions no motion meets together."""

    reaction: numpy.ndarray
    motion: numpy.ndarray
    status: numpy.ndarray
    outcome: str
    reason: str
    contradiction: list
    residual: float
    rounding_floor: float
    iterations: int
    newton_steps: int

    @property
    def solved(self):
        return self.outcome == "solved"


def solver_names():
    """What `solver` can be."""
    return _core.contact_solver_names()


def _operator(w):
    if is_sparse(w):
        return _core.sparse_operator(*parts(w, "W")), w.shape[0]
    if hasattr(w, "matvec"):
        if w.shape[0] != w.shape[1]:
            raise InputError(f"contact: W is a square operator, not one of {w.shape[0]} x {w.shape[1]}")
        # The library's vector is gone when the solver returns: a product that keeps its argument has a copy.
        return _core.product_operator(w.shape[0], lambda x: numbers(w.matvec(x.copy()), "contact: the product with W")), w.shape[0]
    w = numbers(w, "contact: W")
    if w.ndim != 2 or w.shape[0] != w.shape[1]:
        raise InputError(f"contact: W is a square matrix, not an array of shape {w.shape}")
    finite = w[numpy.isfinite(w)]
    if finite.size == w.size and w.size:
        require_symmetry(abs(w - w.T).max(), abs(w).max(), "W")
    return _core.dense_operator(w), w.shape[0]


def _per_point(values, points, name):
    values = numbers(values, f"contact: {name}")
    if values.ndim == 0:
        values = numpy.full(points, float(values))
    if values.shape != (points,):
        raise InputError(f"contact: {name} is one number, or one for each of the {points} points, not an array of shape {values.shape}")
    return values


class Solver:
    """A solver for one W and many q: each solution is the start of the next one. Threads need a solver each.

    `w`: a symmetric matrix, dense or of scipy.sparse, or a scipy LinearOperator. `friction`: F, one number or one per point.
    `dimension`: rows per point, 3, 2 or (without friction) 1. `bound`: the largest ``|r_T|``, per point or for all; 0: none.
    """

    def __init__(self, w, friction, *, dimension=3, solver="automatic", bound=0.0):
        operator, rows = _operator(w)
        if dimension not in (1, 2, 3) or rows % dimension:
            raise InputError(f"contact: W has {rows} rows, which is not a multiple of the {dimension} rows of a point; give `dimension`")
        self.points, self.dimension, self._alone = rows // dimension, dimension, threading.Lock()
        bound = _per_point(bound, self.points, "the bound")
        self._solver = _core.ContactSolver(solver, dimension, operator, _per_point(friction, self.points, "the friction coefficient"),
                                           bound if bound.any() else numpy.zeros(0))

    def solve(self, q, *, tolerance=0.0, iteration_limit=0, start=None):
        """The Solution for one q. `tolerance`: on the residual; 0: down to rounding. `start`: reactions to begin with."""
        q = numbers(q, "contact: q").reshape(-1)
        if q.size != self.points * self.dimension:
            raise InputError(f"contact: q has {q.size} numbers where W has {self.points * self.dimension} rows")
        if start is not None:
            start = numbers(start, "contact: the start").reshape(-1)
        if not self._alone.acquire(blocking=False):
            raise UsageError("contact: another thread is using this solver: each needs one of its own")
        try:
            if start is not None:
                self._solver.set_warm_start(start)
            return Solution(**self._solver.solve(q, tolerance, iteration_limit))
        finally:
            self._alone.release()


def solve(w, q, friction, *, dimension=3, tolerance=0.0, solver="automatic", bound=0.0, check=True):
    """Solves one problem. `check`: raises NotConvergedError where it is not solved; else Solution.solved says so."""
    found = Solver(w, friction, dimension=dimension, solver=solver, bound=bound).solve(q, tolerance=tolerance)
    if check and not found.solved:
        raise NotConvergedError(f"contact: {found.outcome}: {found.reason} (residual {found.residual:.3g}); check=False gives the "
                                "best that was found")
    return found
