"""Theory of rigid grains: equilibrium and cooling of a gas of them."""

import math
from typing import Any

from mesokit.case.case import Case
from mesokit.method.spheres.common.expected.cooling import Cooling, haff_time, uniform
from mesokit.method.spheres.common.expected.equilibrium import (
    Equilibrium,
    of_start,
    still_walls,
    surfaces,
)


def rigid_equilibrium(case: Case) -> Equilibrium | None:
    """Equilibrium of hard spheres, None where contacts take energy, or the box is sheared."""
    section, law = case.spheres, case.spheres.contact
    elastic = law.restitution == 1 and not section.turns and law.cohesion is None
    if not elastic or case.box.sheared or not still_walls(case):
        return None
    for surface in surfaces(case):
        contact = surface.contact
        if contact is not None and (contact.restitution not in (None, 1.0) or contact.friction):
            return None
    return Equilibrium(math.nan if section.gravity else of_start(case), True)


class RigidCooling:
    """Haff's law of smooth grains, whose collisions take no time, of a restitution below 1.

    With 1 they keep energy only nearly: several contacts of a grain in one step lose some.
    """

    answers = "granular-temperature"

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, section = case, case.spheres
        law, self.known = section.contact, Cooling(section.turns)
        smooth = not section.turns and law.cohesion is None
        if smooth and law.restitution < 1 and uniform(case) and not case.box.sheared:
            self.known = self.known._replace(restitution=law.restitution)

    def haff_time(self, kT: float) -> float:
        """The time of Haff's law, from a temperature."""
        return haff_time(self.case, self.known.restitution, kT)
