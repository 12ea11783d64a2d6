"""Polar order: how far birds fly the same way, its fluctuations, and the mean direction."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.component import component, tag
from mesokit.method.flock.expected import KnownOrder, polar_order
from mesokit.method.flock.observe.protocol import FlockObservable, RunningFlock
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks, TimeSeries


@component
class PolarOrder(FlockObservable):
    """Polar order phi, the length of the mean heading of all birds, in time.

    Beside its mean are the mean of its square, the Binder cumulant 1 - <phi^4>/(3 <phi^2>^2) and
    the susceptibility N (<phi^2> - <phi>^2).
    """

    quantity: Literal["polar-order"] = tag("polar-order")
    drawing, value_label = "order", "polar order"
    units: ClassVar[dict[str, str]] = {"time": "tau"}


@accumulator_of(PolarOrder)
class PolarOrderAccumulator(BlockAccumulator):
    """Powers of the order, and a time series of it and of the mean heading."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series")

    def prepare(self) -> None:
        self.blocks, self.series = Blocks(3), TimeSeries(1 + self.case.box.dimension)

    def observe(self, engine: RunningFlock) -> None:
        mean = engine.headings().mean(axis=0)
        order = float(np.linalg.norm(mean))
        self.blocks.add([order, order**2, order**4])
        self.series.add(engine.time, [order, *mean])

    def result(self) -> Result:
        """The order in time, whose points are no means of their own: the error is nan."""
        rows, known = self.series.values(), polar_order(self.case)
        found = list(self.comparisons(known)) if self.blocks.count else []
        theory = not math.isnan(known.order) and self.blocks.count > 0
        return self.report(
            {"time": self.series.time()},
            rows[:, 0],
            found,
            expected=np.full(len(rows), known.order) if theory else None,
            theory=known.note if theory else "",
            extra={
                "heading": rows[:, 1:],
                "mean": found[0].measured if found else math.nan,
                "mean_error": found[0].error if found else math.nan,
            },
        )

    def comparisons(self, known: KnownOrder) -> Iterator[Comparison]:
        """Mean, mean square, Binder cumulant and susceptibility."""
        number, means, note = self.case.particles, of_mean(self.blocks), known.note
        order, square, fourth = map(float, means.value)
        first, second, _ = np.eye(3)
        measured = means.scalar(order, first)
        yield Comparison("mean polar order", *measured, known.order, "", note)
        measured = means.scalar(square, second)
        yield Comparison("mean square polar order", *measured, known.square, "", note)
        cumulant = 1 - fourth / (3 * square**2) if square > 0 else math.nan
        slope = np.array([0.0, 2 * fourth / (3 * square**3), -1 / (3 * square**2)])
        measured = means.scalar(cumulant, slope)
        yield Comparison("Binder cumulant", *measured, known.cumulant, "", note)
        slope = number * np.array([-2 * order, 1.0, 0])
        measured = means.scalar(number * (square - order**2), slope)
        note = f"number of birds times the variance of the order, {number} birds"
        yield Comparison("susceptibility", *measured, note=note)
