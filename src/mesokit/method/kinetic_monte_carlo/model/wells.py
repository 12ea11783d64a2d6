"""Walkers that jump from well to well over barriers (Kramers 1940)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

import numpy as np
from pydantic import model_validator

from mesokit import theory
from mesokit.case.amounts import number
from mesokit.case.case import Case
from mesokit.case.component import component, one_of, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.model.alone import rates_alone
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies, Known
from mesokit.method.kinetic_monte_carlo.model.table import Process, TableModel
from mesokit.method.kinetic_monte_carlo.start import sites_of
from mesokit.seam.method import Row

MOST = 200
BOTH, ONE = "<->", "->"
TELL = 8  # residence times that `mesokit check` tells one by one
NOTE = "steady state of the master equation"


@component
class Well:
    """A well: a minimum of the energy."""

    name: str = param(doc="name in results", min_length=1)
    energy: float = param(0.0, doc="energy at its bottom", unit="energy", ge=-1e300, le=1e300)


@component
class Link:
    """A way between two wells, with a barrier, or with a rate.

    Over a barrier the rate from a well with energy E is attempt_rate exp(-(barrier - E)/kT).
    """

    hop: str = param(doc="its wells, such as 'left <-> right'; 'left -> right' goes one way")
    barrier: float | None = param(
        None, doc="energy at its top, above the 0 of the wells' energies", unit="energy", le=1e300
    )
    attempt_rate: float = param(
        1.0, doc="rate without a barrier", symbol="nu_0", unit="1/time", gt=0, le=1e300
    )
    rate: float | None = param(
        None, doc="of the hop, in place of a barrier", unit="1/time", gt=0, le=1e300
    )

    @model_validator(mode="after")
    def _barrier_or_rate(self) -> Link:
        if (self.barrier is None) == (self.rate is None):
            raise ValueError(f"hop = {show(self.hop)}: expected barrier or rate, one of both")
        return self


@component
class Ring:
    """A periodic row of equal wells, named by their numbers from 0."""

    wells: int = param(doc="how many", ge=3, le=MOST)
    barrier: float = param(doc="energy between neighbouring wells", unit="energy", ge=0, le=1e300)
    attempt_rate: float = param(
        1.0, doc="rate without a barrier", symbol="nu_0", unit="1/time", gt=0, le=1e300
    )
    tilt: float = param(
        0.0, doc="energy that a hop forward loses and one backward needs", unit="energy"
    )

    @model_validator(mode="after")
    def _wells_remain(self) -> Ring:
        if abs(self.tilt) > 2 * self.barrier:
            raise ValueError(
                f"tilt = {show(self.tilt)}: expected at most twice the barrier of "
                f"{show(self.barrier)}, for wells to remain"
            )
        return self


@component
class Wells(TableModel):
    """Walkers, one at each site of the lattice, whose state is the well that they are in.

    They do not feel one another, so the kind of the lattice does not matter. All wells and the
    links between them are told one by one, or make a ring.
    """

    rule: Literal["wells"] = tag("wells")
    well: Many[Well] = param((), doc="the wells, 2 or more", max_length=MOST)
    link: Many[Link] = param((), doc="ways between two of them")
    ring: Ring | None = param(None, doc="a periodic row, in place of wells and links")
    kT: float = param(1.0, doc="thermal energy", unit="energy", gt=0)

    @model_validator(mode="after")
    def _wells_and_links(self) -> Wells:
        if self.ring is not None:
            if self.well or self.link:
                raise ValueError("ring: it has its wells; leave out well and link")
            return self
        names = [one.name for one in self.well]
        if len(names) == 1:
            raise ValueError("well: expected 2 or more, or a ring, not 1")
        for k, name in enumerate(names):
            if names.index(name) < k:
                raise ValueError(f"well[#{k + 1}].name = {show(name)}: expected a name of its own")
        hops: set[tuple[int, int]] = set()
        for k, one in enumerate(self.link):
            for hop in self._hops(f"link[#{k + 1}]", one, names):
                if hop in hops:
                    raise ValueError(
                        f"link[#{k + 1}].hop = {show(one.hop)}: a second way from "
                        f"{show(names[hop[0]])} to {show(names[hop[1]])}; expected one"
                    )
                hops.add(hop)
        return self

    def _hops(self, key: str, one: Link, names: Sequence[str]) -> list[tuple[int, int]]:
        """The hops (from, to) of a link."""
        arrow = BOTH if BOTH in one.hop else ONE
        ends = [part.strip() for part in one.hop.split(arrow)]
        if len(ends) != 2:
            raise ValueError(f"{key}.hop = {show(one.hop)}: expected 'well <-> well'")
        for end in ends:
            if end not in names:
                raise ValueError(f"{key}.hop = {show(one.hop)}: expected two of {one_of(names)}")
        here, there = map(names.index, ends)
        if here == there:
            raise ValueError(f"{key}.hop = {show(one.hop)}: expected two different wells")
        highest = max(self.well[here].energy, self.well[there].energy)
        if one.barrier is not None and one.barrier < highest:
            raise ValueError(
                f"{key}.barrier = {show(one.barrier)}: below a well at {show(highest)}; expected "
                "the energy at the top"
            )
        return [(here, there), (there, here)] if arrow == BOTH else [(here, there)]

    def check(self, case: Case) -> None:
        """Raise CaseError without wells."""
        if not self.well and self.ring is None:
            raise CaseError("lattice.model.well: expected 2 or more, or a ring, not 0")

    def states(self) -> tuple[str, ...]:
        if self.ring is not None:
            return tuple(map(str, range(self.ring.wells)))
        return tuple(one.name for one in self.well)

    def _rates(self) -> Iterator[tuple[int, int, float]]:
        """Hops: the wells before and after, and the rate."""
        if self.ring is not None:
            for k in range(self.ring.wells):
                for step in (1, -1):
                    top = self.ring.barrier - 0.5 * step * self.ring.tilt
                    yield k, (k + step) % self.ring.wells, self._over(self.ring.attempt_rate, top)
            return
        names = self.states()
        for one in self.link:
            for here, there in self._hops("link", one, names):
                top = (one.barrier or 0.0) - self.well[here].energy
                yield here, there, one.rate or self._over(one.attempt_rate, top)

    def _over(self, attempt_rate: float, top: float) -> float:
        return attempt_rate * math.exp(-top / self.kT)

    def processes(self) -> list[Process]:
        """Hops from well to well."""
        names = self.states()
        return [
            Process(f"{names[here]} to {names[there]}", (here, there), rate)
            for here, there, rate in self._rates()
        ]

    def energies(self) -> Energies | None:
        """Energies of the wells; None where rates are given, or where a ring is tilted."""
        count = len(self.states())
        if (self.ring and self.ring.tilt) or any(one.rate is not None for one in self.link):
            return None
        sites = [0.0] * count if self.ring else [one.energy for one in self.well]
        return Energies(np.array(sites), np.zeros((count, count)))

    def derived(self, case: Case) -> list[Row]:
        """Mean times in wells, and the slowest relaxation."""
        rates = rates_alone(self)
        assert rates is not None
        leaving, names = rates.sum(axis=1), self.states()
        rows: list[Row] = []
        if len(names) <= TELL:
            for name, out in zip(names, leaving, strict=True):
                stays = number(1 / out, "time") if out > 0 else "for ever"
                rows.append((f"time in {name}", stays, "mean until the next hop"))
        slowest = theory.slowest_relaxation(rates)
        if math.isfinite(slowest):
            rows.append(("relaxation time", number(slowest, "time"), "of occupations, the slowest"))
        return rows

    def expected(self, case: Case) -> Mapping[str, Known]:
        """Occupations, hops and energies in the steady state, whatever the start."""
        rates = rates_alone(self)
        assert rates is not None
        parts = theory.steady_occupation(rates)
        if np.isnan(parts).any():
            return {}
        names, energies = self.states(), self.energies()
        found = {
            f"part {name}": (float(part), NOTE) for name, part in zip(names, parts, strict=True)
        }
        for here, there, rate in self._rates():
            hops = float(parts[here] * rate)
            found[f"rate of {names[here]} to {names[there]}"] = hops, NOTE
        if energies is not None:
            mean = float(parts @ energies.site)
            spread = float(parts @ (energies.site - mean) ** 2)
            found["energy"] = mean, NOTE
            found["square energy"] = mean**2 + spread / sites_of(case), NOTE
        return found
