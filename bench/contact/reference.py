"""A solution converged to rounding, independent of the programs that are judged: Newton's method on Alart and Curnier's
function from an approximate solution, with r and the function in long double and the linear systems in double."""

import numpy as np

import measure


def _function(problem, w, reaction, motion):
    """Returns the values per point and row, and the data of the Jacobian: pressed, slipping, direction and length of
    the predictor."""
    shape = (problem.points, problem.dimension)
    r, u = reaction.reshape(shape), motion.reshape(shape)
    normal = w * r[:, 0] - u[:, 0]
    pressed = normal > 0
    limit = problem.coefficient * np.where(pressed, normal, 0)
    predictor = w[:, None] * r[:, 1:] - u[:, 1:]
    length = np.sqrt((predictor**2).sum(axis=1))
    slipping = pressed & (length > limit)
    direction = np.divide(predictor, length[:, None], out=np.zeros_like(predictor), where=length[:, None] > 0)
    value = np.empty(shape, dtype=np.longdouble)
    value[:, 0] = np.where(pressed, u[:, 0], w * r[:, 0])
    friction = np.where((length > limit)[:, None], limit[:, None] * direction, predictor)
    value[:, 1:] = w[:, None] * r[:, 1:] - friction
    return value, pressed, slipping, direction, length, limit


def _step(problem, w, reaction, parts):
    """Returns Newton's correction. Open points have r = 0 exactly; the equations of the others are solved."""
    value, pressed, slipping, direction, length, limit = parts
    dimension = problem.dimension
    frictional = pressed & (problem.coefficient > 0)
    rows = np.zeros((problem.points, dimension), dtype=bool)
    rows[:, 0] = pressed
    rows[:, 1:] = frictional[:, None]
    active = np.flatnonzero(rows.reshape(-1))
    delta = np.zeros(problem.offset.size, dtype=np.longdouble)
    inactive = np.setdiff1d(np.arange(problem.offset.size), active)
    delta[inactive] = -reaction[inactive]
    right = -value.reshape(-1)
    # Rows of the Jacobian, D_r + D_u W, with blocks per point.
    of_reaction = np.zeros((problem.points, dimension, dimension))
    of_motion = np.zeros((problem.points, dimension, dimension))
    of_motion[:, 0, 0] = 1.0
    identity = np.eye(dimension - 1)
    stick = frictional & ~slipping
    of_motion[stick, 1:, 1:] = identity
    for i in np.flatnonzero(slipping & frictional):
        d = direction[i].astype(float)
        turn = float(limit[i] / length[i]) * (identity - np.outer(d, d))
        of_reaction[i, 1:, 1:] = float(w[i]) * (identity - turn)
        of_motion[i, 1:, 1:] = turn
        of_reaction[i, 1:, 0] = -problem.coefficient[i] * float(w[i]) * d
        of_motion[i, 1:, 0] = problem.coefficient[i] * d
    operator = problem.operator.reshape(problem.points, dimension, -1)
    jacobian = np.einsum("pij,pjc->pic", of_motion, operator).reshape(problem.offset.size, -1)
    for i in np.flatnonzero(frictional | pressed):
        block = slice(i * dimension, (i + 1) * dimension)
        jacobian[block, block] += of_reaction[i]
    known = right[active] - jacobian[np.ix_(active, inactive)].astype(np.longdouble) @ delta[inactive]
    delta[active] = np.linalg.solve(jacobian[np.ix_(active, active)], known.astype(float))
    return delta


def solve(problem, start, steps=30):
    """Returns r in long double and its residual; None if Newton's method does not reduce the initial residual."""
    judge = measure.Measure(problem)
    w = judge.weights.astype(np.longdouble)
    reaction = np.array(start, dtype=np.longdouble)
    best, best_residual = reaction.copy(), judge.residual(reaction)
    worse = 0
    for _ in range(steps):
        parts = _function(problem, w, reaction, judge.motion(reaction))
        try:
            reaction = reaction + _step(problem, w, reaction, parts)
        except np.linalg.LinAlgError:
            break
        residual = judge.residual(reaction)
        if residual < 0.5 * best_residual:
            best, best_residual, worse = reaction.copy(), residual, 0
        else:
            if residual < best_residual:
                best, best_residual = reaction.copy(), residual
            worse += 1
            if worse > 2:
                break
        if best_residual < 1e-18:
            break
    return best, best_residual
