"""Rates of events: how often each process happens, and which way along an axis."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.component import component, tag
from mesokit.method.kinetic_monte_carlo.expected import before_steady, event_rates
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks


@component
class EventRates(LatticeObservable):
    """Events of each process per site and unit of time.

    Every event counts, also those between two samples.
    """

    quantity: Literal["event-rates"] = tag("event-rates")
    value_label: ClassVar[str] = "events of a site"
    units: ClassVar[dict[str, str]] = {"value": "1/time"}


@accumulator_of(EventRates)
class EventRatesAccumulator(BlockAccumulator):
    """Events between two samples, of each process."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "before", "since", "first")

    def prepare(self) -> None:
        self.names = self.case.lattice.model.events()
        self.blocks = Blocks(len(self.names))
        self.before, self.since = np.full(len(self.names), -1), 0.0  # counts at the last sample
        self.first = np.zeros(len(self.case.lattice.model.states()))  # part of the sites in each

    def observe(self, engine: RunningLattice) -> None:
        now = engine.happened().sum(axis=1)
        if self.before[0] >= 0:
            self.blocks.add((now - self.before) / ((engine.time - self.since) * engine.n))
        elif len(self.first):
            self.first = np.bincount(engine.sites(), minlength=len(self.first)) / engine.n
        self.before, self.since = now, engine.time

    def result(self) -> Result:
        return self.report({"process": np.array(self.names)}, self.blocks, self.comparisons())

    def comparisons(self) -> Iterator[Comparison]:
        """The rate of each process."""
        mean, error, known = self.blocks.mean(), self.blocks.error(), event_rates(self.case)
        early = before_steady(self.case, self.first)
        for k, name in enumerate(self.names):
            expected, note = known.get(name, (np.nan, ""))
            yield Comparison(
                f"rate of {name}", mean[k], error[k], expected, "1/time", early or note
            )
