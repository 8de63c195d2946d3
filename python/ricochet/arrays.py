"""Arrays of what callers give. What is no number is refused by name: numpy would make one of None, masks and complex numbers."""

from numbers import Real

import numpy

from .errors import InputError


def _array(values, what):
    try:
        array = numpy.asarray(values)
    except (TypeError, ValueError, OverflowError) as problem:
        raise InputError(f"{what}: this is no array: {problem}") from None
    if numpy.ma.is_masked(values):
        raise InputError(f"{what}: some numbers are masked; fill them in, or leave them out")
    return array


def numbers(values, what):
    """As floats."""
    array = _array(values, what)
    if array.dtype.kind not in "biuf" and not (array.dtype.kind == "O" and all(isinstance(one, Real) for one in array.flat)):
        raise InputError(f"{what}: real numbers are needed, not {array.dtype}")
    try:
        return array.astype(float, copy=False)
    except (TypeError, ValueError, OverflowError) as problem:
        raise InputError(f"{what}: {problem}") from None


def whole_numbers(values, what, counted):
    """As a copy. `counted`: what they are numbers of."""
    array = _array(values, what)
    if array.size == 0:
        return numpy.zeros(array.shape, dtype=numpy.int64)
    if array.dtype.kind == "b":
        raise InputError(f"{what}: numbers of {counted} are whole numbers, not bool; numpy.flatnonzero(mask) has those of a mask")
    if array.dtype.kind not in "iu":
        raise InputError(f"{what}: numbers of {counted} are whole numbers, not {array.dtype}")
    return numpy.array(array)
