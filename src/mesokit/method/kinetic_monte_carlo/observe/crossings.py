"""Particles that have crossed a plane since the first sample: the integrated current."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.expected_structure import crossings
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.carried import Carried
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import state_number
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import FEWEST_BLOCKS, TimeSeries

LAST = 10.0  # of the time of a run: crossings since a tenth of it are compared


@component
class Crossings(LatticeObservable):
    """Particles that crossed a plane along an axis since the first sample, in time.

    It is the number of particles beyond the plane and of those that left there. Errors, and the
    variance, come from how runs with different seeds scatter: four or more.
    """

    quantity: Literal["crossings"] = tag("crossings")
    drawing, value_label = "growth", "particles across"
    units: ClassVar[dict[str, str]] = {"time": "tau"}
    axis: Literal["x", "y", "z"] = param("x", doc="axis that the plane is across")
    part: float = param(0.5, doc="where it is: part of the length of the box", gt=0, lt=1)
    state: str | None = param(None, doc="name of the state (the second unless said)")

    def check(self, case: Case) -> None:
        """Raise CaseError where nothing hops, where particles are made, and on a ring."""
        super().check(case)
        carried = Carried(case, self.state, self.axis)
        if not carried.ends:
            raise CaseError(
                f"axis = {show(self.axis)}: a periodic lattice has no side beyond a plane; give "
                f"lattice.ends = [{show(self.axis)}]"
            )
        if not carried.kept:
            raise CaseError("lattice.model: processes make particles; expected hops alone")


@accumulator_of(Crossings)
class CrossingsAccumulator(BlockAccumulator):
    """The number beyond the plane, in time."""

    memory: ClassVar[tuple[str, ...]] = ("series", "first")
    observable: Crossings

    def prepare(self) -> None:
        made, case = self.observable, self.case
        self.along = case.box.index(made.axis)
        self.over = Carried(case, made.state, made.axis).over
        self.over = np.where(self.positive(), self.over, 0.0)
        self.size = tuple(map(int, case.box.size))
        self.row = round(made.part * self.size[self.along])
        self.state_number = 1 if made.state is None else state_number(case, made.state)
        self.series, self.first = TimeSeries(1), math.nan

    def positive(self) -> Array:
        """Directions (neighbours,) that are ahead along the axis."""
        return np.asarray(self.case.lattice.lattice.shifts[0, :, self.along] > 0)

    def observe(self, engine: RunningLattice) -> None:
        rows = np.moveaxis(engine.sites().reshape(self.size), self.along, 0)
        beyond = float((rows[self.row :] == self.state_number).sum())
        beyond += float((engine.happened()[:, :-1] * self.over).sum())
        if math.isnan(self.first):
            self.first = beyond
        self.series.add(engine.time, [beyond - self.first])

    def result(self) -> Result:
        time = self.series.time()
        expected, _, note = crossings(self.case, self.observable, time)
        return self.report(
            {"time": time},
            (self.series.values()[:, 0], self.series.error()[:, 0]),
            self.comparisons(time),
            samples=len(time),
            expected=expected,
            theory=note,
        )

    def comparisons(self, time: Array) -> Iterator[Comparison]:
        """Crossings since a tenth of the time, and the variance of all."""
        if len(time) < 2:
            return
        runs = self.series.each()[:, :, 0]
        begin = int(np.argmin(abs(time - time[-1] / LAST)))
        expected, variance, note = crossings(self.case, self.observable, time[[begin, -1]])
        late = runs[:, -1] - runs[:, begin]
        known = math.nan if expected is None else float(expected[1] - expected[0])
        many, count = len(runs) >= FEWEST_BLOCKS, len(runs)
        error = float(late.std(ddof=1)) / math.sqrt(count) if many else math.nan
        what = f"crossings from {time[begin]:.4g} to {time[-1]:.4g} tau"
        exact = note.removeprefix("approximate: ")  # a constant is what is missing, and cancels
        yield Comparison(what, late.mean(), error, known, "", exact)
        if many:
            found = float(runs[:, -1].var(ddof=1))
            bar = found * math.sqrt(2 / (count - 1))
            yield Comparison("variance of all crossings", found, bar, variance, "", note)
