"""Theory of the neighbours of spheres."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.spheres.common.groups import ids_of_kind, refuse_molecules
from mesokit.observe.radial_distribution import Neighbours


class _Spheres(NamedTuple):
    """Spheres of one kind, or all: the number of the first, how many, and that each is alone."""

    first: int
    number: int
    length: int = 1

    def beads(self, wanted: int | None = None) -> NDArray[np.int64]:
        """Numbers (n, 1) of all."""
        return self.first + np.arange(self.number)[:, None]


class NeighboursOfSpheres(Neighbours):
    """No theory, as spheres that touch are not independent, and all spheres are looked at."""

    answers = "radial-distribution"

    def __init__(self, case: Case, observable: Any) -> None:
        refuse_molecules(observable.of or "particles")
        self.size = float(case.spheres.largest(case.box))
        self.diameter, self.value, self.note = math.nan, math.nan, ""
        try:
            groups = [ids_of_kind(case, kind) for kind in observable.kinds or (None,)]
        except CaseError as error:  # which speaks of one kind
            known = str(error).partition(": ")[2]
            raise CaseError(f"kinds = {show(observable.kinds)}: {known}") from None
        first, *others = (_Spheres(int(ids[0]) if len(ids) else 0, len(ids)) for ids in groups)
        self.first, self.second = [first], [*others]
