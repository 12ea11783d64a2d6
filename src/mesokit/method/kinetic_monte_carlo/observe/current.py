"""Current of particles along an axis, and how much the number of crossings scatters."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.expected_structure import current
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.carried import Carried
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import FEWEST_PIECES, Blocks, TimeSeries, correlated


@component
class Current(LatticeObservable):
    """Net crossings of the planes between rows along an axis, per site of a plane and time.

    Particles are sites in a state; every hop counts, also those between two samples, and entries at
    ends of the lattice. Beside the mean is the variance of the crossings of a site of a plane, a
    mean over all planes, per time: it follows from the error of the mean.
    """

    quantity: Literal["current"] = tag("current")
    drawing, value_label = "path", "crossings per time"
    units: ClassVar[dict[str, str]] = {"time": "tau", "value": "1/time"}
    axis: Literal["x", "y", "z"] = param("x", doc="axis along which it is")
    state: str | None = param(None, doc="name of the state (the second unless said)")

    def check(self, case: Case) -> None:
        """Raise CaseError where nothing hops, and for an axis or a state that is not there."""
        super().check(case)
        Carried(case, self.state, self.axis)


@accumulator_of(Current)
class CurrentAccumulator(BlockAccumulator):
    """Crossings between two samples."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series", "before", "since", "number")
    observable: Current

    def prepare(self) -> None:
        self.carried = Carried(self.case, self.observable.state, self.observable.axis)
        self.blocks, self.series = Blocks(1), TimeSeries(1)
        self.before, self.since = 0.0, -1.0  # crossings up to the last sample, and its time
        self.number = 0  # of particles in the first sample

    def observe(self, engine: RunningLattice) -> None:
        carried = self.carried
        rows = float((engine.happened()[:, :-1] * carried.rows).sum())
        now = rows / (carried.planes * carried.across)
        if self.since >= 0:
            rate = (now - self.before) / (engine.time - self.since)
            self.blocks.add([rate])
            self.series.add(0.5 * (engine.time + self.since), [rate])
        else:
            self.number = int((engine.sites() == 1).sum())
        self.before, self.since = now, engine.time

    def result(self) -> Result:
        time = self.series.time()
        known, _, note = current(self.case, self.number)
        return self.report(
            {"time": time},
            self.series.values()[:, 0],
            self.comparisons(),
            expected=None if math.isnan(known) else np.full(len(time), known),
            theory=note,
        )

    def comparisons(self) -> Iterator[Comparison]:
        """The mean, and the variance of the crossings per time."""
        means = of_mean(self.blocks)
        known, scatter, note = current(self.case, self.number)
        mean, error = means.total(np.ones(1))
        yield Comparison("mean current", mean, error, known, "1/time", note)
        pieces = float(correlated(means.residuals, means.weights)[1][0])
        if error > 0 and pieces >= FEWEST_PIECES:
            time = self.blocks.count * self.observable.every * self.case.lattice.timestep
            value, note = error**2 * time, note if math.isfinite(scatter) else ""
            what = "variance of crossings per time"
            bar = value * math.sqrt(2 / (pieces - 1))
            yield Comparison(what, value, bar, scatter, "1/time", note)
