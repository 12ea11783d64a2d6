"""Energy of a lattice, and its heat capacity from fluctuations."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, name_of, show, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.expected import known_mean
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks, TimeSeries


@component
class LatticeEnergy(LatticeObservable):
    """Energy per site in time, its mean, and the heat capacity from its variance."""

    quantity: Literal["lattice-energy"] = tag("lattice-energy")
    drawing, value_label = "path", "energy per site"
    units: ClassVar[dict[str, str]] = {"time": "tau", "value": "energy"}

    def check(self, case: Case) -> None:
        """Raise CaseError for a model without an energy."""
        super().check(case)
        if case.lattice.model.energies() is None:
            raise CaseError(
                f"model {show(name_of(case.lattice.model))} has no energy; leave it out"
            )


@accumulator_of(LatticeEnergy)
class LatticeEnergyAccumulator(BlockAccumulator):
    """Energy and its square, and a time series of it."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series")

    def prepare(self) -> None:
        self.energies = self.case.lattice.model.energies()
        self.blocks, self.series = Blocks(2), TimeSeries(1)

    def observe(self, engine: RunningLattice) -> None:
        numbers = np.bincount(engine.sites(), minlength=len(self.energies.site))
        bonds = engine.pairs()[:, :-1]  # each is counted from both ends
        total = numbers @ self.energies.site + 0.5 * (bonds * self.energies.pair).sum()
        energy = total / engine.n
        self.blocks.add([energy, energy**2])
        self.series.add(engine.time, [energy])

    def result(self) -> Result:
        return self.report(
            {"time": self.series.time()}, self.series.values()[:, 0], self.comparisons()
        )

    def comparisons(self) -> Iterator[Comparison]:
        """Mean and heat capacity."""
        case, means = self.case, of_mean(self.blocks)
        energy, square = map(float, means.value)
        known, note = known_mean(case, "energy")
        measured = means.scalar(energy, np.array([1.0, 0.0]))
        yield Comparison("mean energy", *measured, known, "energy", note)
        kT = getattr(case.lattice.model, "kT", 0.0)
        if kT > 0:
            factor = case.particles / kT**2
            measured = means.scalar(
                factor * (square - energy**2), factor * np.array([-2 * energy, 1.0])
            )
            known, note = known_mean(case, "square energy")
            if not math.isnan(known):
                known = factor * (known - known_mean(case, "energy")[0] ** 2)
            yield Comparison(
                "heat capacity", *measured, known, "", note or "per site, from the variance"
            )
