"""Sizes of islands: how many there are of each size."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.expected_structure import island_sizes
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.islands_of import (
    check_islands,
    covered,
    islands,
)
from mesokit.method.kinetic_monte_carlo.observe.shared.neighbours import Neighbours
from mesokit.method.kinetic_monte_carlo.observe.shared.parts import (
    PARTS,
    check_parts,
    in_parts,
    of_parts,
)
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result

ALONE = 10  # sizes that have a bin of their own; then bins grow by a quarter


@component
class IslandSizes(LatticeObservable):
    """Islands of each size per site, averaged over time.

    Up to 10 sites each size has its own bin; then bins grow by a quarter, and the value is the mean
    over the sizes in the bin. Errors come from the scatter between 16 parts of the lattice; an
    island counts in the part of its first site.
    """

    quantity: Literal["island-sizes"] = tag("island-sizes")
    drawing, value_label = "logarithmic", "islands of this size per site"
    units: ClassVar[dict[str, str]] = {"size": ""}
    state: str | None = param(None, doc="name of the state (the second unless said)")
    level: int | None = param(
        None, doc="least height of an island (the first above the mean unless said)"
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for a state or a level without meaning, and for a short lattice."""
        super().check(case)
        check_islands(case, self.state, self.level)
        check_parts(case)


@accumulator_of(IslandSizes)
class IslandSizesAccumulator(BlockAccumulator):
    """Sums over samples: islands by part of the lattice and by size, their sites, their squares."""

    memory: ClassVar[tuple[str, ...]] = ("sums", "samples")
    added: ClassVar[tuple[str, ...]] = ("sums", "samples")
    observable: IslandSizes

    def prepare(self) -> None:
        self.neighbours = Neighbours(self.case)
        self.edges = edges_up_to(int(np.prod(self.neighbours.size)))
        # bins of sizes, then islands, sites of islands and squares of their sizes
        self.sums, self.samples = np.zeros((PARTS, len(self.edges) + 2)), np.zeros(1, np.int64)

    def observe(self, engine: RunningLattice) -> None:
        made = self.observable
        use = covered(self.case, engine.sites(), made.state, made.level)
        sizes, first = islands(self.neighbours, use)
        length, bins = self.neighbours.size[0], len(self.edges) - 1
        row = first * length // engine.n
        place = np.searchsorted(self.edges, sizes, side="right") - 1
        found = np.zeros((length, bins + 3))
        np.add.at(found, (row, place), 1.0)
        for column, power in enumerate((0, 1, 2), bins):
            found[:, column] = np.bincount(row, sizes.astype(float) ** power, minlength=length)
        per_site = length / engine.n
        self.sums += np.apply_along_axis(in_parts, 0, found * per_site)
        self.samples += 1

    def result(self) -> Result:
        samples, bins = int(self.samples[0]), len(self.edges) - 1
        widths = np.diff(self.edges)
        value, error = of_parts((self.sums[:, :bins] / widths / max(samples, 1)).T)
        seen = max(int(np.flatnonzero(value)[-1]) + 1, 2) if value.any() else 1
        size = 0.5 * (self.edges[:-1] + self.edges[1:] - 1)
        expected, note = island_sizes(self.case, self.observable, self.edges)
        empty = value == 0
        value[empty], error[empty] = np.nan, np.nan
        return self.report(
            {"size": size[:seen]},
            (value[:seen], error[:seen]),
            self.comparisons(expected, note),
            samples=samples,
            expected=None if expected is None else expected[:seen],
            theory=note,
        )

    def comparisons(self, expected: Array | None, note: str) -> Iterator[Comparison]:
        """Islands per site, their mean size, and the mean size of the island of a site."""
        sums = self.sums[:, -3:] / self.samples[0]
        value, error = of_parts(sums.T)
        known = np.nan if expected is None else float(expected @ np.diff(self.edges))
        yield Comparison("islands per site", value[0], error[0], known, "", note)
        for k, what in enumerate(("mean size of islands", "mean size of the island of a site")):
            if value[k] > 0:
                ratio = value[k + 1] / value[k]
                _, scatter = of_parts(sums[:, k + 1] - ratio * sums[:, k])
                yield Comparison(what, ratio, float(scatter / value[k]))


def edges_up_to(most: int) -> Array:
    """First size of each bin, and that beyond the last.

    >>> edges_up_to(20)[-5:].tolist()
    [10.0, 11.0, 14.0, 18.0, 23.0]
    """
    edges = list(range(1, min(ALONE, most) + 2))
    while edges[-1] <= most:
        edges.append(int(1.25 * edges[-1]) + 1)
    return np.array(edges, float)
