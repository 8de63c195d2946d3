"""The single measure of the benchmark, computed independently of the programs that it judges. Sums in long double.

With w_i = trace(W_ii)/d (W_NN if F = 0) and û = u + (F |u_T|, 0, 0), the residual of a point is
    e_i = sqrt(w_i) (r_i − P_K(r_i − û_i / w_i)),      K = {|r_T| <= F r_N},
and that of the problem is max |e_i| relative to its value at r = 0. It has no unit and is invariant to scalings of q
and W.
"""

import numpy as np

EPSILON = np.finfo(float).eps


def multiply(problem, reaction):
    """Returns W r in long double, processed by rows, as the whole of W in long double would take twice its size."""
    reaction = np.asarray(reaction, dtype=np.longdouble)
    columns = np.flatnonzero(reaction)
    result = np.zeros(reaction.size, dtype=np.longdouble)
    piece = max(1, 4_000_000 // max(1, columns.size))
    for start in range(0, reaction.size, piece):
        rows = slice(start, start + piece)
        result[rows] = problem.operator[rows][:, columns].astype(np.longdouble) @ reaction[columns]
    return result


def weights(problem):
    """Returns w_i per point."""
    diagonal = problem.operator.diagonal().reshape(problem.points, problem.dimension)
    return np.where(problem.coefficient > 0.0, diagonal.mean(axis=1), diagonal[:, 0])


def project(coefficient, vectors):
    """Returns the point of K nearest to each row of `vectors`."""
    normal, tangential = vectors[:, 0], vectors[:, 1:]
    length = np.sqrt((tangential**2).sum(axis=1))
    on_cone = np.maximum((normal + coefficient * length) / (1 + coefficient**2), 0)
    inside = length <= coefficient * normal
    polar = coefficient * length <= -normal
    scale = np.divide(coefficient * on_cone, length, out=np.zeros_like(length), where=length > 0)
    projected = np.concatenate([on_cone[:, None], tangential * scale[:, None]], axis=1)
    projected[inside] = vectors[inside]
    projected[polar] = 0
    return projected


def point_residuals(problem, reaction, motion):
    shape = (problem.points, problem.dimension)
    w = weights(problem).astype(np.longdouble)
    r = np.asarray(reaction, dtype=np.longdouble).reshape(shape)
    corrected = np.array(motion, dtype=np.longdouble).reshape(shape)
    corrected[:, 0] += problem.coefficient * np.sqrt((corrected[:, 1:] ** 2).sum(axis=1))
    error = r - project(problem.coefficient.astype(np.longdouble), r - corrected / w[:, None])
    return np.sqrt(w) * np.sqrt((error**2).sum(axis=1))


class Measure:
    """Measure of one problem; stores the data that do not depend on the reaction."""

    def __init__(self, problem):
        self.problem = problem
        self.weights = weights(problem)
        self.scale = float(point_residuals(problem, np.zeros(problem.offset.size), problem.offset).max(initial=0.0))

    def motion(self, reaction):
        return multiply(self.problem, reaction) + self.problem.offset

    def residual(self, reaction):
        reaction = np.asarray(reaction)
        if reaction.size != self.problem.offset.size or not np.isfinite(reaction.astype(float)).all():
            return float("inf")
        errors = point_residuals(self.problem, reaction, self.motion(reaction))
        return float(errors.max(initial=0.0)) / self.scale if self.scale > 0 else float(errors.max(initial=0.0))

    def rounding_floor(self, reaction):
        """Residual that the rounding of r, q and W to doubles may leave: no solver can be expected to fall below it."""
        shape = (self.problem.points, self.problem.dimension)
        size = np.abs(self.problem.operator) @ np.abs(np.asarray(reaction, dtype=float)) + np.abs(self.problem.offset)
        per_point = np.sqrt((size.reshape(shape) ** 2).sum(axis=1)) / np.sqrt(self.weights)
        return float(EPSILON * per_point.max(initial=0.0) / self.scale) if self.scale > 0 else 0.0

    def distance(self, reaction, reference, reference_motion=None):
        """Distances of reactions and of motions from those of a reference: largest over the points, relative to the
        largest of the reference.

        If everything sticks, the motion is zero; its distance is then relative to the natural map at r = 0.
        """
        shape = (self.problem.points, self.problem.dimension)
        reaction = np.asarray(reaction, dtype=np.longdouble)
        if reaction.size != self.problem.offset.size or not np.isfinite(reaction.astype(float)).all():
            return float("inf"), float("inf")
        reference = np.asarray(reference, dtype=np.longdouble)
        if reference_motion is None:
            reference_motion = self.motion(reference)

        def largest(vector, weight):
            lengths = np.sqrt((np.asarray(vector, dtype=np.longdouble).reshape(shape) ** 2).sum(axis=1))
            return float((weight * lengths).max(initial=0.0))

        root, tiny = np.sqrt(self.weights), np.finfo(float).tiny
        of_reaction = largest(reaction - reference, root) / max(largest(reference, root), tiny)
        difference = multiply(self.problem, reaction - reference)
        of_motion = largest(difference, 1 / root) / max(largest(reference_motion, 1 / root), self.scale, tiny)
        return of_reaction, of_motion
