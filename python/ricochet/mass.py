"""Mass matrices without a simulation, including those without inertia on contact nodes."""

from typing import Any, NamedTuple

import numpy

from . import _core
from .arrays import numbers, whole_numbers
from .errors import InputError
from .sparse import csc, is_sparse, parts


class BuiltMass(NamedTuple):
    """A mass matrix and its construction.

    `matrix`: nodes x nodes, scipy.sparse.csc_matrix. `construction`: name of the construction used. `reason`: why it was
    chosen, if there was a choice.
    """

    matrix: Any
    construction: str
    reason: str


def names():
    """Returns the names of the mass types, for the argument `type`. Types that work cell by cell need a Session (Session.mass)."""
    return _core.mass_names()


def build(consistent, points, contact_nodes, type="equivalent", **parameters):
    """Redistributes a consistent mass matrix.

    `consistent`: the integrals of density times products of shape functions, a scipy.sparse matrix of nodes x nodes.
    `points`: nodes x dimension. `contact_nodes`: node numbers, from 0. `parameters`: keys of the type, as in a case file.
    """
    points = numbers(points, "mass: points")
    if not is_sparse(consistent):
        raise InputError(f"mass: the consistent mass must be a matrix of scipy.sparse, not a {consistent.__class__.__name__}")
    data, indices, starts, size = parts(consistent, "the consistent mass")
    if points.ndim != 2 or len(points) != size or points.shape[1] not in (2, 3):
        raise InputError(f"mass: points must be an array of {size} x 2 or 3, not of shape {points.shape}")
    nodes = numpy.unique(whole_numbers(contact_nodes, "mass: contact nodes", "nodes").reshape(-1))
    if nodes.size and (nodes[0] < 0 or nodes[-1] >= size):
        raise InputError(f"mass: contact node {nodes[-1] if nodes[0] >= 0 else nodes[0]} is not one of the {size} nodes, numbered "
                         "from 0")
    construction, reason, built = _core.build_mass(type, data, indices, starts, size, points, nodes.tolist(), parameters)
    return BuiltMass(csc(built), construction, reason)
