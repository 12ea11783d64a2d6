"""Ballistic deposition: atoms that stick to the first one that they touch (Vold 1959)."""

from collections.abc import Mapping
from typing import Literal

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.heights import BESIDE, KPZ, Growth, HeightModel
from mesokit.method.kinetic_monte_carlo.model.protocol import Known
from mesokit.method.kinetic_monte_carlo.model.table import Process


@component
class Ballistic(HeightModel):
    """Atoms that come down stick to the column below or to the side of one beside it.

    The surface has overhangs and pores; its width grows as that of Kardar, Parisi and Zhang (1986),
    which it reaches slowly. Source: M. J. Vold, J. Colloid Sci. 14, 168 (1959).
    """

    rule: Literal["ballistic"] = tag("ballistic")
    flux: float = param(1.0, doc="atoms for each site", symbol="F", unit="1/time", gt=0)

    def growth(self, kind: Kind) -> list[Growth]:
        """Deposition anywhere, up to the top of the highest column beside."""
        return [Growth(Process("deposit", (0, 0), self.flux), 1, stays=BESIDE)]

    def expected(self, case: Case) -> Mapping[str, Known]:
        """The exponent of Kardar, Parisi and Zhang on a chain."""
        return {"growth exponent": KPZ} if case.lattice.kind == "chain" else {}
