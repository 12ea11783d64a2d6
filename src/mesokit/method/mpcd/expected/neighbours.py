"""What theory says of the neighbours of particles, beads and molecules."""

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
    size = 1.0  # a cell
    diameter, value, note = math.nan, math.nan, ""

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, self.of = case, default_of(case, observable.of)
        self.first, self.second = self._chosen(observable.kinds)

    def _chosen(self, kinds: tuple[int | str, ...]) -> tuple[list[Group], list[Group]]:
        """Groups of the first kind and of the second, which is empty for pairs within the first."""
        if not kinds:
            return groups_of(self.case, self.of), []
        try:
            first, *others = (groups_of(self.case, self.of, kind) for kind in kinds)
        except CaseError as error:  # which speaks of one kind
            known = str(error).partition(": ")[2]
            raise CaseError(f"kinds = {show(kinds)}: {known}") from None
        return first, others[0] if others else []

    def sampled(self, group: Group) -> bool:
        """True of a group in the fluid, which has many particles."""
        return group.first < self.case.particles

    def independent(self, groups: list[Group]) -> bool:
        """True if molecules are independent of all others."""
        return independent(self.case, self.of, groups)

    def diffusion(self, group: Group) -> float | None:
        """Rouse diffusion coefficient of a group's molecules, a^2/tau; None if unknown."""
        alone = free_diffusion(self.case, self.of, kind_of(self.case, group))
        return None if alone is None else alone / group.length
