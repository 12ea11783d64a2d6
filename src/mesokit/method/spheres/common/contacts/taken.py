"""The forces of spheres on surfaces, in whole quanta, added up over steps without an order.

Sums grow beyond 64 bits. Each is two numbers, of which the low one has 32 bits.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.scalar.jit import scalar

LOW, HIGH, WIDTH = 0, 3, 8  # columns of a surface, of which a row is a cache line
BITS = np.int64(32)
MASK = np.int64(2**32 - 1)


@scalar
def take(taken, w, counts):
    """Add minus the force on a sphere, in quanta, to the sums of surface w."""
    for k in range(3):
        low = taken[w, LOW + k] - counts[k]
        taken[w, HIGH + k] += low >> BITS
        taken[w, LOW + k] = low & MASK


def all_taken(taken: NDArray[np.int64]) -> NDArray[np.int64]:
    """Sums of all threads, (surfaces, 8): the same however they share the spheres."""
    found = taken.sum(axis=0)
    found[:, HIGH : HIGH + 3] += found[:, LOW : LOW + 3] >> BITS
    found[:, LOW : LOW + 3] &= MASK
    return found


def in_numbers(taken: NDArray[np.int64]) -> Any:
    """Sums (surfaces, 3), in quanta."""
    return taken[:, HIGH : HIGH + 3] * 2.0**32 + taken[:, LOW : LOW + 3]
