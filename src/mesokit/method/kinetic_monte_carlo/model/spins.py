"""What models of spins share: rates by the change of energy, and exchanges of neighbours."""

from __future__ import annotations

import math
from abc import ABC
from typing import Any

from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.exchange import NAME, exchange_moves, exchanges
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies, Moves
from mesokit.method.kinetic_monte_carlo.model.table import TableModel


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


class SpinModel(TableModel, ABC):
    """Spins whose states change one by one, or are exchanged by neighbours (Kawasaki 1966).

    Models have these keys: how spins move, the thermal energy, and rates of moves.
    """

    moves: str
    kT: float
    dynamics: str
    attempt_rate: float

    def kernel(self, kind: Kind, ends: bool) -> Any:
        """The table of what may happen."""
        if self.exchanged():
            return exchanges(self.pairs(), self.accepted, kind, ends)
        return super().kernel(kind, ends)

    def list_moves(self, kind: Kind) -> Moves | None:
        """What may happen, in plain Python."""
        if self.exchanged():
            return exchange_moves(self.pairs(), self.accepted)
        return super().list_moves(kind)

    def events(self) -> list[str]:
        """Names of what may happen."""
        return [NAME] if self.exchanged() else super().events()

    def exchanged(self) -> bool:
        """Whether neighbours exchange their states."""
        return self.moves == NAME

    def accepted(self, change: float) -> float:
        """The rate of a change of energy."""
        return self.attempt_rate * acceptance(self.dynamics, change, self.kT)

    def pairs(self) -> Energies:
        """Energies of sites and of pairs of neighbours."""
        found = self.energies()
        if found is None:
            raise CaseError("lattice.model: exchanges need energies")
        return found
