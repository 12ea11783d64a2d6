"""The Ising model, with spins that flip."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Literal

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.lattice.grid import by_number, grid_of, neighbour
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies, Known
from mesokit.method.kinetic_monte_carlo.model.spins import SpinModel
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process
from mesokit.method.kinetic_monte_carlo.start import sites_of

DOWN, UP = 0, 1
FEW = 16  # spins, of which all states are counted


@component
class Ising(SpinModel):
    """Spins s = -1 or 1 with the energy -J sum s s' - h sum s, over pairs of neighbours and sites.

    What happens has a rate that follows from the change of energy dE: with "metropolis"
    min(1, exp(-dE/kT)) (Metropolis et al. 1953), with "glauber" 1 / (1 + exp(dE/kT)) (Glauber
    1963), times `attempt_rate`.
    """

    rule: Literal["ising"] = tag("ising")
    coupling: float = param(
        1.0, doc="energy of two neighbours, -J if alike", symbol="J", unit="energy"
    )
    field: float = param(0.0, doc="energy of a spin in the field", symbol="h", unit="energy")
    kT: float = param(1.0, doc="thermal energy; 0: nothing raises the energy", unit="energy", ge=0)
    moves: Literal["flip", "exchange"] = param(
        "flip", doc="sites flip, or neighbours exchange their states (Kawasaki 1966)"
    )
    dynamics: Literal["metropolis", "glauber"] = param("metropolis", doc="rate of a move")
    attempt_rate: float = param(1.0, doc="largest rate of a move", unit="1/time", gt=0)

    def states(self) -> tuple[str, ...]:
        return "down", "up"

    def processes(self) -> list[Process]:
        """Flips up and down."""
        return [
            Process("up", (DOWN, UP), self._rate(DOWN), ((DOWN,), (UP,))),
            Process("down", (UP, DOWN), self._rate(UP), ((DOWN,), (UP,))),
        ]

    def _rate(self, state: int) -> Callable[[Counts], float]:
        spin = 2 * state - 1

        def rate(counts: Counts) -> float:
            around = counts[UP] - counts[DOWN]
            change = 2.0 * spin * (self.coupling * around + self.field)
            return self.accepted(change)

        return rate

    def energies(self) -> Energies:
        spins = np.array([-1.0, 1.0])
        return Energies(-self.field * spins, -self.coupling * np.outer(spins, spins))

    def expected(self, case: Case) -> Mapping[str, Known]:
        """Means in equilibrium: of few spins exactly, else of a ring or an infinite square.

        Spins that are exchanged keep their sum, which these theories do not.
        """
        if self.kT <= 0 or self.moves == "exchange":
            return {}
        if sites_of(case) <= FEW:
            return {name: (value, "all states counted") for name, value in _counted(case).items()}
        if self.field or case.lattice.ends or self.coupling <= 0:
            return {}
        if case.lattice.kind == "chain":
            energy = theory.chain_energy(self.coupling, self.kT, sites_of(case))
            reach = theory.spin_correlation_length(self.coupling, self.kT, 1)
            return {
                "energy": (energy, "a ring of spins"),
                "correlation length": (reach, "an infinite chain"),
            }
        if case.lattice.kind != "square":
            return {}
        note = "an infinite lattice (Onsager 1944, Yang 1952)"
        reach = theory.spin_correlation_length(self.coupling, self.kT, 2)
        found = {
            "energy": (theory.onsager_energy(self.coupling, self.kT), note),
            "correlation length": (reach, "an infinite lattice (McCoy, Wu 1973)"),
        }
        ordered = theory.yang_magnetisation(self.coupling, self.kT)
        if ordered > 0:
            found["size"] = ordered, f"approximate: {note}"
            found["square"] = ordered**2, f"approximate: {note}"
        return found


@functools.lru_cache(maxsize=8)
def _counted(case: Case) -> dict[str, float]:
    """Exact means of a few spins."""
    model, kind = case.lattice.model, case.lattice.lattice
    closed = tuple(axis in case.lattice.ends for axis in case.box.axes)
    grid = grid_of(kind, tuple(map(int, case.box.size)), closed)
    places = by_number(grid)
    number = {int(place): k for k, place in enumerate(places)}
    pairs = [
        (k, number[int(found)])
        for k, place in enumerate(places)
        for direction in range(kind.neighbours)
        if (found := neighbour(grid, int(place), direction)) >= 0
    ]
    bonds = np.array(sorted(pairs)).reshape(-1, 2)
    # each bond is there from both ends: half of them each
    return theory.counted_spins(bonds, len(places), 0.5 * model.coupling, model.field, model.kT)
