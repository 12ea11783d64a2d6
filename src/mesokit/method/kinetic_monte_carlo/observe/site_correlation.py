"""Correlation of the states of sites, by their distance."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.expected_structure import correlation
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import (
    fields_of,
    relative,
    states_of,
)
from mesokit.method.kinetic_monte_carlo.observe.shared.separations import Separations
from mesokit.seam.estimate import Estimate, of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks


@component
class SiteCorrelation(LatticeObservable):
    """Correlation g(r) of two sites at a distance r: 1 at r = 0, and 0 if they are independent.

    With P(r), the probability that both are in one state, it is (P(r) - sum p^2) / (1 - sum p^2),
    where p is the part of the sites in each state; of spins (<s s'> - m^2) / (1 - m^2). Heights
    have <h h'> over <h^2>, both from their mean.
    """

    quantity: Literal["site-correlation"] = tag("site-correlation")
    value_label: ClassVar[str] = "correlation $g$"
    units: ClassVar[dict[str, str]] = {"distance": "a"}
    direction: Literal["radius", "x", "y", "z"] = param(
        "radius",
        doc="an axis along which pairs are; radius: all, nearest neighbours first, then in shells "
        "of width 1",
    )
    state: str | None = param(None, doc="name of the state that is correlated (all unless said)")

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not, and a state that the model has not."""
        super().check(case)
        states_of(case, self.state)
        if self.direction != "radius":
            case.box.index(self.direction, "direction")


@accumulator_of(SiteCorrelation)
class SiteCorrelationAccumulator(BlockAccumulator):
    """Mean products of pairs in each shell, and parts of the sites."""

    observable: SiteCorrelation

    def prepare(self) -> None:
        self.states = states_of(self.case, self.observable.state)
        self.pairs = Separations(self.case, self.observable.direction)
        self.blocks = Blocks(self.pairs.number + max(len(self.states), 1))

    def observe(self, engine: RunningLattice) -> None:
        fields = fields_of(engine.sites(), self.states)
        products = sum(self.pairs.mean_products(field.reshape(self.pairs.size)) for field in fields)
        parts = [field.mean() for field in fields] if self.states else [0.0]
        self.blocks.add(np.concatenate([products, parts]))

    def result(self) -> Result:
        distance = self.pairs.distance
        expected, note = correlation(self.case, self.observable, distance)
        found = self.found()
        return self.report(
            {"distance": distance},
            found,
            self.comparisons(found, expected, note),
            expected=expected,
            theory=note,
        )

    def found(self) -> Estimate:
        """g of each shell."""
        means, number = of_mean(self.blocks), self.pairs.number
        if self.states:
            found = relative(means, number, connected=True)
        else:
            square = float(means.value[0]) or math.nan
            value = means.value[:number] / square
            slope = np.eye(number, number + 1)
            slope[:, 0] -= value
            found = means.linear(slope / square)._replace(value=value)
        found.residuals[:, 0] = 0.0  # a site with itself: 1 without any scatter
        return found

    def comparisons(
        self, found: Estimate, expected: Array | None, note: str
    ) -> Iterator[Comparison]:
        """Correlation of the nearest pairs, and the distance over which it falls to 1/e."""
        if self.pairs.number < 2:
            return
        unit = np.eye(self.pairs.number)
        known = math.nan if expected is None else float(expected[1])
        nearest = found.scalar(found.value[1], unit[1])
        yield Comparison("correlation of the nearest sites", *nearest, known, "", note)
        length = fall(self.pairs.distance, found.value)
        if length is None:
            return
        known = math.nan
        if expected is not None and (wanted := fall(self.pairs.distance, expected)) is not None:
            known = wanted[0]
        what = "distance at which g is 1/e"
        yield Comparison(what, *found.scalar(*length), known, "a", note)


def fall(distance: Array, g: Array) -> tuple[float, Array] | None:
    """The distance at which g falls below 1/e, and its gradient; None if it does not.

    Between two shells the logarithm of g is a straight line, so that exp(-r/length) has its length.

    >>> r = np.arange(5.0)
    >>> round(fall(r, np.exp(-r / 2.5))[0], 6), fall(r, np.ones(5))
    (2.5, None)
    """
    below = np.flatnonzero(g < math.exp(-1))
    if not len(below) or below[0] == 0 or not np.isfinite(g[: below[0] + 1]).all():
        return None
    b = int(below[0])
    a, gradient = b - 1, np.zeros(len(g))
    span = distance[b] - distance[a]
    if g[b] <= 0:  # of which there is no logarithm
        part = (g[a] - math.exp(-1)) / (g[a] - g[b])
        gradient[a] = span * (1 - part) / (g[a] - g[b])
        gradient[b] = span * part / (g[a] - g[b])
        return float(distance[a] + part * span), gradient
    drop = math.log(g[a] / g[b])
    part = (math.log(g[a]) + 1) / drop
    gradient[a] = span * (1 - part) / (drop * g[a])
    gradient[b] = span * part / (drop * g[b])
    return float(distance[a] + part * span), gradient
