"""Bodies in slices across an axis: how many there are, and how their axes lie."""

from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected.bodies import KIND_OF_BODY, followed
from mesokit.method.mpcd.expected.body_heights import heights, in_balance
from mesokit.seam.estimate import of_mean, of_ratio
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks


@component
class BodyProfile(Observable):
    """Centres of bodies per cell in slices across an axis, and the order of their axes x there.

    The order is the mean direction, which has d components, and the nematic order about the axis of
    the slices, the mean of (d cos^2 - 1)/(d - 1) of the angle from it: 1 where bodies stand across
    the slices, below 0 where they lie in them. Disks and spheres between plates are spread by
    Boltzmann's distribution, with a force across the slit by the barometric law.
    """

    quantity: Literal["body-profile"] = tag("body-profile")
    drawing, value_label = "body profile", "density and order"
    kind: int | str = param(1, doc=KIND_OF_BODY)
    axis: Axis = param("y", doc="axis across which the slices lie")
    bins_per_cell: int = param(1, doc="slices per cell", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without such bodies, and for an axis that the box has not."""
        case.box.index(self.axis)
        followed(case, self.quantity, self.kind)


@accumulator_of(BodyProfile)
class BodyProfileAccumulator(BlockAccumulator):
    """Sums of each slice, and means over all bodies."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "whole")

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.of, self.dimension = (
            followed(case, observable.quantity, observable.kind),
            case.box.dimension,
        )
        self.axis = case.box.index(observable.axis)
        self.length = float(case.box.size[self.axis])
        self.bins = max(1, round(self.length * observable.bins_per_cell))
        self.edges = np.linspace(0.0, self.length, self.bins + 1)
        # number, direction and nematic order of each slice; place, direction and order of all
        self.blocks = Blocks((2 + self.dimension, self.bins))
        self.whole = Blocks(2 + self.dimension)

    def observe(self, fluid: Any) -> None:
        d, rows = self.dimension, self.of.rows
        place = fluid.bodies.places()[rows][:, self.axis] % self.length
        headings = fluid.bodies.headings[rows]
        nematic = (d * headings[:, self.axis] ** 2 - 1) / (d - 1)
        terms = np.column_stack([np.ones(len(place)), headings, nematic])
        slices = np.minimum((place * (self.bins / self.length)).astype(np.int64), self.bins - 1)
        sums = np.zeros((self.bins, 2 + d))
        np.add.at(sums, slices, terms)
        self.blocks.add(sums.T)
        self.whole.add([place.mean(), *headings.mean(axis=0), nematic.mean()])

    def result(self) -> Result:
        names = ["density", *(f"heading {axis}" for axis in AXES[: self.dimension]), "nematic"]
        sums, _ = self.blocks.sums()
        number = np.broadcast_to(sums[:, :1], sums[:, 1:].shape)
        order = of_ratio(sums[:, 1:], number)
        density = of_mean(self.blocks)
        per_cell = self.bins / self.case.box.volume
        value = np.vstack([density.value[:1] * per_cell, order.value])
        error = np.vstack([density.error[:1] * per_cell, order.error])
        axis = self.observable.axis
        known = heights(self.of, self.axis, self.edges)
        expected = np.full(value.shape, np.nan)
        if known is not None:
            expected[0] = known.shares * self.of.number * per_cell
        if self.any_direction:
            expected[1:] = 0.0
        return self.report(
            {axis: (self.edges[1:] + self.edges[:-1]) / 2, "of": names},
            (value.T, error.T),
            self.comparisons(),
            label=f"density and order of {self.of.name}",
            units={axis: "a", "density": self.case.box.density_unit},
            expected=None if np.isnan(expected).all() else expected.T,
            theory="Boltzmann" + (", bodies alone" if known is not None and known.note else ""),
            extra={"edges": self.edges},
        )

    @property
    def any_direction(self) -> bool:
        """Whether no direction is preferred: of disks and spheres that turn freely at rest."""
        return self.of.any_direction and in_balance(self.case, self.axis)

    def comparisons(self) -> Iterator[Comparison]:
        """The mean place where plates close the axis, and the order of all bodies."""
        mean, error, axis = self.whole.mean(), self.whole.error(), self.observable.axis
        known = heights(self.of, self.axis, self.edges)
        if self.case.walls:
            expected, note = (np.nan, "") if known is None else (known.mean, known.note)
            yield Comparison(f"mean place along {axis}", mean[0], error[0], expected, "a", note)
        rest = 0.0 if self.any_direction else np.nan
        for k, name in enumerate(AXES[: self.dimension], start=1):
            yield Comparison(f"mean heading along {name}", mean[k], error[k], rest)
        yield Comparison(f"nematic order about {axis}", mean[-1], error[-1], rest)
