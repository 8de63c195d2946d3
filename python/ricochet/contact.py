"""Contact solvers for matrices of numpy and scipy, without a simulation.

They find reactions r and motions u = q + W r that satisfy, at every point, r_N >= 0, u_N >= 0, r_N u_N = 0 and Coulomb's law
``|r_T| <= F r_N``, with u_T opposite to r_T if the point slips. The rows of a point are consecutive: its normal, then its
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
    """Result of a contact problem.

    `reaction` and `motion`: arrays of points x rows per point. `status`: OPEN, CLOSED (without friction), STICK or SLIP for
    each point. `reason`: why the problem is not solved. `contradiction`: points whose conditions no motion satisfies together.
    `residual`: the largest violation of the conditions of a point, divided by that of r = 0; below `rounding_floor` it may be
    rounding alone.
    """

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
    """Returns the names of the contact solvers, for the argument `solver`."""
    return _core.contact_solver_names()


def _operator(w):
    if is_sparse(w):
        return _core.sparse_operator(*parts(w, "W")), w.shape[0]
    if hasattr(w, "matvec"):
        if w.shape[0] != w.shape[1]:
            raise InputError(f"contact: W must be a square operator, not one of {w.shape[0]} x {w.shape[1]}")
        # The library's vector does not outlive the solver; a product that keeps its argument keeps a copy.
        return _core.product_operator(w.shape[0], lambda x: numbers(w.matvec(x.copy()), "contact: the product with W")), w.shape[0]
    w = numbers(w, "contact: W")
    if w.ndim != 2 or w.shape[0] != w.shape[1]:
        raise InputError(f"contact: W must be a square matrix, not an array of shape {w.shape}")
    finite = w[numpy.isfinite(w)]
    if finite.size == w.size and w.size:
        require_symmetry(abs(w - w.T).max(), abs(w).max(), "W")
    return _core.dense_operator(w), w.shape[0]


def _per_point(values, points, name):
    values = numbers(values, f"contact: {name}")
    if values.ndim == 0:
        values = numpy.full(points, float(values))
    if values.shape != (points,):
        raise InputError(f"contact: {name} must be one number, or one for each of the {points} points, not an array of shape "
                         f"{values.shape}")
    return values


class Solver:
    """Solver for one W and many q. Each solution is the initial value of the next one. Every thread needs a solver of its own.

    `w`: a symmetric matrix, dense or of scipy.sparse, or a scipy LinearOperator. `friction`: F, one number or one per point.
    `dimension`: rows per point, 3, 2 or (without friction) 1. `bound`: upper bound of ``|r_T|``, one number or one per point;
    0 for none.
    """

    def __init__(self, w, friction, *, dimension=3, solver="automatic", bound=0.0):
        operator, rows = _operator(w)
        if dimension not in (1, 2, 3) or rows % dimension:
            raise InputError(f"contact: W has {rows} rows, which is not a multiple of the {dimension} rows of a point; set "
                             "`dimension`")
        self.points, self.dimension, self._alone = rows // dimension, dimension, threading.Lock()
        bound = _per_point(bound, self.points, "the bound")
        self._solver = _core.ContactSolver(solver, dimension, operator, _per_point(friction, self.points, "the friction coefficient"),
                                           bound if bound.any() else numpy.zeros(0))

    def solve(self, q, *, tolerance=0.0, iteration_limit=0, start=None):
        """Returns the Solution for one q. `tolerance`: bound of the residual; 0: down to rounding. `start`: initial reactions."""
        q = numbers(q, "contact: q").reshape(-1)
        if q.size != self.points * self.dimension:
            raise InputError(f"contact: q has {q.size} numbers, but W has {self.points * self.dimension} rows")
        if start is not None:
            start = numbers(start, "contact: the start").reshape(-1)
        if not self._alone.acquire(blocking=False):
            raise UsageError("contact: another thread is using this solver; create one solver per thread")
        try:
            if start is not None:
                self._solver.set_warm_start(start)
            return Solution(**self._solver.solve(q, tolerance, iteration_limit))
        finally:
            self._alone.release()


def solve(w, q, friction, *, dimension=3, tolerance=0.0, solver="automatic", bound=0.0, check=True):
    """Solves one problem and returns the Solution. With `check`, raises NotConvergedError if the problem is not solved; without
    it, see Solution.solved."""
    found = Solver(w, friction, dimension=dimension, solver=solver, bound=bound).solve(q, tolerance=tolerance)
    if check and not found.solved:
        raise NotConvergedError(f"contact: {found.outcome}: {found.reason} (residual {found.residual:.3g}); use check=False to "
                                "obtain the best result found")
    return found
