"""Theory of the neighbours of particles, beads and molecules."""

import math
from typing import Any

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.molecules import free_diffusion
from mesokit.method.mpcd.expected.selection import (
    Group,
    default_of,
    groups_of,
    independent,
    kind_of,
)


class NeighboursInFluid:
    """Theory of g(r) in an MPCD fluid: ideal particles, and molecules that do not interact."""

    answers = "radial-distribution"
    size = 1.0  # a cell; of bodies the largest diameter
    diameter, value, note = math.nan, math.nan, ""

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, self.of = case, default_of(case, observable.of)
        try:  # the second is empty for pairs within the first
            groups = [groups_of(case, self.of, kind) for kind in observable.kinds or (None,)]
        except CaseError as error:
            if not observable.kinds:
                raise
            known = str(error).partition(": ")[2] or str(error)  # of the message about one kind
            raise CaseError(f"kinds = {show(observable.kinds)}: {known}") from None
        self.first, self.second = groups[0], groups[1] if len(groups) > 1 else []
        if self.of == "bodies":
            d = case.box.dimension
            self.size = max(2.0 * kind.solid(d).radius for kind in case.bodies)

    def sampled(self, group: Group) -> bool:
        """True of a group in the fluid, which has many particles."""
        return group.first < self.case.particles

    def independent(self, groups: list[Group]) -> bool:
        """True if molecules are independent of all others."""
        return independent(self.case, self.of, groups)

    def diffusion(self, group: Group) -> float | None:
        """Rouse diffusion coefficient of a group's molecules, a^2/tau; None if unknown."""
        if self.of == "bodies":
            return None
        alone = free_diffusion(self.case, self.of, kind_of(self.case, group))
        return None if alone is None else alone / group.length
