"""The Ising model, with spins that flip."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.exchange import NAME as EXCHANGE
from mesokit.method.kinetic_monte_carlo.model.exchange import exchanges
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process, TableModel

DOWN, UP = 0, 1


@component
class Ising(TableModel):
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

    def kernel(self, kind: Kind, ends: bool) -> Any:
        """The table of what may happen."""
        if self.moves == "exchange":
            return exchanges(
                self.energies(),
                lambda change: self.attempt_rate * acceptance(self.dynamics, change, self.kT),
                kind,
                ends,
            )
        return super().kernel(kind, ends)

    def events(self) -> list[str]:
        """Names of what may happen."""
        return [EXCHANGE] if self.moves == "exchange" else super().events()

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
            return self.attempt_rate * acceptance(self.dynamics, change, self.kT)

        return rate

    def energies(self) -> Energies:
        spins = np.array([-1.0, 1.0])
        return Energies(-self.field * spins, -self.coupling * np.outer(spins, spins))


def acceptance(dynamics: str, change: float, kT: float) -> float:
    """Rate of a change of energy over the largest one, in detailed balance.

    >>> acceptance("metropolis", -1.0, 0.0), acceptance("glauber", 0.0, 1.0)
    (1.0, 0.5)
    """
    if dynamics == "metropolis":
        return 1.0 if change <= 0 else math.exp(-change / kT) if kT > 0 else 0.0
    if kT > 0:
        return 1.0 / (1.0 + math.exp(min(change / kT, 700.0)))
    return 0.5 if change == 0 else float(change < 0)
