"""What theory predicts of particles that are followed, and of how long sites keep their states."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.expected import Known
from mesokit.method.kinetic_monte_carlo.expected_structure import ring_of_particles
from mesokit.method.kinetic_monte_carlo.lattice.patch import patch_of
from mesokit.method.kinetic_monte_carlo.model.alone import rates_alone
from mesokit.method.kinetic_monte_carlo.model.table import TableModel

Array = NDArray[np.floating[Any]]
SIDE = 6  # sites along each axis of a patch in which a particle is alone
DILUTE = 0.05  # part of the sites up to which particles are as if they were alone
HOPS = 30.0  # between two particles, after which a single file is seen
FINITE = 0.05  # of a single file, that part which all particles of a ring move together
ALONE = "approximate: alone"


class Walk(NamedTuple):
    """A particle alone among sites in the state behind.

    rate: of all its hops. drift: its mean velocity (d,). only: whether nothing else can happen.
    """

    rate: float
    drift: NDArray[np.float64]
    only: bool


def behind(state: int) -> int:
    """The state of the sites that particles in a state move among: the first one, unless it is
    that of the particles."""
    return 0 if state else 1


def walk(case: Case, state: int) -> Walk | None:
    """How a particle in a state moves where it is alone; None where moves cannot be listed."""
    kind, model = case.lattice.lattice, case.lattice.model
    moves = model.list_moves(kind)
    if moves is None:
        return None
    d, size = kind.dimension, (SIDE,) * kind.dimension
    places = kind.places(size)
    rate, drift, only = 0.0, np.zeros(d), True
    # two sites in the middle, next to each other along the last axis: one of each parity
    first = SIDE // 2 * int(sum(SIDE**k for k in range(d)))
    starts = first, first + 1
    for start in starts:
        states = [behind(state)] * len(places)
        states[start] = state
        patch = patch_of(kind, size, (False,) * d, states)
        for i in range(len(places)):
            for move in moves.at(patch, i):
                after = patch.after(move.changes)
                if after == patch:
                    continue
                there = [k for k, s in enumerate(after.states) if s != behind(state)]
                if len(there) == 1 and after.states[there[0]] == state:
                    rate += move.rate / len(starts)
                    drift += move.rate * (places[there[0]] - places[start]) / len(starts)
                else:
                    only = False
    return Walk(rate, np.where(abs(drift) > 1e-12 * rate, drift, 0.0), only)


class Tracers:
    """Theory of particles in a state.

    When measuring began there were so many of them, and so many sites not in the state behind.
    """

    def __init__(self, case: Case, state: int, number: float, others: float) -> None:
        self.case, self.number = case, number
        self.sites = int(np.prod(case.box.size))
        self.ring = ring_of_particles(case) and state == 1 and number > 1
        dilute = others <= max(1, DILUTE * self.sites)
        found = walk(case, state) if self.ring or (dilute and not case.lattice.ends) else None
        self.walk = found if found and found.rate else None
        self.note = "" if self.walk and self.walk.only and others <= 1 else ALONE

    @property
    def drifts(self) -> bool:
        """Whether particles have a mean velocity."""
        return self.walk is not None and bool(self.walk.drift.any())

    def diffusion(self) -> Known:
        """Diffusion coefficient; nan in a single file, where particles do not pass each other."""
        if self.walk is None or self.ring or self.drifts:
            return math.nan, ""
        return self.walk.rate / (2 * len(self.walk.drift)), self.note

    def drift(self) -> tuple[NDArray[np.float64], str]:
        """Mean velocity (d,)."""
        if self.walk is None:
            return np.full(len(self.case.box.size), math.nan), ""
        if self.ring:  # current over density
            free = (self.sites - self.number) / (self.sites - 1)
            return self.walk.drift * free, "all states alike"
        return self.walk.drift, self.note if self.walk.drift.any() else ""

    def displacement(self, time: Array) -> tuple[Array | None, str]:
        """Mean square displacement at lags."""
        if self.walk is None:
            return None, ""
        drift, _ = self.drift()
        square = (drift @ drift) * time**2
        if not self.ring:
            return self.walk.rate * time + square, "a lone walker"
        if self.drifts:
            return square, "drift alone"
        part, rate = self.number / self.sites, self.walk.rate / 2
        seen = rate * time * part**2 > HOPS * (1 - part) ** 2
        seen &= np.sqrt(math.pi * rate * time) < FINITE * self.sites
        known = np.full(len(time), np.nan)
        known[seen] = theory.single_file_displacement(time[seen], part, rate)
        return (known if seen.any() else None), "a long single file (Arratia 1983)"


def exchanges(case: Case, state: int) -> bool:
    """Whether anything moves a particle in a state to a neighbour."""
    model = case.lattice.model
    if getattr(model, "moves", "") == "exchange" or not isinstance(model, TableModel):
        return True
    return any(
        one.neighbour is not None
        and one.site[0] != one.site[1]
        and state in one.site
        and one.site[1] in one.neighbour[0]
        and one.site[0] == one.neighbour[1]
        for one in model.processes()
    )


def leaving_rate(case: Case, state: int) -> float:
    """Rate at which a site leaves a state; nan where it depends on what is around the site."""
    rates = rates_alone(case.lattice.model)
    return math.nan if rates is None else float(rates[state].sum()) or math.nan
