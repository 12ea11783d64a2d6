"""Islands in the submonolayer: atoms come down, diffuse, and stick to each other."""

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.model.hop import ATOM, EMPTY, diffusion_rows, hop
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies
from mesokit.method.kinetic_monte_carlo.model.table import Process, TableModel
from mesokit.seam.method import Row


@component
class Islands(TableModel):
    """Atoms that come down on empty sites, and hop until they meet others.

    An atom with n neighbours hops with the rate hop_rate bond_factor^n to each empty site beside
    it. With bond_factor = 0 two atoms that meet are an island that never breaks (critical size 1):
    the number of islands grows with the cube root of flux/hop_rate. With exp(-bond/kT) bonds break.
    Source: J. G. Amar, F. Family and P.-M. Lam, Phys. Rev. B 50, 8781 (1994).
    """

    rule: Literal["islands"] = tag("islands")
    flux: float = param(
        1e-4, doc="atoms that come down on an empty site", symbol="F", unit="1/time", ge=0
    )
    hop_rate: float = param(1.0, doc="hops of a lone atom to each neighbour", unit="1/time", gt=0)
    bond_factor: float = param(
        0.0, doc="of the rate of hops, for each neighbour; 0: bonds never break", ge=0, le=1
    )

    def states(self) -> tuple[str, ...]:
        return "empty", "atom"

    def processes(self) -> list[Process]:
        """Deposition and hops."""
        hops = hop(lambda bonds: self.hop_rate * self.bond_factor**bonds)
        return [Process("deposit", (EMPTY, ATOM), self.flux), hops] if self.flux else [hops]

    def energies(self) -> Energies | None:
        """That of bonds, in kT; none where they never break."""
        if not self.bond_factor:
            return None
        return Energies(np.zeros(2), np.diag([0.0, math.log(self.bond_factor)]))

    def derived(self, case: Case) -> Sequence[Row]:
        return diffusion_rows(case.lattice.lattice, self.hop_rate, self.flux)
