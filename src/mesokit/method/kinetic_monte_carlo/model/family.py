"""Deposition with relaxation: atoms that roll to the lowest column beside (Family 1986)."""

from collections.abc import Mapping
from typing import Literal

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.heights import LOWEST, Growth, HeightModel
from mesokit.method.kinetic_monte_carlo.model.protocol import Known
from mesokit.method.kinetic_monte_carlo.model.table import Process


@component
class Family(HeightModel):
    """Atoms stay at the lowest of the site where they come down and its neighbours.

    The width grows as t^(1/4) in 1 + 1 dimensions, as in the theory of Edwards and Wilkinson
    (1982). Source: F. Family, J. Phys. A 19, L441 (1986).
    """

    rule: Literal["family"] = tag("family")
    flux: float = param(1.0, doc="atoms for each site", symbol="F", unit="1/time", gt=0)

    def growth(self, kind: Kind) -> list[Growth]:
        """Deposition anywhere, and a step down."""
        return [Growth(Process("deposit", (0, 0), self.flux), 1, stays=LOWEST)]

    def expected(self, case: Case) -> Mapping[str, Known]:
        """The speed, and on a chain the exponent of Edwards and Wilkinson."""
        found = {"speed of growth": (self.flux, "all atoms stay")}
        if case.lattice.kind == "chain":
            found["growth exponent"] = 0.25, "approximate: Edwards and Wilkinson, at late times"
        return found
