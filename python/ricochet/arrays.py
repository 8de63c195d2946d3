"""Conversion of arguments to arrays. Values that are not real numbers cause an error that names the argument; numpy would convert
None, masks and complex numbers."""

from numbers import Real

import numpy

from .errors import InputError


def _array(values, what):
    try:
        array = numpy.asarray(values)
    except (TypeError, ValueError, OverflowError) as problem:
        raise InputError(f"{what}: the values do not form an array: {problem}") from None
    if numpy.ma.is_masked(values):
        raise InputError(f"{what}: some numbers are masked; fill them in or leave them out")
    return array


def numbers(values, what):
    """Returns values as an array of floats."""
    array = _array(values, what)
    if array.dtype.kind not in "biuf" and not (array.dtype.kind == "O" and all(isinstance(one, Real) for one in array.flat)):
        raise InputError(f"{what}: real numbers are required, not {array.dtype}")
    try:
        return array.astype(float, copy=False)
    except (TypeError, ValueError, OverflowError) as problem:
        raise InputError(f"{what}: {problem}") from None


def whole_numbers(values, what, counted):
    """Returns a copy of the values as an array of integers. `counted`: name of the things that they number, for messages."""
    array = _array(values, what)
    if array.size == 0:
        return numpy.zeros(array.shape, dtype=numpy.int64)
    if array.dtype.kind == "b":
        raise InputError(f"{what}: numbers of {counted} must be integers, not bool; convert a mask with numpy.flatnonzero(mask)")
    if array.dtype.kind not in "iu":
        raise InputError(f"{what}: numbers of {counted} must be integers, not {array.dtype}")
    return numpy.array(array)
