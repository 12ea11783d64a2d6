"""Sintering: atoms of grains that hop along their surfaces, so that a neck grows between them."""

import math
from typing import Literal

import numpy as np

from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.model.hop import hop
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies
from mesokit.method.kinetic_monte_carlo.model.table import Process, TableModel


@component
class Sintering(TableModel):
    """Atoms of a crystal, and pores between its grains.

    An atom with n neighbours hops to each empty site beside it with the rate attempt_rate
    exp(-n bond_energy/kT). Atoms are neither made nor lost, and the energy is -bond_energy for each
    pair of neighbours: grains that touch join, so that their surface becomes smaller. Atoms at
    edges move fastest on a triangular or fcc lattice, where they need not leave the surface.
    Source: the rates of H. C. Kang and W. H. Weinberg, J. Chem. Phys. 90, 2824 (1989).
    """

    rule: Literal["sintering"] = tag("sintering")
    attempt_rate: float = param(
        1.0, doc="hops to each neighbour, without a barrier", unit="1/time", gt=0, le=1e300
    )
    bond_energy: float = param(1.0, doc="of a bond between two atoms", unit="energy", ge=0)
    kT: float = param(1.0, doc="thermal energy", unit="energy", gt=0)

    def states(self) -> tuple[str, ...]:
        return "pore", "atom"

    def processes(self) -> list[Process]:
        """Hops."""
        return [
            hop(lambda bonds: self.attempt_rate * math.exp(-bonds * self.bond_energy / self.kT))
        ]

    def energies(self) -> Energies:
        return Energies(np.zeros(2), np.diag([0.0, -self.bond_energy]))
