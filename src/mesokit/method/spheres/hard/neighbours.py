"""What theory says of the neighbours of hard spheres."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mesokit import theory
from mesokit.method.spheres.common.expected.enskog import fluid_note
from mesokit.method.spheres.common.expected.neighbours import NeighboursOfSpheres

if TYPE_CHECKING:
    from mesokit.case.case import Case


class Neighbours(NeighboursOfSpheres):
    """g at contact by the equation of state, which the pressure of hard spheres is made of: Z - 1
    is 2^(d-1) times the packing fraction and g; nan of unlike spheres and of those that lose
    energy. `diameter` is where, nan of unlike ones."""

    def __init__(self, case: Case, observable: Any) -> None:
        super().__init__(case, observable)
        section, box = case.spheres, case.box
        kind, d = section.kinds[0], box.dimension
        alike = len(section.kinds) == 1 and kind.spread == 0
        if alike:
            self.diameter = kind.diameter * section.scale(box)
        phi = section.fraction(box)
        plain = section.collision.elastic and section.collision.hard
        if alike and plain and not section.heating:
            self.note = fluid_note(case)
            self.value = (theory.compressibility(phi, d) - 1) / (2 ** (d - 1) * phi)
