"""Conversion of sparse matrices between scipy and the library, whose matrices are symmetric, in compressed columns."""

import numpy

from .errors import InputError


def csc(parts):
    """Returns a scipy.sparse.csc_matrix of the library's numbers, without copies."""
    from scipy.sparse import csc_matrix

    data, indices, starts, size = parts
    return csc_matrix((data, indices, starts), shape=(size, size), copy=False)


def parts(matrix, name):
    """Returns (data, indices, indptr, size) of a symmetric scipy matrix. Raises InputError if it is not square or symmetric."""
    matrix = matrix.tocsc(copy=True)
    matrix.sum_duplicates()
    matrix.sort_indices()
    if matrix.dtype.kind not in "biuf":
        raise InputError(f"{name}: real numbers are required, not {matrix.dtype}")
    if matrix.shape[0] != matrix.shape[1]:
        raise InputError(f"{name} must be a square matrix, not one of {matrix.shape[0]} x {matrix.shape[1]}")
    if matrix.nnz > numpy.iinfo(numpy.int32).max:
        raise InputError(f"{name} has {matrix.nnz} entries; at most {numpy.iinfo(numpy.int32).max} are supported")
    require_symmetry(abs(matrix - matrix.T).max() if matrix.nnz else 0.0, abs(matrix).max() if matrix.nnz else 0.0, name)
    return matrix.data, matrix.indices, matrix.indptr, matrix.shape[0]


def require_symmetry(difference, largest, name):
    """Raises InputError if a matrix is not symmetric up to rounding, since the library would solve another problem."""
    if difference > 1e-10 * largest:
        raise InputError(f"{name} is not symmetric: entries differ from those across the diagonal by up to {difference:.3g}; the "
                         f"largest entry is {largest:.3g}")


def is_sparse(matrix):
    return hasattr(matrix, "tocsc")
