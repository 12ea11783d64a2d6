"""Magnetisation of the Ising model, its fluctuations and its cumulant."""

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
class Magnetisation(LatticeObservable):
    """Mean spin m of sites with two states, -1 and 1, in time.

    Beside its mean are those of its size and of its square, the susceptibility n (<m^2> - <|m|>^2)
    / kT and the Binder cumulant 1 - <m^4>/(3 <m^2>^2)."""

    quantity: Literal["magnetisation"] = tag("magnetisation")
    drawing, value_label = "path", "mean spin"
    units: ClassVar[dict[str, str]] = {"time": "tau"}

    def check(self, case: Case) -> None:
        """Raise CaseError for a model whose sites have not two states."""
        super().check(case)
        if len(case.lattice.model.states()) != 2:
            raise CaseError(f"model {show(name_of(case.lattice.model))} has no spins; leave it out")


@accumulator_of(Magnetisation)
class MagnetisationAccumulator(BlockAccumulator):
    """Powers of the mean spin, and a time series of it."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series")

    def prepare(self) -> None:
        self.blocks, self.series = Blocks(4), TimeSeries(1)

    def observe(self, engine: RunningLattice) -> None:
        m = 2 * float(engine.sites().mean()) - 1
        self.blocks.add([m, abs(m), m**2, m**4])
        self.series.add(engine.time, [m])

    def result(self) -> Result:
        return self.report(
            {"time": self.series.time()}, self.series.values()[:, 0], self.comparisons()
        )

    def comparisons(self) -> Iterator[Comparison]:
        """Mean, size, square, susceptibility and cumulant."""
        case, means = self.case, of_mean(self.blocks)
        mean, size, square, fourth = map(float, means.value)
        unit = np.eye(4)
        for k, (what, name) in enumerate(
            (("mean spin", "mean"), ("mean size", "size"), ("mean square", "square"))
        ):
            known, note = known_mean(case, name)
            yield Comparison(what, *means.scalar((mean, size, square)[k], unit[k]), known, "", note)
        kT = getattr(case.lattice.model, "kT", 0.0)
        if kT > 0:
            factor = case.particles / kT
            slope = factor * (unit[2] - 2 * size * unit[1])
            known, note = known_mean(case, "square")
            if not math.isnan(known):
                known = factor * (known - known_mean(case, "size")[0] ** 2)
            measured = means.scalar(factor * (square - size**2), slope)
            yield Comparison("susceptibility", *measured, known, "", note)
        if square > 0:
            slope = (2 * fourth / (3 * square**3)) * unit[2] - unit[3] / (3 * square**2)
            known, note = known_mean(case, "square")
            if not math.isnan(known):
                known = 1 - known_mean(case, "fourth")[0] / (3 * known**2)
            measured = means.scalar(1 - fourth / (3 * square**2), slope)
            yield Comparison("Binder cumulant", *measured, known, "", note)
