"""Sums in bins of what many have a part of: exact, so that their bits do not depend on the order.

Each term is rounded to whole quanta, 2^-52 of a unit that it is given, and these are cut into limbs
of 32 bits with the sign of the term. Of terms up to 2^44 units there are three limbs; what is more,
or no number, is counted by itself, and the sum is then nan.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.kernel import kernel
from mesokit.scalar.fixed_point import ROUNDER

QUANTA = 52  # bits of a unit: as fine as a number of its size is
LIMB, LIMBS = 32, 3
# Terms after which limbs are carried: 2^20 2^32, and then 2^32 of each of up to 2^30 ranks, are far
# from 2^63, as is the highest limb, which is as large as the sum over 2^12 units.
AT_ONCE = 2**20
MOST = 2.0 ** (LIMB * LIMBS)

Integers = NDArray[np.int64]
Floats = NDArray[np.float64]


class BinSums:
    """Sums (len(units), bins) of terms, each of about the size of its unit.

    >>> sums = BinSums(2, [1.0])
    >>> sums.add(np.array([0, 1, 0, 0]), [np.array([1e-9, -0.25, 1e13, -1e13])])
    >>> sums.values().tolist()
    [[1.000000082740371e-09, -0.25]]
    """

    def __init__(self, bins: int, units: Sequence[float]) -> None:
        self.bins = bins
        self.scales = [2.0 ** (QUANTA - math.ceil(math.log2(unit))) for unit in units]
        self.limbs = np.zeros((LIMBS + 1, len(units), bins), np.int64)  # the last: beyond all

    def add(self, place: NDArray[Any], terms: Sequence[NDArray[Any]]) -> None:
        """Add terms (m,) of each kind, in these bins (m,)."""
        where = np.ascontiguousarray(place, np.int64)
        for start in range(0, len(where), AT_ONCE):
            lot = slice(start, start + AT_ONCE)
            for k, (term, scale) in enumerate(zip(terms, self.scales, strict=True)):
                terms_of_lot = np.ascontiguousarray(term[lot], float)
                add_limbs(where[lot], terms_of_lot, scale, self.limbs[:, k])
            carry(self.limbs)

    def values(self, reduced: Callable[[Integers], Integers] = np.copy) -> Floats:
        """The sums, of all whose limbs `reduced` adds up."""
        limbs = reduced(self.limbs)
        carry(limbs)
        total = np.zeros(limbs.shape[1:])
        for limb in reversed(range(LIMBS)):
            total = total * 2.0**LIMB + limbs[limb]
        total /= np.array(self.scales)[:, None]
        return np.where(limbs[LIMBS] == 0, total, np.nan)


def carry(limbs: Integers) -> None:
    """All limbs but the highest become 0 to 2^32: the same for the same sum, however it came."""
    for limb in range(LIMBS - 1):
        limbs[limb + 1] += limbs[limb] >> LIMB
        limbs[limb] &= 2**LIMB - 1


@kernel
def add_limbs(place, terms, scale, limbs):
    """Add the limbs of each term to those of its bin (LIMBS + 1, bins)."""
    for i in range(len(place)):
        quanta, to = terms[i] * scale, place[i]
        if not abs(quanta) < MOST:  # as what is no number
            limbs[LIMBS, to] += 1
            continue
        for limb in range(LIMBS - 1, 0, -1):
            size = 2.0 ** (LIMB * limb)
            part = np.int64(quanta / size)
            limbs[limb, to] += part
            quanta -= part * size
        limbs[0, to] += np.int64(quanta + ROUNDER - ROUNDER)
