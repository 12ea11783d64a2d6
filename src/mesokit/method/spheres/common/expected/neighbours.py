"""What is known of the neighbours of spheres, whatever method moves them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.spheres.common.groups import ids_of_kind, refuse_molecules

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.observe.radial_distribution import Group


class _Spheres(NamedTuple):
    """Spheres of one kind, or all: the number of the first, how many, and that each is alone."""

    first: int
    number: int
    length: int = 1

    def beads(self, wanted: int | None = None) -> NDArray[np.int64]:
        """Numbers (n, 1) of all."""
        return self.first + np.arange(self.number)[:, None]


class NeighboursOfSpheres:
    """No theory, as spheres that touch are not independent. Selected spheres, their size;
    `diameter`, `value` and `note` are those at contact."""

    answers = "radial-distribution"

    def __init__(self, case: Case, observable: Any) -> None:
        refuse_molecules(observable.of or "particles")
        self.size = float(case.spheres.largest(case.box))
        self.diameter, self.value, self.note = math.nan, math.nan, ""
        try:
            first, *others = (_of_kind(case, kind) for kind in observable.kinds or (None,))
        except CaseError as error:  # which speaks of one kind
            known = str(error).partition(": ")[2]
            raise CaseError(f"kinds = {show(observable.kinds)}: {known}") from None
        self.first, self.second = [first], others

    def sampled(self, group: Group) -> bool:
        """False: all spheres are looked at."""
        return False

    def independent(self, groups: list[Group]) -> bool:
        """False: spheres keep others away."""
        return False

    def diffusion(self, group: Group) -> float | None:
        """None: it is not known."""
        return None


def _of_kind(case: Case, kind: int | str | None) -> _Spheres:
    """Those of a kind, or all."""
    ids = ids_of_kind(case, kind)
    return _Spheres(int(ids[0]) if len(ids) else 0, len(ids))
