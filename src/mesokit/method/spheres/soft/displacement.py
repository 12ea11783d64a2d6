"""How far soft spheres go: there is no theory of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes
from mesokit.seam.method import method_of
from mesokit.statistics import spread_ids

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.seam.engine import Array, Integers


class Displacement:
    """What the observable asks; theory knows of no such fluid."""

    answers = "mean-square-displacement"

    def __init__(self, case: Case, observable: Any) -> None:
        if observable.of != "particles" or observable.kind is not None:
            raise CaseError("of: expected 'particles'; there are no molecules")
        shut = closed_axes(case)
        free = [axis for k, axis in enumerate(case.box.axes) if k not in shut]
        chosen = observable.components or free
        if not chosen:
            raise CaseError("mean-square-displacement: every axis is closed by a wall")
        self.axes = tuple(case.box.index(axis, "components") for axis in chosen)
        self.case, self.length, self.number = case, 1, case.particles
        self.timestep = method_of(case).timestep(case)

    def beads(self, wanted: int) -> Integers:
        """Numbers (n, 1) of so many spheres, evenly spread."""
        return spread_ids(wanted, self.number)[:, None]

    def expected(self, steps: Integers) -> Array | None:
        """Nothing."""
        return None

    def coefficient(self) -> tuple[float, str]:
        """Not known."""
        return math.nan, ""

    def diffusive_from(self) -> float:
        """Not known: what is measured is taken as it is."""
        return 0.0

    def grows(self) -> bool:
        """In 2D, where neither walls nor a bath take momentum."""
        case, bath = self.case, self.case.spheres.thermostat
        kept = not case.walls and (bath is None or bath.decay(self.timestep) == 1.0)
        return case.box.dimension == 2 and kept and self.number > 1

    def level_from(self) -> float:
        """Never: nothing holds them."""
        return math.inf

    def legend(self) -> str:
        """There is no theory to name."""
        return ""
