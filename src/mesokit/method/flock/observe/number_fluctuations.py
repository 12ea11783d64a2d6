"""Fluctuations of the number of birds in a part of the box."""

import math
from collections.abc import Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Either
from mesokit.errors import CaseError
from mesokit.method.flock.expected import giant_exponent, number_exponent
from mesokit.method.flock.observe.protocol import FlockObservable, RunningFlock
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of, pack
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

LARGEST = 0.25  # side of the largest squares unless said, in the shortest length of the box
FITTED = 4  # of the largest, whose exponent is fitted
FEWEST = 3  # sides for an exponent
MOST = 2**24  # squares


@component
class NumberFluctuations(FlockObservable):
    """Standard deviation of the number of birds in squares (cubes) of several sides, over the mean.

    Without order it is the root of the mean number; in ordered flocks it grows faster: giant number
    fluctuations (Toner and Tu, Phys. Rev. Lett. 75, 4326 (1995)). The exponent is fitted to the
    four largest sides, and compared with 0.8 (2D) or 1/2 by the polar order of the same samples.
    """

    quantity: Literal["number-fluctuations"] = tag("number-fluctuations")
    among_walls: ClassVar[bool] = False
    drawing, value_label = "number fluctuations", "standard deviation of the number"
    units: ClassVar[dict[str, str]] = {"mean number": ""}
    sides: Either[None, float] = param(
        None,
        doc="sides of the squares (1, 2, 4, ... times the reach of sight, up to a quarter of the "
        "box, unless said)",
        unit="a",
        min_length=1,
    )

    def all_sides(self, case: Case) -> tuple[float, ...]:
        """From the smallest to the largest."""
        if self.sides is not None:
            return tuple(sorted(float(side) for side in self.sides))
        shortest, reach = min(case.box.size), case.flock.radius
        unit, most = reach if reach <= shortest else LARGEST * shortest, LARGEST * shortest
        return tuple(unit * 2.0**k for k in range(int(math.log2(max(most / unit, 1.0))) + 1))

    def check(self, case: Case) -> None:
        """Raise CaseError among walls, and for sides that are longer than the box."""
        super().check(case)
        sides = self.all_sides(case)
        if self.sides is not None:
            least, most = 1e-6 * min(case.box.size), float(min(case.box.size))
            if not least <= sides[0] <= sides[-1] <= most:
                raise CaseError(f"sides = {list(sides)}: expected from {least:.4g} to {most:.4g}")
            if len(set(sides)) < len(sides):
                raise CaseError(f"sides = {list(sides)}: expected each once")
        number = math.prod(int(length / sides[0]) for length in case.box.size)
        if number > MOST:
            raise CaseError(
                f"sides = {show(list(sides))}: {number} squares; expected at most {MOST}"
            )


@accumulator_of(NumberFluctuations)
class NumberFluctuationsAccumulator(BlockAccumulator):
    """Block averages of the variances, about the mean that is known, and of the polar order."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "order")

    def prepare(self) -> None:
        self.sides = self.observable.all_sides(self.case)
        self.size = np.array(self.case.box.size, float)
        sides, d = np.array(self.sides), len(self.size)
        self.mean = self.case.particles * sides**d / self.size.prod()
        self.blocks, self.order = Blocks(len(self.sides)), Blocks()

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`, in which earlier versions had no order."""
        super().restore(pack(order=self.order) | dict(state))

    def observe(self, engine: RunningFlock) -> None:
        places = engine.positions()
        self.order.add(float(np.linalg.norm(engine.headings().mean(axis=0))))
        self.blocks.add(
            [
                ((counts_in_squares(places, side, self.size) - mean) ** 2).mean()
                for side, mean in zip(self.sides, self.mean, strict=True)
            ]
        )

    def result(self) -> Result:
        """Standard deviations."""
        variance, order = of_mean(self.blocks), float(self.order.mean())
        with np.errstate(invalid="ignore", divide="ignore"):
            value = np.sqrt(variance.value)
            error = variance.error / (2 * value)
        return self.report(
            {"mean number": self.mean},
            (value, error),
            [self.exponent()] if len(self.sides) >= FEWEST else [],
            # birds at random: a fixed number of them is spread over the box
            expected=np.sqrt(self.mean * (1 - self.mean / self.case.particles)),
            theory="birds at random",
            extra={"sides": np.array(self.sides), "guide": giant_exponent(self.case, order)},
        )

    def exponent(self) -> Comparison | None:
        """Slope of the logarithms, by least squares; None where a variance is 0."""
        variance, case = of_mean(self.blocks), self.case
        use = np.arange(len(self.sides)) >= len(self.sides) - FITTED
        x = np.log(self.mean[use]) - np.log(self.mean[use]).mean()
        weight = np.zeros(len(self.sides))
        weight[use] = x / (x**2).sum()
        if not (variance.value[use] > 0).all():
            return None
        at = np.where(use, variance.value, 1.0)
        slope = 0.5 * float(weight @ np.log(at))
        # of birds at random, a fixed number of which is in the box
        share = np.minimum(self.mean / case.particles, 1.0)
        with np.errstate(divide="ignore"):
            root = 0.5 * float(weight[use] @ np.log(self.mean * (1 - share))[use])
        measured = variance.scalar(slope, 0.5 * weight / at)
        expected, note = number_exponent(case, float(self.order.mean()), root)
        return Comparison("exponent of number fluctuations", *measured, expected, "", note)


def counts_in_squares(places: Array, side: float, size: Array) -> Array:
    """Number of places in each of the whole squares of a side that fit the box."""
    many = np.floor(size / side * (1 + 1e-12)).astype(int)
    bins = np.floor(places / side).astype(int)
    inside = (bins < many).all(axis=1)
    index = np.ravel_multi_index(tuple(bins[inside].T), tuple(many))
    return np.bincount(index, minlength=int(many.prod())).astype(float)
