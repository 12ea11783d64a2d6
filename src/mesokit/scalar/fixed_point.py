"""Fixed-point numbers: integer sums do not depend on the order of the terms.

Adding 1.5 * 2^52 leaves the rounded number in the low bits of the mantissa; the constant's own
bits, once for each term, are taken off when the sum is read.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.scalar.intrinsics import mul_add
from mesokit.scalar.jit import elementwise, for_each, scalar

ROUNDER = 1.5 * 2.0**52
HALF, LOW = 32, 2**32 - 1  # bits: what is added up apart, so that nothing overflows
ROUNDER_BITS = int(np.float64(ROUNDER).view(np.int64))


@scalar
def fixed(x, scale):
    """x * scale rounded to a whole number, plus ROUNDER_BITS, as int64."""
    return bits(mul_add(x, scale, ROUNDER))


@scalar
def quanta(x, scale):
    """x * scale rounded to a whole number, as int64: for any number below 2^63.

    In two parts, which vectors of numbers can be rounded by as well: they have no conversion to
    whole numbers.
    """
    whole = x * scale
    high = whole * 2.0**-32 + ROUNDER
    low = whole - (high - ROUNDER) * 2.0**32 + ROUNDER
    return ((bits(high) - ROUNDER_BITS) << 32) + bits(low) - ROUNDER_BITS


@scalar
def bits(x):
    """The bits of a number as int64."""
    return np.float64(x).view(np.int64)


@scalar
def from_fixed(total, terms, scale):
    """A sum of `terms` fixed-point numbers as a float."""
    return float(total - np.int64(terms) * ROUNDER_BITS) * (1.0 / scale)


@scalar
def from_bits(x):
    """The number with these bits."""
    return np.int64(x).view(np.float64)


@elementwise
def rounded(terms, scales):
    """Each term as a fixed-point number."""
    return "fixed(terms[{k}], scales[{k}])"


@elementwise
def added_fixed(values, scale, sums):
    """Sums to which each of the values is added as a fixed-point number."""
    return "sums[{k}] + fixed(values[{k}], scale)"


@elementwise
def added_quanta(values, scale, sums):
    """Sums to which each of the values is added, in whole numbers."""
    return "sums[{k}] + quanta(values[{k}], scale)"


@elementwise
def integers(values):
    """A tuple of int64 zeros as long as `values`."""
    return "np.int64(0)"


@elementwise
def opposite(a):
    """The opposite of a vector of whole numbers."""
    return "-a[{k}]"


@elementwise
def floats(a):
    """A vector of whole numbers as floats."""
    return "float(a[{k}])"


@for_each
def add_fixed(array, terms, sums):
    """Add sums of so many fixed-point numbers to an array, as whole numbers."""
    return "array[{k}] += sums[{k}] - np.int64(terms) * ROUNDER_BITS"


@for_each
def add_quanta(array, scale, values):
    """Add each of the values to an array, in whole numbers."""
    return "array[{k}] += quanta(values[{k}], scale)"


@for_each
def add_integers(array, values):
    """Add each of the values to the element in its place."""
    return "array[{k}] += values[{k}]"


def total(rows: NDArray[np.int64], scale: Any) -> NDArray[np.float64]:
    """Sums over the rows (n, ...) of whole numbers, exact whatever their size, over the scale."""
    return joined(halves(rows), scale)


def halves(rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """The same sums as high and low halves (2, ...): these may be added up and halved again."""
    low = (rows & LOW).sum(axis=0)
    return np.stack([(rows >> HALF).sum(axis=0) + (low >> HALF), low & LOW])


def added_halves(parts: NDArray[np.int64]) -> NDArray[np.int64]:
    """The sum over some halves (n, 2, ...), again as halves."""
    high, low = parts.sum(axis=0)
    return np.stack([high + (low >> HALF), low & LOW])


def joined(halves: NDArray[np.int64], scale: Any) -> NDArray[np.float64]:
    """The sums of which these are the halves, over the scale."""
    high, low = halves
    return np.asarray((high * 2.0**HALF + low) / scale)  # rounded once by the sum
