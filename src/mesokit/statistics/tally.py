"""Sums of whole numbers over a whole run, exact whatever their size."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Integers = NDArray[np.int64]
BITS = 32  # of the lower part


class Tally:
    """Sums of whole numbers, each as a higher and a lower part, and how many make one unit.

    >>> tally = Tally((2,), unit=4.0)
    >>> for _ in range(3):
    ...     tally.add(np.array([2**62, -2]))
    >>> tally.value
    array([ 3.45876451e+18, -1.50000000e+00])
    >>> earlier = tally.copy()
    >>> tally.add(np.array([1, 1]))
    >>> tally.since(earlier)
    array([0.25, 0.25])
    """

    def __init__(self, shape: tuple[int, ...], unit: float) -> None:
        self.unit = unit
        self.high: Integers = np.zeros(shape, np.int64)
        self.low: Integers = np.zeros(shape, np.int64)

    def add(self, counts: Integers) -> None:
        """Add whole numbers."""
        low = self.low + (counts & (2**BITS - 1))
        self.high = self.high + (counts >> BITS) + (low >> BITS)
        self.low = low & (2**BITS - 1)

    def copy(self) -> Tally:
        """The sums so far."""
        copy = Tally(self.high.shape, self.unit)
        copy.high, copy.low = self.high.copy(), self.low.copy()
        return copy

    @property
    def value(self) -> NDArray[np.float64]:
        """The sums, in units."""
        return np.asarray((self.high * 2.0**BITS + self.low) / self.unit)

    def since(self, earlier: Tally) -> NDArray[np.float64]:
        """The sum since then, in units: exact before it is rounded to a float."""
        added = (self.high - earlier.high) * 2**BITS + (self.low - earlier.low)
        return added.astype(float) / self.unit

    def state(self) -> dict[str, NDArray[Any]]:
        """The sums as arrays."""
        return {"high": self.high, "low": self.low}

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        for name in ("high", "low"):
            getattr(self, name)[...] = state[name]
