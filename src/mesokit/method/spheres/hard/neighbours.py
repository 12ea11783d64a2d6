"""What theory says of the neighbours of hard spheres."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mesokit import theory
from mesokit.method.spheres.common.expected.enskog import fluid_note

if TYPE_CHECKING:
    from mesokit.case.case import Case


class Neighbours:
    """g at contact by the equation of state, which the pressure of hard spheres is made of: Z - 1
    is 2^(d-1) times the packing fraction and g; nan of unlike spheres and of those that lose
    energy. `diameter` is where, nan of unlike ones."""

    answers = "radial-distribution"

    def __init__(self, case: Case, observable: Any) -> None:
        section, box = case.spheres, case.box
        kind, d = section.kinds[0], box.dimension
        alike = len(section.kinds) == 1 and kind.spread == 0
        self.diameter = kind.diameter * section.scale(box) if alike else math.nan
        self.value, self.note = math.nan, ""
        phi = section.fraction(box)
        plain = section.collision.elastic and section.collision.hard
        if alike and plain and not section.heating:
            self.note = fluid_note(case)
            self.value = (theory.compressibility(phi, d) - 1) / (2 ** (d - 1) * phi)
