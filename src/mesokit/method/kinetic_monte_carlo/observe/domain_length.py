"""Length of domains in time: from their walls, and from their waves."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, name_of, param, show, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.expected_structure import (
    domain_exponent,
    domain_length,
    walls_in_equilibrium,
)
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import fields_of, states_of
from mesokit.method.kinetic_monte_carlo.observe.shared.neighbours import Neighbours
from mesokit.method.kinetic_monte_carlo.observe.shared.parts import (
    PARTS,
    check_parts,
    in_parts,
    late_exponent,
    of_parts,
)
from mesokit.method.kinetic_monte_carlo.observe.shared.waves import Waves
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import TimeSeries

ROUTES = ("walls", "waves")


@component
class DomainLength(LatticeObservable):
    """Length of domains in time, by two routes, and its exponent over the last decade of a run.

    From walls it is 1 / (w - w_0), where w is the number of unlike pairs of neighbours per site and
    w_0 that in equilibrium: 2 / (e + 2) of spins on a square lattice at temperature 0. From waves
    it is 2 pi / <k>, where the mean has the weights S(k) of rings of wave vectors. Errors come from
    the scatter between 16 parts of the lattice, and of waves as if these were independent.
    """

    quantity: Literal["domain-length"] = tag("domain-length")
    drawing, value_label = "growth", "length of domains"
    units: ClassVar[dict[str, str]] = {"time": "tau", "value": "a"}
    walls: float | None = param(
        None,
        doc="unlike pairs per site in equilibrium, w_0 (of spins on a square lattice Onsager's, "
        "else 0, unless said)",
        ge=0,
    )
    largest: float = param(math.pi / 2, doc="largest wave number that counts", unit="1/a", gt=0)

    def check(self, case: Case) -> None:
        """Raise CaseError for heights, for a short lattice, and where no wave is counted."""
        super().check(case)
        if not case.lattice.model.states():
            raise CaseError(
                f"model {show(name_of(case.lattice.model))} has heights; expected 'roughness'"
            )
        check_parts(case)
        if not len(Waves(case, self.largest).numbers):
            raise CaseError(f"largest = {show(self.largest)}: no wave that fits is as long")


@accumulator_of(DomainLength)
class DomainLengthAccumulator(BlockAccumulator):
    """Walls in parts of the lattice, mean wave number and its variance, in time."""

    memory: ClassVar[tuple[str, ...]] = ("series",)
    observable: DomainLength

    def prepare(self) -> None:
        self.states = states_of(self.case, None)
        self.waves = Waves(self.case, self.observable.largest)
        self.neighbours = Neighbours(self.case)
        given = self.observable.walls
        self.least = walls_in_equilibrium(self.case) if given is None else given
        self.series = TimeSeries(PARTS + 2)

    def observe(self, engine: RunningLattice) -> None:
        sites = engine.sites().reshape(self.waves.size)
        unlike = np.zeros(sites.shape[0])
        for there, counts in self.neighbours.pairs(sites):
            unlike += ((there != sites) & counts).reshape(len(unlike), -1).sum(axis=1)
        per_site = in_parts(unlike * (len(unlike) / engine.n))
        fields = fields_of(sites, self.states)
        power = np.asarray(sum(self.waves.power(field) for field in fields))
        self.series.add(engine.time, [*per_site, *self.mean_wave(self.waves.by_ring(power))])

    def mean_wave(self, s: Array) -> tuple[float, float]:
        """Mean wave number with the weights S, and its variance if all waves are independent:
        but for those along k and -k, which are the same."""
        k, total = self.waves.mean, float(s.sum())
        if not total > 0:
            return math.nan, math.nan
        mean = float(s @ k) / total
        variance = float(((k - mean) ** 2 * s**2 * 2 / self.waves.numbers).sum()) / total**2
        return mean, variance

    def result(self) -> Result:
        time, rows = self.series.time(), self.series.values()
        value, error = np.full((2, len(time), 2), np.nan)
        walls, spread = of_parts(rows[:, :PARTS])
        known = walls > self.least
        value[known, 0] = 1 / (walls[known] - self.least)
        error[:, 0] = spread * value[:, 0] ** 2
        value[:, 1] = 2 * math.pi / rows[:, PARTS]
        error[:, 1] = np.sqrt(rows[:, -1] / self.series.series) * value[:, 1] / rows[:, PARTS]
        expected, note = domain_length(self.case, time)
        if expected is not None:
            expected = np.stack([expected, np.full(len(time), np.nan)], axis=1)
        return self.report(
            {"time": time, "measured by": ROUTES},
            (value, error),
            self.comparisons(time, rows, value, error),
            samples=len(time),
            expected=expected,
            theory=note,
        )

    def comparisons(
        self, time: Array, rows: Array, value: Array, error: Array
    ) -> Iterator[Comparison]:
        """Exponents of both lengths, and the last ones."""
        if len(time) < 2:
            return
        known, note = domain_exponent(self.case)
        if (found := late_exponent(time, rows[:, :PARTS], -1.0, self.least)) is not None:
            yield Comparison("exponent of the length from walls", *found, known, "", note)
        waves = np.repeat(rows[:, PARTS : PARTS + 1], PARTS, axis=1)
        if (found := late_exponent(time, waves, -1.0)) is not None:
            what = "exponent of the length from waves"
            yield Comparison(what, found[0], math.nan, known, "", note)
        expected, note = domain_length(self.case, time[-1:])
        wanted = math.nan if expected is None else expected[0]
        last = value[-1], error[-1]
        yield Comparison("last length from walls", last[0][0], last[1][0], wanted, "a", note)
        yield Comparison("last length from waves", last[0][1], last[1][1], unit="a")
