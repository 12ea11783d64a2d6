"""Structure factor of the states of sites, by the length of the wave vector."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.expected_structure import structure_factor
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import (
    fields_of,
    relative,
    states_of,
)
from mesokit.method.kinetic_monte_carlo.observe.shared.waves import Waves
from mesokit.seam.estimate import Estimate, of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks


@component
class SiteStructureFactor(LatticeObservable):
    """Structure factor S(k), a mean over rings of wave vectors: 1 if sites are independent.

    With f = 1 at sites in a state and 0 elsewhere it is the sum over states of |sum f
    exp(-i k.r)|^2 / n, over that of p (1 - p), where p is the part of the sites in each state.
    Heights have |sum h exp(-i k.r)|^2 / n.
    """

    quantity: Literal["site-structure-factor"] = tag("site-structure-factor")
    drawing = "structure factor"
    value_label: ClassVar[str] = "structure factor $S$"
    units: ClassVar[dict[str, str]] = {"k": "1/a"}
    state: str | None = param(None, doc="name of the state that scatters (all unless said)")

    def check(self, case: Case) -> None:
        """Raise CaseError for a state that the model has not."""
        super().check(case)
        states_of(case, self.state)


@accumulator_of(SiteStructureFactor)
class SiteStructureFactorAccumulator(BlockAccumulator):
    """Power of each ring of wave vectors, and parts of the sites."""

    observable: SiteStructureFactor

    def prepare(self) -> None:
        self.states = states_of(self.case, self.observable.state)
        self.waves = Waves(self.case)
        self.rings = len(self.waves.numbers)
        self.blocks = Blocks(self.rings + max(len(self.states), 1))

    def observe(self, engine: RunningLattice) -> None:
        fields = fields_of(engine.sites(), self.states)
        power = sum(self.waves.power(field.reshape(self.waves.size)) for field in fields)
        parts = [field.mean() for field in fields] if self.states else [0.0]
        self.blocks.add(np.concatenate([self.waves.by_ring(np.asarray(power)), parts]))

    def result(self) -> Result:
        expected, note = structure_factor(self.case, self.observable, self.waves.mean)
        found = self.found()
        return self.report(
            {"k": self.waves.mean},
            found,
            self.comparisons(found, expected, note),
            units={"value": "" if self.states else "a^2"},
            expected=expected,
            theory=note,
        )

    def found(self) -> Estimate:
        """S of each ring."""
        means = of_mean(self.blocks)
        if self.states:
            return relative(means, self.rings, connected=False)
        return means.part(slice(self.rings))

    def comparisons(
        self, found: Estimate, expected: Array | None, note: str
    ) -> Iterator[Comparison]:
        """The longest waves, and the mean over all rings."""
        unit = "" if self.states else "a^2"
        waves = self.waves.numbers / self.waves.numbers.sum()
        for what, weights in (
            ("structure factor of the longest waves", np.eye(1, self.rings)[0]),
            ("mean structure factor", waves),
        ):
            known = np.nan if expected is None else weights @ expected
            yield Comparison(what, *found.total(weights), known, unit, note)
