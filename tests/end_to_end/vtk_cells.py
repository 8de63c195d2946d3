"""Volumes of cells from their nodes in VTK's order, by the shape functions that this order implies: independent of
Ricochet, and wrong as soon as two nodes are exchanged."""

import itertools

import numpy

# For each type of meshio: the vertices of the reference cell, then the vertices between which each further node lies.
TRIANGLE = [(0, 0), (1, 0), (0, 1)]
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
SQUARE_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]
CUBE_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
CUBE_FACES = [(0, 3, 4, 7), (1, 2, 5, 6), (0, 1, 4, 5), (2, 3, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7)]
CELLS = {
    "triangle": (TRIANGLE, []),
    "triangle6": (TRIANGLE, [(0, 1), (1, 2), (2, 0)]),
    "quad": (SQUARE, []),
    "quad9": (SQUARE, SQUARE_EDGES + [(0, 1, 2, 3)]),
    "tetra": (TETRAHEDRON, []),
    "tetra10": (TETRAHEDRON, [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]),
    "hexahedron": (CUBE, []),
    "hexahedron27": (CUBE, CUBE_EDGES + CUBE_FACES + [tuple(range(8))]),
}


def middles(kind):
    return CELLS[kind][1]


def reference_nodes(kind):
    vertices, further = CELLS[kind]
    vertices = numpy.array(vertices, dtype=float)
    return numpy.vstack([vertices] + [vertices[list(between)].mean(axis=0) for between in further])


def is_simplex(kind):
    return kind.startswith(("tri", "tet"))


def exponents(kind):
    dimension = len(CELLS[kind][0][0])
    degree = 2 if CELLS[kind][1] else 1
    every = itertools.product(range(degree + 1), repeat=dimension)
    return [powers for powers in every if not is_simplex(kind) or sum(powers) <= degree]


def quadrature(kind):
    """Returns Gauss points on the cube, collapsed onto the simplex if there is one."""
    dimension = len(CELLS[kind][0][0])
    points, weights = numpy.polynomial.legendre.leggauss(5)
    points, weights = (points + 1) / 2, weights / 2
    for at in itertools.product(range(5), repeat=dimension):
        x, weight = points[list(at)].copy(), weights[list(at)].prod()
        if is_simplex(kind):
            remaining = 1.0
            for k in range(dimension):
                weight *= remaining ** (1 if k > 0 else 0)
                x[k] *= remaining
                remaining -= x[k]
        yield x, weight


def gradients(powers, x):
    """Returns the gradients of the monomials with these exponents at a point: monomials × dimension."""
    result = numpy.empty((len(powers), len(x)))
    for i, power in enumerate(powers):
        for k, n in enumerate(power):
            others = numpy.prod([x[j]**m for j, m in enumerate(power) if j != k])
            result[i, k] = n * x[k]**(n - 1) * others if n > 0 else 0.0
    return result


def volumes(kind, nodes, cells):
    """Returns the volume of each cell, and the smallest determinant of its map at any quadrature point."""
    powers = exponents(kind)
    reference = reference_nodes(kind)
    vandermonde = numpy.array([[numpy.prod(x**power) for power in numpy.array(powers)] for x in reference])
    to_shape = numpy.linalg.inv(vandermonde)  # monomials × nodes
    at_nodes = nodes[cells][:, :, :reference.shape[1]]
    volume = numpy.zeros(len(cells))
    smallest = numpy.full(len(cells), numpy.inf)
    for x, weight in quadrature(kind):
        shape_gradients = to_shape.T @ gradients(powers, x)  # nodes × dimension
        determinant = numpy.linalg.det(numpy.einsum("cnd,ne->cde", at_nodes, shape_gradients))
        volume += weight * determinant
        smallest = numpy.minimum(smallest, determinant)
    return volume, smallest
