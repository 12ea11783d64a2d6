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
from mesokit.method.kinetic_monte_carlo.model.table import TableModel

Array = NDArray[np.floating[Any]]
SIDE = 6  # sites along each axis of a patch in which a particle is alone
DILUTE = 0.05  # part of the sites up to which particles are as if they were alone
HOPS = 30.0  # between two particles, after which a single file is seen
FINITE = 0.05  # of a single file, that part which all particles of a ring move together
ALONE = "approximate: alone"


class Walk(NamedTuple):
    """A particle alone among sites in the first state.

    rate: of all its hops. drift: its mean velocity (d,). only: whether nothing else can happen.
    """

    rate: float
    drift: NDArray[np.float64]
    only: bool


def walk(case: Case, state: int) -> Walk | None:
    """How a particle in a state moves where it is alone; None where moves cannot be listed."""
    kind, model = case.lattice.lattice, case.lattice.model
    moves = model.list_moves(kind)
    if moves is None:
        return None
    d, behind, size = kind.dimension, 0 if state else 1, (SIDE,) * kind.dimension
    places = kind.places(size)
    rate, drift, only = 0.0, np.zeros(d), len(model.states()) == 2
    # two sites in the middle, next to each other along the last axis: one of each parity
    first = SIDE // 2 * int(sum(SIDE**k for k in range(d)))
    starts = first, first + 1
    for start in starts:
        states = [behind] * len(places)
        states[start] = state
        patch = patch_of(kind, size, (False,) * d, states)
        for i in range(len(places)):
            for move in moves.at(patch, i):
                after = patch.after(move.changes)
                if after == patch:
                    continue
                there = [k for k, s in enumerate(after.states) if s != behind]
                if len(there) == 1 and after.states[there[0]] == state:
                    rate += move.rate / len(starts)
                    drift += move.rate * (places[there[0]] - places[start]) / len(starts)
                else:
                    only = False
    return Walk(rate, np.where(abs(drift) > 1e-12 * rate, drift, 0.0), only)


class Tracers:
    """Theory of particles in a state, of which there were so many when measuring began."""

    def __init__(self, case: Case, state: int, number: float) -> None:
        self.case, self.number = case, number
        self.sites = int(np.prod(case.box.size))
        self.ring = ring_of_particles(case) and state == 1 and number > 1
        known = not case.lattice.ends and (self.ring or number <= max(1, DILUTE * self.sites))
        self.walk = walk(case, state) if known else None
        self.note = "" if self.walk and self.walk.only and number <= 1 else ALONE

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
        if self.walk is None or (self.ring and self.drifts):
            return None, ""
        if not self.ring:
            square = self.walk.rate * time + (self.walk.drift @ self.walk.drift) * time**2
            return square, self.note or "a lone walker"
        part, rate = self.number / self.sites, self.walk.rate / 2
        seen = rate * time * part**2 > HOPS * (1 - part) ** 2
        seen &= np.sqrt(math.pi * rate * time) < FINITE * self.sites
        known = np.full(len(time), np.nan)
        known[seen] = theory.single_file_displacement(time[seen], part, rate)
        return (known if seen.any() else None), "approximate: a long single file (Arratia 1983)"


def leaving_rate(case: Case, state: int) -> float:
    """Rate at which a site leaves a state; nan where it depends on what is around the site."""
    model, rate = case.lattice.model, 0.0
    if not isinstance(model, TableModel):
        return math.nan
    for one in model.processes():
        by_itself = one.site[0] == state != one.site[1]
        to = one.neighbour
        beside = to is not None and state in to[0] and to[1] != state
        if (by_itself and (to is not None or one.counted)) or beside:
            if not callable(one.rate) and one.rate == 0:
                continue
            return math.nan
        if by_itself:
            rate += one.rate([0] * (len(model.states()) + 1)) if callable(one.rate) else one.rate
    return rate or math.nan
