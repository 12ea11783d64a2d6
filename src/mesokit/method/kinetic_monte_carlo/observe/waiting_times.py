"""Waiting times: how long sites stay in a state."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import ClassVar, Literal, Self

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, name_of, param, show, tag
from mesokit.case.describe.digits import two_digits
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.engine.record import edges
from mesokit.method.kinetic_monte_carlo.expected_records import leaving_rate
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import state_number
from mesokit.seam.estimate import of_mean, of_ratio
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

MERGED = 2  # bins of the record in one: two to a factor of two in time
SHORT = 2.0**-14  # of the shortest mean stay: shorter stays share a bin


@component
class WaitingTimes(LatticeObservable):
    """Probability density of the time that a site stays in a state.

    All stays count that end while the run measures, at the time of their event. The mean stay is
    the time that all sites have spent in the state over the number of stays that ended: stays that
    are under way at the end do not bias it. The first stay of each site counts from the end of the
    warm-up.
    """

    quantity: Literal["waiting-times"] = tag("waiting-times")
    drawing, value_label = "logarithmic", "probability density"
    units: ClassVar[dict[str, str]] = {"value": "1/tau", "duration": "tau"}
    measures: ClassVar[tuple[str, ...]] = ("waits",)
    state: str | None = param(None, doc="name of the state (the second unless said)")

    def check(self, case: Case) -> None:
        """Raise CaseError for heights, a state that is none, and events in sublattices."""
        super().check(case)
        if not case.lattice.model.states():
            raise CaseError(
                f"model {show(name_of(case.lattice.model))} has heights; expected a model with "
                "named states"
            )
        if self.state is not None:
            state_number(case, self.state)
        if case.lattice.sublattices is not None:
            raise CaseError(
                "lattice.sublattices: events have no exact times there; leave it out for "
                "quantity 'waiting-times'"
            )


@accumulator_of(WaitingTimes)
class WaitingAccumulator(BlockAccumulator):
    """Block averages of the stays that ended between two samples."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "before", "sites", "passed")
    added: ClassVar[tuple[str, ...]] = ("sites",)
    observable: WaitingTimes

    def prepare(self) -> None:
        made, given = self.observable, self.case.lattice
        self.state_of = 1 if made.state is None else state_number(self.case, made.state)
        kind = given.lattice
        fastest = float(given.model.kernel(kind, bool(given.ends)).rates.max())
        # a neighbour's events may end a stay too
        least = SHORT / (fastest * (kind.neighbours + 1))
        longest = self.case.run.steps * given.timestep
        fine = edges()
        first, last = np.searchsorted(fine, [least, max(longest, 2 * least)]) // MERGED
        self.first, self.last = int(first) * MERGED, (int(last) + 1) * MERGED
        self.edges = fine[self.first : self.last + 1 : MERGED]
        self.bins = len(self.edges) - 1
        # shorter stays, stays in bins, all stays; times and squares; time spent in the state
        self.blocks = Blocks(self.bins + 5)
        self.before = np.zeros(self.bins + 5)
        self.sites = np.zeros(2)  # in the state at the end of the warm-up, and at the last sample
        self.passed = 0.0  # since then

    def observe(self, engine: RunningLattice) -> None:
        """Take one sample: of what has ended since the last."""
        every, sums = engine.waits()
        counts, (times, squares) = every[self.state_of], sums[self.state_of]
        spent = times + engine.waiting()[self.state_of]
        inside = counts[self.first : self.last].reshape(-1, MERGED).sum(axis=1)
        shorter = counts[: self.first].sum()
        now = np.array([shorter, *inside, counts.sum(), times, squares, spent], float)
        self.blocks.add(now - self.before)
        self.before = now
        began, sites = engine.began(), engine.sites()
        self.sites = np.array([(one == self.state_of).sum() for one in (began, sites)], float)
        self.passed = engine.time - self.case.run.warmup * self.case.lattice.timestep

    def pool(self, other: Self) -> None:
        super().pool(other)
        self.passed = max(self.passed, other.passed)

    def result(self) -> Result:
        """The density, its mean, and how far it is from an exponential."""
        sums, _ = self.blocks.sums()
        number = sums[:, [self.bins + 1]]
        seen = np.flatnonzero(sums[:, 1 : self.bins + 1].sum(axis=0))
        if not len(seen):
            nothing = np.zeros(0)
            return self.report({"duration": nothing}, (nothing, nothing))
        use = slice(seen[0], seen[-1] + 1)
        ends = self.edges[seen[0] : seen[-1] + 2]
        inside = sums[:, 1 : self.bins + 1][:, use]
        share = of_ratio(inside, np.broadcast_to(number, inside.shape))
        width, rate = np.diff(ends), leaving_rate(self.case, self.state_of)
        law = Exponential(rate, self.passed, self.sites[0], float(number.sum()), self.sites[1])
        value, error = share.value / width, share.error / width
        empty = value == 0
        value[empty], error[empty] = np.nan, np.nan
        known = not math.isnan(rate)
        return self.report(
            {"duration": np.sqrt(ends[1:] * np.maximum(ends[:-1], 0.5 * ends[1:]))},
            (value, error),
            self.comparisons(law),
            expected=np.diff(law.part(ends)) / width if known else None,
            theory="exponential" if known else "",
            extra={"edges": ends},
        )

    def comparisons(self, law: Exponential) -> Iterator[Comparison]:
        """The mean stay, the mean square over the square of the mean, and how many there were."""
        every = of_mean(self.blocks)
        number, times, squares, spent = (float(x) for x in every.value[-4:])
        of_number, of_times, of_squares, of_spent = np.eye(len(every.value))[-4:]
        note = ""
        if math.isnan(law.rate):
            early = min(1.0, self.sites[0] / law.stays)
            note = f"up to {two_digits(100 * early)} % of the stays began before measuring"
        mean = spent / number
        measured = every.scalar(mean, (of_spent - mean * of_number) / number)
        yield Comparison("mean stay", *measured, 1 / law.rate, "tau", note)
        spread = squares * number / times**2
        slope = spread * (of_squares / squares + of_number / number - 2 * of_times / times)
        what = "mean square over the square of the mean"
        yield Comparison(what, *every.scalar(spread, slope), law.spread, "", note)
        yield Comparison("stays", law.stays, math.nan)


class Exponential:
    """Stays that end at a rate, of those that end within the time that a run measures.

    Of a stay that began at the time s only a time up to `passed` - s is seen. `first` stays are
    under way at 0, and as many begin later as end, but for what the number of sites changes by;
    these begin at equal rates.
    """

    def __init__(self, rate: float, passed: float, first: float, stays: float, last: float) -> None:
        self.rate, self.passed, self.stays = rate, passed, stays
        later = max(stays + last - first, 0.0)
        self.later = later / (first + later) if first + later > 0 else math.nan
        self.all = float(self._number(np.array(passed)))

    def _number(self, time: Array) -> Array:
        """Integral up to a time of k exp(-k t) (1 - later t / passed)."""
        x, whole = self.rate * time, self.rate * self.passed
        return -np.expm1(-x) + self.later / whole * (np.exp(-x) * (1 + x) - 1)

    def part(self, time: Array) -> Array:
        """Part of the stays that last no longer."""
        return self._number(np.minimum(time, self.passed)) / self.all

    @property
    def spread(self) -> float:
        """Mean square over the square of the mean: 2 in a long run.

        >>> round(Exponential(1.0, 1e6, 1.0, 1e6, 1.0).spread, 4)
        2.0
        >>> round(Exponential(1.0, 10.0, 1.0, 10.0, 1.0).spread, 4)
        1.9754
        """
        whole, b = self.rate * self.passed, self.later / (self.rate * self.passed)
        # integrals of x^n exp(-x) up to the end: incomplete gamma functions
        from scipy.special import gamma, gammainc

        one, two, three = (float(gamma(n) * gammainc(n, whole)) for n in (2, 3, 4))
        mean, square = one - b * two, two - b * three
        return square * self.all / mean**2
