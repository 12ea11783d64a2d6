"""Surface diffusion: adatoms that hop from site to site of a crystal, and attract each other."""

import math
from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.model.hop import ATOM, EMPTY, diffusion_rows, hop
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies, Known
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process, TableModel
from mesokit.seam.method import Row


@component
class SurfaceDiffusion(TableModel):
    """Sites that are empty or have one adatom.

    An adatom with n neighbours hops to each empty site beside it with the rate attempt_rate
    exp(-(substrate_energy + n bond_energy)/kT), and leaves the surface with the rate
    desorption_rate exp(-n bond_energy/kT). The diffusion coefficient of a lone adatom is its rate
    times z a^2/2d, with z neighbours in d dimensions: times a^2 on a chain, a square and a cubic
    lattice. Source: H. C. Kang and W. H. Weinberg, J. Chem. Phys. 90, 2824 (1989).
    """

    rule: Literal["surface-diffusion"] = tag("surface-diffusion")
    attempt_rate: float = param(
        1.0, doc="hops to each neighbour, without a barrier", unit="1/time", ge=0, le=1e300
    )
    substrate_energy: float = param(0.0, doc="barrier of a lone adatom", unit="energy", ge=0)
    bond_energy: float = param(
        0.0, doc="of a bond to an adatom beside; negative if adatoms repel", unit="energy"
    )
    flux: float = param(
        0.0, doc="adatoms that come down on an empty site", symbol="F", unit="1/time", ge=0
    )
    desorption_rate: float = param(
        0.0, doc="rate at which a lone adatom leaves", unit="1/time", ge=0
    )
    kT: float = param(1.0, doc="thermal energy", unit="energy", gt=0)

    def states(self) -> tuple[str, ...]:
        return "empty", "adatom"

    def processes(self) -> list[Process]:
        """Adsorption, hops and desorption."""
        every = [
            (self.flux, Process("adsorb", (EMPTY, ATOM), self.flux)),
            (self.attempt_rate, hop(self._hops)),
            (
                self.desorption_rate,
                Process("desorb", (ATOM, EMPTY), self._leaves, ((ATOM,),)),
            ),
        ]
        return [process for rate, process in every if rate]

    def _hops(self, bonds: int) -> float:
        barrier = self.substrate_energy + bonds * self.bond_energy
        return self.attempt_rate * math.exp(-barrier / self.kT)

    def _leaves(self, counts: Counts) -> float:
        return self.desorption_rate * math.exp(-counts[ATOM] * self.bond_energy / self.kT)

    def energies(self) -> Energies:
        """That of bonds, and of an adatom against the gas that it comes from."""
        from_gas = 0.0
        if self.flux and self.desorption_rate:
            from_gas = -self.kT * math.log(self.flux / self.desorption_rate)
        return Energies(np.array([0.0, from_gas]), np.diag([0.0, -self.bond_energy]))

    def derived(self, case: Case) -> Sequence[Row]:
        return diffusion_rows(case.lattice.lattice, self._hops(0), self.flux)

    def expected(self, case: Case) -> Mapping[str, Known]:
        """Coverage and rates of adatoms without bonds, that come and leave (Langmuir 1918)."""
        if self.bond_energy or case.lattice.ends or not self.flux + self.desorption_rate:
            return {}
        full = self.flux / (self.flux + self.desorption_rate)
        hops = case.lattice.lattice.neighbours * self._hops(0)
        found = {
            "part empty": 1 - full,
            "part adatom": full,
            "rate of adsorb": self.flux * (1 - full),
            "rate of hop": hops * full * (1 - full),
            "rate of desorb": self.desorption_rate * full,
        }
        return {name: (value, "Langmuir") for name, value in found.items()}
