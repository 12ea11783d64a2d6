"""Eden growth: a cluster that grows by one site after the other at its edge (Eden 1961)."""

from collections.abc import Mapping
from typing import Literal

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.model.heights import KPZ
from mesokit.method.kinetic_monte_carlo.model.protocol import Known
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process, TableModel

EMPTY, CELL = 0, 1


@component
class Eden(TableModel):
    """Empty sites, and cells of a cluster that never die.

    Version "A": each empty site beside the cluster is filled with the rate `growth_rate`; "B": with
    the rate for each of its bonds to the cluster; "C": each cell with empty neighbours fills one of
    them. The edge of a cluster in a strip widens as t^(1/3), that of "C" soonest. Source: M. Eden,
    Proc. 4th Berkeley Symp. 4, 223 (1961); R. Jullien and R. Botet, J. Phys. A 18, 2279 (1985).
    """

    rule: Literal["eden"] = tag("eden")
    version: Literal["A", "B", "C"] = param("C", doc="which site is filled next")
    growth_rate: float = param(1.0, doc="rate of growth at a place", unit="1/time", gt=0)

    def states(self) -> tuple[str, ...]:
        return "empty", "cell"

    def processes(self) -> list[Process]:
        """Growth."""
        if self.version == "C":
            return [Process("grow", (CELL, CELL), self._share, ((EMPTY,),), ((EMPTY,), CELL))]
        rate = self._once if self.version == "A" else self._for_each
        return [Process("grow", (EMPTY, CELL), rate, ((CELL,),))]

    def _once(self, counts: Counts) -> float:
        return self.growth_rate if counts[CELL] else 0.0

    def _for_each(self, counts: Counts) -> float:
        return self.growth_rate * counts[CELL]

    def _share(self, counts: Counts) -> float:
        return self.growth_rate / counts[EMPTY] if counts[EMPTY] else 0.0

    def expected(self, case: Case) -> Mapping[str, Known]:
        """The exponent of Kardar, Parisi and Zhang in a plane."""
        return {"growth exponent": KPZ} if case.box.dimension == 2 else {}
