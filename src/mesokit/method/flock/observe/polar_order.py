"""Polar order: how far birds fly the same way, its fluctuations, and the mean direction."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.method.flock.expected import polar_order
from mesokit.method.flock.observe.protocol import FlockObservable
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks, TimeSeries

if TYPE_CHECKING:
    from mesokit.method.flock.engine.flocks import Flocks


@component
class PolarOrder(FlockObservable):
    """Polar order phi, the length of the mean heading of all birds, in time.

    Beside its mean are the mean of its square, the Binder cumulant 1 - <phi^4>/(3 <phi^2>^2) and
    the susceptibility N (<phi^2> - <phi>^2).
    """

    quantity: Literal["polar-order"] = tag("polar-order")


@accumulator_of(PolarOrder)
class PolarOrderAccumulator(BlockAccumulator):
    """Powers of the order, and a time series of it and of the mean heading."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series")

    def __init__(self, observable: PolarOrder, case: Case) -> None:
        self.case, self.name = case, observable.label
        self.blocks, self.series = Blocks(3), TimeSeries(1 + case.box.dimension)

    def observe(self, engine: Flocks) -> None:
        mean = engine.headings().mean(axis=0)
        order = float(np.linalg.norm(mean))
        self.blocks.add([order, order**2, order**4])
        self.series.add(engine.time, [order, *mean])

    def result(self) -> Result:
        """The order in time, whose points are no means of their own: the error is nan."""
        rows = self.series.values()
        found = self.comparisons() if self.blocks.count else []
        level = found[0].expected if found else math.nan
        return Result(
            quantity="polar-order",
            drawing="order",
            name=self.name,
            x={"time": self.series.time()},
            value=rows[:, 0],
            error=np.full(len(rows), np.nan),
            label="polar order",
            units={"value": "", "time": "tau"},
            expected=None if math.isnan(level) else np.full(len(rows), level),
            theory="" if math.isnan(level) else polar_order(self.case).note,
            comparisons=tuple(found),
            samples=self.blocks.count,
            extra={
                "heading": rows[:, 1:],
                "mean": found[0].measured if found else math.nan,
                "mean_error": found[0].error if found else math.nan,
            },
        )

    def comparisons(self) -> list[Comparison]:
        """Mean, mean square, Binder cumulant and susceptibility."""
        number = self.case.particles
        means = of_mean(self.blocks)
        order, square, fourth = map(float, means.value)
        cumulant = 1 - fourth / (3 * square**2) if square > 0 else math.nan
        slope = np.array([0.0, 2 * fourth / (3 * square**3), -1 / (3 * square**2)])
        known = polar_order(self.case)
        note = known.note
        one = np.eye(3)
        return [
            Comparison("mean polar order", *means.scalar(order, one[0]), known.order, "", note),
            Comparison(
                "mean square polar order", *means.scalar(square, one[1]), known.square, "", note
            ),
            Comparison("Binder cumulant", *means.scalar(cumulant, slope), known.cumulant, "", note),
            Comparison(
                "susceptibility",
                *means.scalar(
                    number * (square - order**2), number * np.array([-2 * order, 1.0, 0])
                ),
                note=f"number of birds times the variance of the order, {number} birds",
            ),
        ]
