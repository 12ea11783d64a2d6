"""Solid on solid: atoms that come down, hop over the surface, and leave it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Literal

from pydantic import model_validator

from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.lattice.patch import Patch
from mesokit.method.kinetic_monte_carlo.model.heights import (
    AT_LEAST_AS_HIGH,
    LEVEL,
    Growth,
    HeightModel,
)
from mesokit.method.kinetic_monte_carlo.model.hop import diffusion_rows
from mesokit.method.kinetic_monte_carlo.model.protocol import Known, over_pairs
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process
from mesokit.seam.method import Row

DOWN = tuple(range(LEVEL - 1))  # columns two atoms lower or more: a hop onto one loses a level


@component
class SolidOnSolid(HeightModel):
    """A surface without overhangs: the top atom of each column hops to the columns beside.

    With m neighbours beside it the rate of its hops, over all directions, is attempt_rate
    exp(-(substrate_energy + m bond_energy) / kT); hops down a step have the barrier `step_barrier`
    in addition (Ehrlich and Hudda 1966, Schwoebel 1969). Without deposition and step barrier it is
    in detailed balance with the energy (bond_energy/2) sum |dh| over pairs of neighbours.
    """

    rule: Literal["solid-on-solid"] = tag("solid-on-solid")
    flux: float = param(0.0, doc="atoms that come down on a site", symbol="F", unit="1/time", ge=0)
    attempt_rate: float = param(1.0, doc="hops without a barrier", unit="1/time", ge=0)
    substrate_energy: float = param(0.0, doc="barrier of a lone atom", unit="energy", ge=0)
    bond_energy: float = param(1.0, doc="of a bond to an atom beside", unit="energy", ge=0)
    step_barrier: float = param(0.0, doc="added for a hop down a step", unit="energy", ge=0)
    evaporate: bool = param(
        False, doc="true: atoms leave the surface, at the rate of their hops, instead of hopping"
    )
    kT: float = param(1.0, doc="thermal energy", unit="energy", gt=0)

    @model_validator(mode="after")
    def _barrier_of_hops(self) -> SolidOnSolid:
        if self.evaporate and self.step_barrier:
            raise ValueError(
                f"step_barrier = {show(self.step_barrier)}: only of hops, not with evaporate"
            )
        return self

    def growth(self, kind: Kind) -> list[Growth]:
        """Deposition, hops and evaporation."""
        bonds = (AT_LEAST_AS_HIGH,)
        found = [Growth(Process("deposit", (0, 0), self.flux), 1)]
        if self.evaporate:
            leaves = Process("evaporate", (0, 0), self._rate(1, 0.0), bonds)
            return [*found, Growth(leaves, -1)]
        others = tuple(b for b in range(2 * LEVEL + 1) if b not in DOWN)
        level = Process("hop", (0, 0), self._rate(kind.neighbours, 0.0), bonds, (others, 0))
        down = self._rate(kind.neighbours, self.step_barrier)
        return [
            *found,
            Growth(level, -1, 1),
            Growth(Process("hop down", (0, 0), down, bonds, (DOWN, 0)), -1, 1),
        ]

    def _rate(self, directions: int, more: float) -> Callable[[Counts], float]:
        def rate(counts: Counts) -> float:
            beside = counts[LEVEL]  # and higher
            barrier = self.substrate_energy + beside * self.bond_energy + more
            return self.attempt_rate * math.exp(-barrier / self.kT) / directions

        return rate

    def energy(self) -> Callable[[Patch], float] | None:
        """That of the bonds between columns; None if atoms leave the surface."""
        if self.evaporate:
            return None
        return lambda patch: over_pairs(patch, lambda a, b: -self.bond_energy * min(a, b))

    def derived(self, case: Case) -> Sequence[Row]:
        """Diffusion of a lone atom, whose rate is that over all directions."""
        kind = case.lattice.lattice
        rate = self.attempt_rate * math.exp(-self.substrate_energy / self.kT)
        return () if self.evaporate else diffusion_rows(kind, rate / kind.neighbours, self.flux)

    def expected(self, case: Case) -> Mapping[str, Known]:
        """The speed at which atoms come down that only hop."""
        return {} if self.evaporate else {"speed of growth": (self.flux, "all atoms stay")}
