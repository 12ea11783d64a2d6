"""Polar and nematic order of many bodies: how far their axes lie the same way, in time."""

import math
from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected.bodies import KIND_OF_BODY, followed
from mesokit.observe.shared.short_run import ENOUGH, of_relaxations
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined
from mesokit.statistics import Blocks, TimeSeries

ORDERS = ("polar", "nematic")
TURNS = "times in which a direction is forgotten"


@component
class BodyOrder(Observable):
    """Polar and nematic order of the axes x of bodies, in time, and their means.

    The polar order is the length of the mean direction. The nematic one S is the root of the mean
    over all pairs of (d cos^2 - 1)/(d - 1) of the angle between their axes, each with itself
    included: 1 where all axes are parallel, whichever end is in front. N bodies in independent
    directions have a mean square of 1/N, of both.
    """

    quantity: Literal["body-order"] = tag("body-order")
    drawing, value_label = "order", "order"
    units: ClassVar[dict[str, str]] = {"time": "tau", "order": ""}
    kind: int | str = param(1, doc=KIND_OF_BODY)

    def check(self, case: Case) -> None:
        """Raise CaseError without such bodies."""
        followed(case, self.quantity, self.kind)


def squares_of_order(headings: Array) -> tuple[float, float]:
    """Squares of the polar and of the nematic order of unit vectors (n, d).

    >>> squares_of_order(np.array([[1.0, 0.0], [-1.0, 0.0]]))
    (0.0, 1.0)
    >>> polar, nematic = squares_of_order(np.eye(3))  # along three axes
    >>> f"{polar:.3f}, {nematic:.3f}"
    '0.333, 0.000'
    """
    d, mean = headings.shape[1], headings.mean(axis=0)
    tensor = np.einsum("ni,nj->ij", headings, headings) / len(headings)
    return float(mean @ mean), max(0.0, float((d * (tensor**2).sum() - 1) / (d - 1)))


@accumulator_of(BodyOrder)
class BodyOrderAccumulator(BlockAccumulator):
    """Orders and their squares, series of them and of the mean direction, and the angles at the
    first and at the last sample."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series", "begun", "ended")

    def prepare(self) -> None:
        self.of = followed(self.case, self.observable.quantity, self.observable.kind)
        self.blocks, self.series = Blocks(4), TimeSeries(2 + self.case.box.dimension)
        self.begun = np.zeros((self.of.number, 3))
        self.ended = np.zeros((self.of.number, 3))

    def observe(self, fluid: Any) -> None:
        headings, angles = fluid.bodies.headings[self.of.rows], fluid.bodies.angles[self.of.rows]
        if not self.blocks.count:
            self.begun = angles
        self.ended = angles
        squares = squares_of_order(headings)
        orders = [math.sqrt(square) for square in squares]
        self.blocks.add([*orders, *squares])
        self.series.add(fluid.time, [*orders, *headings.mean(axis=0)])

    def result(self) -> Result:
        """The orders in time, whose points are no means of their own: the error is nan."""
        rows, mean, error = self.series.values(), self.blocks.mean(), self.blocks.error()
        return self.report(
            {"time": self.series.time(), "order": ORDERS},
            rows[:, :2],
            self.comparisons(),
            label=f"order of {self.of.name}",
            extra={
                "heading": rows[:, 2:],
                "mean": mean[:2] if self.blocks.count else np.full(2, np.nan),
                "mean_error": error[:2] if self.blocks.count else np.full(2, np.nan),
            },
        )

    def comparisons(self) -> Iterator[Comparison]:
        """Means, and mean squares beside those of independent directions."""
        mean, error, known = self.blocks.mean(), self.blocks.error(), self.independent
        short = self.short_run() if known else ""
        for k, name in enumerate(ORDERS):
            yield Comparison(f"mean {name} order", mean[k], error[k], note=short)
        expected = 1 / self.of.number if known else np.nan
        for k, name in enumerate(ORDERS, start=2):
            what = f"mean square {name} order"
            note = joined("independent directions" if known else "", short)
            yield Comparison(what, mean[k], error[k], expected, note=note)

    @property
    def independent(self) -> bool:
        """Whether directions are, in equilibrium: those of disks or spheres that turn freely."""
        return self.of.thermal and self.of.any_direction

    def short_run(self) -> str:
        """A note on a run in which directions are forgotten a few times only."""
        d, axes = self.case.box.dimension, max(len(self.of.turning), 1)
        angles = (self.ended - self.begun)[:, list(self.of.turning)]
        times = (d - 1) * float((angles**2).sum(axis=1).mean()) / (2 * axes)
        return of_relaxations(times, self.blocks.series, TURNS) if times < ENOUGH else ""
