"""What observables remember that keep each sample: a series in time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.observable import State, pack, unpack
from mesokit.statistics import TimeSeries


class Samples:
    """Rows of so many numbers in time, and how many samples were taken."""

    def __init__(self, width: int) -> None:
        self.series, self.samples = TimeSeries(width), 0

    def state(self) -> State:
        """All it has to remember."""
        return pack(series=self.series, samples=np.array(self.samples))

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.series = TimeSeries.from_state(unpack(state, "series"))
        self.samples = int(state["samples"])

    def pool(self, other: Self) -> None:
        """Take in an independent run of the same case, only to read: the series becomes a mean."""
        self.series.pool(other.series)
        self.samples += other.samples
