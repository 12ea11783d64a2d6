"""Coverage: the part of the sites in each state, in time."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, name_of, show, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.expected import before_steady, coverages, relaxation
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks, TimeSeries


@component
class Coverage(LatticeObservable):
    """Part of the sites in each state, in time, and its mean.

    Samples are taken at equal times, so that each state of the lattice counts by the time that it
    lasts.
    """

    quantity: Literal["coverage"] = tag("coverage")
    drawing, value_label = "path", "part of the sites"
    units: ClassVar[dict[str, str]] = {"time": "tau"}

    def check(self, case: Case) -> None:
        """Raise CaseError for heights, which are not covered or empty."""
        super().check(case)
        if not case.lattice.model.states():
            raise CaseError(
                f"model {show(name_of(case.lattice.model))} has heights; expected 'roughness'"
            )


@accumulator_of(Coverage)
class CoverageAccumulator(BlockAccumulator):
    """Parts of the sites, and a time series of them."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series")

    def prepare(self) -> None:
        self.names = self.case.lattice.model.states()
        self.blocks, self.series = Blocks(len(self.names)), TimeSeries(len(self.names))

    def observe(self, engine: RunningLattice) -> None:
        parts = np.bincount(engine.sites(), minlength=len(self.names)) / engine.n
        self.blocks.add(parts)
        self.series.add(engine.time, parts)

    def result(self) -> Result:
        time, parts = self.series.time(), self.series.values()
        return self.report(
            {"time": time, "state": np.array(self.names)},
            parts,
            self.comparisons(parts),
            expected=relaxation(self.case, time, parts),
            theory="master equation",
        )

    def comparisons(self, parts: NDArray[np.float64]) -> Iterator[Comparison]:
        """The mean of each."""
        mean, error, known = self.blocks.mean(), self.blocks.error(), coverages(self.case)
        early = before_steady(self.case, parts[0])
        for k, name in enumerate(self.names):
            expected, note = known.get(name, (np.nan, ""))
            yield Comparison(f"mean part {name}", mean[k], error[k], expected, "", early or note)
