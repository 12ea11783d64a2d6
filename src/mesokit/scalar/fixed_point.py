"""Fixed-point numbers: integer sums do not depend on the order of the terms.

Adding 1.5 * 2^52 leaves the rounded number in the low bits of the mantissa; the constant's own
bits, once for each term, are taken off when the sum is read.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.scalar.elementary import rint
from mesokit.scalar.intrinsics import mul_add
from mesokit.scalar.jit import elementwise, scalar

ROUNDER = 1.5 * 2.0**52
ROUNDER_BITS = int(np.float64(ROUNDER).view(np.int64))


@scalar
def fixed(x, scale):
    """x * scale rounded to a whole number, plus ROUNDER_BITS, as int64."""
    return np.float64(mul_add(x, scale, ROUNDER)).view(np.int64)


@scalar
def quanta(x, scale):
    """x * scale rounded to a whole number, as int64: for any number below 2^63, and slower."""
    return np.int64(rint(x * scale))


@scalar
def from_fixed(total, terms, scale):
    """A sum of `terms` fixed-point numbers as a float."""
    return float(total - np.int64(terms) * ROUNDER_BITS) * (1.0 / scale)


@elementwise
def rounded(terms, scales):
    """Each term as a fixed-point number."""
    return "fixed(terms[{k}], scales[{k}])"


@elementwise
def integers(values):
    """A tuple of int64 zeros as long as `values`."""
    return "np.int64(0)"


def total(rows: NDArray[np.int64], scale: Any) -> NDArray[np.float64]:
    """Sums over the rows (n, ...) of whole numbers, exact whatever their size, over the scale."""
    high, low = (rows >> 32).sum(axis=0), (rows & 0xFFFFFFFF).sum(axis=0)
    exact = high.astype(object) * 2**32 + low
    return np.asarray(exact / scale, float)
