"""The Potts model: spins with several directions, of which those that are alike attract."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Literal

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies, Known
from mesokit.method.kinetic_monte_carlo.model.spins import SpinModel, acceptance
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process

CRITICAL = 1e-4  # relative distance from the critical temperature that is none


@component
class Potts(SpinModel):
    """Sites in one of q states, with the energy -J for each pair of neighbours in the same.

    A site turns to each of the others with the rate attempt_rate/(q - 1) times that of Metropolis
    or Glauber (see `Ising`). Source: R. B. Potts, Math. Proc. Camb. Phil. Soc. 48, 106 (1952).
    """

    rule: Literal["potts"] = tag("potts")
    q: int = param(3, doc="states of a site", symbol="q", ge=2, le=4)
    coupling: float = param(1.0, doc="energy gained by alike neighbours", symbol="J", unit="energy")
    kT: float = param(1.0, doc="thermal energy; 0: nothing raises the energy", unit="energy", ge=0)
    moves: Literal["turn", "exchange"] = param(
        "turn", doc="sites turn, or neighbours exchange their states (Kawasaki 1966)"
    )
    dynamics: Literal["metropolis", "glauber"] = param("metropolis", doc="rate of a turn")
    attempt_rate: float = param(1.0, doc="largest rate of turns", unit="1/time", gt=0)

    def states(self) -> tuple[str, ...]:
        return tuple(f"state {k}" for k in range(self.q))

    def processes(self) -> list[Process]:
        """Turns from each state to each other."""
        return [
            Process(f"{one} to {other}", (one, other), self._rate(one, other), ((one,), (other,)))
            for one in range(self.q)
            for other in range(self.q)
            if one != other
        ]

    def _rate(self, one: int, other: int) -> Callable[[Counts], float]:
        often = self.attempt_rate / (self.q - 1)

        def rate(counts: Counts) -> float:
            change = self.coupling * (counts[one] - counts[other])
            return often * acceptance(self.dynamics, change, self.kT)

        return rate

    def energies(self) -> Energies:
        return Energies(np.zeros(self.q), -self.coupling * np.eye(self.q))

    def expected(self, case: Case) -> Mapping[str, Known]:
        """Energy of an infinite square lattice: of two states, or at the critical temperature."""
        plain = self.moves == "turn" and not case.lattice.ends and self.coupling > 0 < self.kT
        if not plain or case.lattice.kind != "square":
            return {}
        if self.q == 2:  # spins with half the coupling
            energy = theory.onsager_energy(0.5 * self.coupling, self.kT) - self.coupling
            reach = theory.spin_correlation_length(0.5 * self.coupling, self.kT, 2)
            return {
                "energy": (energy, "an infinite lattice (Onsager 1944)"),
                "correlation length": (reach, "an infinite lattice (McCoy, Wu 1973)"),
            }
        critical, there = theory.potts_critical_energy(self.coupling, self.q)
        if abs(self.kT / critical - 1) < CRITICAL:
            note = "approximate: an infinite lattice at its critical temperature"
            return {"energy": (there, note), "correlation length": (math.inf, note)}
        return {}
