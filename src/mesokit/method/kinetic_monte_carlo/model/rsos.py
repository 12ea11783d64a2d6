"""Growth of restricted solids on solids: no step is higher than an atom (Kim, Kosterlitz 1989)."""

from collections.abc import Mapping
from typing import Literal

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.heights import KPZ, LOWER, Growth, HeightModel
from mesokit.method.kinetic_monte_carlo.model.protocol import Known
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process

# J. Kelling and G. Odor, Phys. Rev. E 84, 061150 (2011)
PLANE: Known = (0.2415, "approximate: Kardar, Parisi and Zhang, by simulation, at late times")


@component
class RestrictedSolidOnSolid(HeightModel):
    """Atoms come down only where no step becomes higher than one atom.

    The width grows as t^(1/3) in 1 + 1 dimensions, as that of Kardar, Parisi and Zhang (1986).
    Source: J. M. Kim and J. M. Kosterlitz, Phys. Rev. Lett. 62, 2289 (1989).
    """

    rule: Literal["rsos"] = tag("rsos")
    flux: float = param(1.0, doc="atoms for each site", symbol="F", unit="1/time", gt=0)

    def growth(self, kind: Kind) -> list[Growth]:
        """Deposition where no neighbour is lower."""

        def rate(counts: Counts) -> float:
            return 0.0 if counts[LOWER[0]] else self.flux

        return [Growth(Process("deposit", (0, 0), rate, (LOWER,)), 1)]

    def expected(self, case: Case) -> Mapping[str, Known]:
        """The exponent of Kardar, Parisi and Zhang."""
        known = {1: KPZ, 2: PLANE}.get(case.box.dimension)
        return {} if known is None else {"growth exponent": known}
