"""A force that is switched, ramped, or follows a table in time."""

from __future__ import annotations

import functools
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.method.mpcd.field.varying import Varying, factor
from mesokit.scalar.intrinsics import mul_add
from mesokit.scalar.pointer import address, real


@component
class ScheduledForce(Varying):
    """Another force times a factor that is linear between times, and constant before and after.

    Times count from the start of the warm-up. A time that is given twice is a step: the second of
    its factors holds from then on. Two times are a ramp.

    >>> from mesokit import Uniform
    >>> pulse = ScheduledForce(Uniform([0.1, 0]), times=[5, 5, 9, 9], factors=[0, 1, 1, 0])
    >>> [float(pulse.at(t)) for t in (4.9, 5.0, 7.0, 9.0)]
    [0.0, 1.0, 1.0, 0.0]
    """

    rule: Literal["scheduled"] = tag("scheduled")
    times: Many[float] = param(doc="in order", unit="time", min_length=1, max_length=100_000)
    factors: Many[float] = param(doc="of the force, one for each time", min_length=1)

    def __post_init__(self) -> None:
        if len(self.factors) != len(self.times):
            raise ValueError(
                f"factors: {len(self.factors)} numbers; expected {len(self.times)}, one for each "
                "of times"
            )
        if any(b < a for a, b in zip(self.times, self.times[1:], strict=False)):
            raise ValueError(f"times = {show(list(self.times))}: expected times in order")

    @property
    def most(self) -> float:
        return max(abs(value) for value in self.factors)

    @functools.cached_property
    def _table(self) -> NDArray[Any]:
        return np.ascontiguousarray([self.times, self.factors], float)  # known by its address

    def at(self, time: float) -> float:
        times, factors = self._table
        after = int(np.searchsorted(times, time, "right"))
        if after in (0, len(times)):
            return float(factors[min(after, len(times) - 1)])
        share = (time - times[after - 1]) / (times[after] - times[after - 1])
        return float(factors[after - 1] + share * (factors[after] - factors[after - 1]))

    def change(self) -> Points:
        """Parameters for the scalar function below; the force keeps the table alive."""
        return Points(address(self._table), len(self.times))


class Points(NamedTuple):
    """Where the table is, times first and then factors, and how many of each."""

    table: int
    number: int


@factor.register(Points)
def _(change, time):
    low, high = 0, change.number  # the first point after the time is from low to high
    while low < high:
        middle = (low + high) // 2
        if real(change.table, middle) <= time:
            low = middle + 1
        else:
            high = middle
    after = min(low, change.number - 1)
    before = max(low - 1, 0)
    start, end = real(change.table, before), real(change.table, after)
    first = real(change.table, change.number + before)
    last = real(change.table, change.number + after)
    share = (time - start) / (end - start) if end > start else 0.0
    return mul_add(share, last - first, first)
