"""Vectors of 2 or 3 numbers in a row of parameters that keeps room for 3."""

import math

from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import elementwise, scalar
from mesokit.scalar.pointer import real  # noqa: F401  the text of functions below uses it
from mesokit.scalar.vector import dot, scaled


@elementwise
def offset(p, r):
    """r relative to the place that the first numbers give."""
    return "r[{k}] - real(p, {k})"


@elementwise
def vector(p, start, like):
    """Numbers from `start`, as many as `like` has."""
    return "real(p, start + {k})"


@scalar
def length(a):
    """Length of a vector."""
    return math.sqrt(dot(a, a))


@scalar
def unit(a):
    """The vector of length 1; the first axis where there is no direction."""
    size = length(a)
    if size < 1e-300:
        return with_item(scaled(0.0, a), 0, 1.0)
    return scaled(1.0 / size, a)
