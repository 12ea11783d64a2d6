"""Islands in time: how many there are, and how large they are."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.expected_structure import island_density
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
from mesokit.statistics import TimeSeries


@component
class IslandDensity(LatticeObservable):
    """Islands per site in time: sites in a state, or columns as high as a level, that are linked.

    Errors come from the scatter between 16 parts of the lattice; an island counts in the part of
    its first site. Beside the last number are the mean size, sites over islands, and the share of
    the sites that are covered.
    """

    quantity: Literal["islands"] = tag("islands")
    drawing, value_label = "growth", "islands per site"
    units: ClassVar[dict[str, str]] = {"time": "tau"}
    state: str | None = param(None, doc="name of the state (the second unless said)")
    level: int | None = param(
        None, doc="least height of an island (the first above the mean unless said)"
    )
    smallest: int = param(1, doc="sites of the smallest island that counts", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError for a state or a level without meaning, and for a short lattice."""
        super().check(case)
        check_islands(case, self.state, self.level)
        check_parts(case)


@accumulator_of(IslandDensity)
class IslandDensityAccumulator(BlockAccumulator):
    """Islands and their sites per site, in parts of the lattice, in time."""

    memory: ClassVar[tuple[str, ...]] = ("series",)
    observable: IslandDensity

    def prepare(self) -> None:
        self.neighbours = Neighbours(self.case)
        self.series = TimeSeries(3 * PARTS)

    def observe(self, engine: RunningLattice) -> None:
        made, sites = self.observable, engine.sites()
        use = covered(self.case, sites, made.state, made.level)
        sizes, first = islands(self.neighbours, use)
        counts = sizes >= made.smallest
        length = self.neighbours.size[0]
        row = first[counts] * length // engine.n
        per_site = length / engine.n
        rows = (
            np.bincount(row, minlength=length),
            np.bincount(row, sizes[counts], minlength=length),
            use.reshape(length, -1).sum(axis=1),
        )
        self.series.add(engine.time, np.concatenate([in_parts(each * per_site) for each in rows]))

    def result(self) -> Result:
        time, rows = self.series.time(), self.series.values().reshape(-1, 3, PARTS)
        expected, note = island_density(self.case, self.observable, rows[:, 2].mean(axis=-1))
        return self.report(
            {"time": time},
            of_parts(rows[:, 0]),
            self.comparisons(rows, expected, note),
            samples=len(time),
            expected=expected,
            theory=note,
        )

    def comparisons(self, rows: Array, expected: Array | None, note: str) -> Iterator[Comparison]:
        """Number, mean size and coverage at the end."""
        if not len(rows):
            return
        number, sites, _ = rows[-1]
        value, error = of_parts(rows[-1])
        known = np.nan if expected is None else expected[-1]
        yield Comparison("last islands per site", value[0], error[0], known, "", note)
        if value[0] > 0:
            size = value[1] / value[0]
            _, scatter = of_parts(sites - size * number)
            yield Comparison("last mean size of islands", size, scatter / value[0])
        yield Comparison("last share of covered sites", value[2], error[2])
