"""Differences of heights over a distance, and the exponent of a rough surface."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, name_of, param, show, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.expected_structure import (
    height_differences,
    roughness_exponent,
)
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.separations import Separations
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

SHORT = 8  # of the shells: the exponent is fitted over the first of so many parts


def check_heights(case: Case) -> None:
    """Raise CaseError for a model without heights."""
    if case.lattice.model.states():
        raise CaseError(f"model {show(name_of(case.lattice.model))} has no heights; leave it out")


@component
class HeightDifferences(LatticeObservable):
    """Mean square difference G(r) of the heights of two columns at a distance r along an axis.

    On a rough surface it is a power r^(2 alpha), as far as heights are correlated: the exponent is
    fitted up to a sixteenth of the lattice.
    """

    quantity: Literal["height-differences"] = tag("height-differences")
    drawing, value_label = "logarithmic", "mean square difference of heights $G$"
    units: ClassVar[dict[str, str]] = {"distance": "a", "value": "a^2"}
    axis: Literal["x", "y", "z"] = param("x", doc="axis along which pairs of columns are")

    def check(self, case: Case) -> None:
        """Raise CaseError for a model without heights, and an axis that the box has not."""
        super().check(case)
        check_heights(case)
        case.box.index(self.axis)


@accumulator_of(HeightDifferences)
class HeightDifferencesAccumulator(BlockAccumulator):
    """Mean square differences at each distance."""

    observable: HeightDifferences

    def prepare(self) -> None:
        self.pairs = Separations(self.case, self.observable.axis)
        self.along = self.case.box.index(self.observable.axis)
        self.ends = self.observable.axis in self.case.lattice.ends
        self.period = 1 + self.case.lattice.lattice.parity[self.along]
        self.blocks = Blocks(self.pairs.number - 1)

    def observe(self, engine: RunningLattice) -> None:
        heights = engine.sites().astype(float).reshape(self.pairs.size)
        heights -= heights.mean()
        if not self.ends:
            products = self.pairs.mean_products(heights)
            self.blocks.add(2 * (products[0] - products[1:]))
            return
        rows = np.moveaxis(heights, self.along, 0)
        steps = self.period * np.arange(1, self.pairs.number)
        self.blocks.add([((rows[r:] - rows[:-r]) ** 2).mean() for r in steps])

    def result(self) -> Result:
        distance = self.pairs.distance[1:]
        expected, note = height_differences(self.case, distance)
        return self.report(
            {"distance": distance},
            self.blocks,
            self.comparisons(distance, expected, note),
            expected=expected,
            theory=note,
        )

    def comparisons(
        self, distance: Array, expected: Array | None, note: str
    ) -> Iterator[Comparison]:
        """The nearest columns, and the exponent."""
        means = of_mean(self.blocks)
        first = np.eye(1, len(distance))[0]
        known = math.nan if expected is None else float(expected[0])
        yield Comparison("nearest mean square difference", *means.total(first), known, "a^2", note)
        near = distance[: max(2, len(distance) // SHORT)]
        if len(near) < 2 or not (means.value[: len(near)] > 0).all():
            return
        slope = fit_of(near, len(distance))
        value = float(slope[: len(near)] @ np.log(means.value[: len(near)]))
        if expected is not None:
            known = float(slope[: len(near)] @ np.log(expected[: len(near)]))
        else:
            known, note = roughness_exponent(self.case)
        gradient = slope / np.where(means.value > 0, means.value, 1.0)
        yield Comparison("roughness exponent", *means.scalar(value, gradient), known, "", note)


def fit_of(distance: Array, number: int) -> Array:
    """Weights (number,) of the logarithms of the first values in the exponent: half the slope of a
    straight line over the logarithm of the distance, with equal weights of equal ratios.

    >>> r = np.array([1.0, 2.0, 4.0])
    >>> round(float(fit_of(r, 3) @ np.log(r**0.8)), 6)
    0.4
    """
    x = np.log(distance)
    weight = np.gradient(x)
    off = weight * (x - weight @ x / weight.sum())
    found = np.zeros(number)
    found[: len(x)] = 0.5 * off / (off @ x)
    return found
