"""The single-step model: neighbours that always differ by one (Meakin et al. 1986)."""

from collections.abc import Callable, Mapping
from typing import Literal

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.heights import (
    HIGHER,
    KPZ,
    LOWER,
    Growth,
    HeightModel,
)
from mesokit.method.kinetic_monte_carlo.model.protocol import Known
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process
from mesokit.method.kinetic_monte_carlo.start import TerraceStart, UniformStart


@component
class SingleStep(HeightModel):
    """Heights of neighbours differ by one: valleys rise by two, and tops fall by two.

    On a chain it is the exclusion process with another face: a step down is a particle. Source:
    P. Meakin et al., Phys. Rev. A 34, 5091 (1986).
    """

    rule: Literal["single-step"] = tag("single-step")
    up: float = param(1.0, doc="rate at which a valley rises", symbol="p", unit="1/time", ge=0)
    down: float = param(0.0, doc="rate at which a top falls", symbol="q", unit="1/time", ge=0)

    def check(self, case: Case) -> None:
        """Raise CaseError for a start in which neighbours do not differ by one."""
        if isinstance(case.lattice.first(), UniformStart | TerraceStart):
            raise CaseError(
                "lattice.start: neighbours must differ by one in model 'single-step'; expected "
                "'alternating', 'file' or 'run'"
            )

    def growth(self, kind: Kind) -> list[Growth]:
        """Valleys and tops."""
        z = kind.neighbours

        def all_of(some: tuple[int, ...], often: float) -> Callable[[Counts], float]:
            return lambda counts: often if counts[some[0]] == z else 0.0

        return [
            Growth(Process("rise", (0, 0), all_of(HIGHER, self.up), (HIGHER,)), 2),
            Growth(Process("fall", (0, 0), all_of(LOWER, self.down), (LOWER,)), -2),
        ]

    def expected(self, case: Case) -> Mapping[str, Known]:
        """The exponent of Kardar, Parisi and Zhang on a chain, where growth is driven."""
        driven = self.up != self.down and case.lattice.kind == "chain"
        return {"growth exponent": KPZ} if driven else {}
