"""Soft spheres in thermal equilibrium."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mesokit.method.spheres.common.expected.equilibrium import Equilibrium, still_walls, surfaces
from mesokit.method.spheres.soft.pair.protocol import ContactLaw

if TYPE_CHECKING:
    from mesokit.case.case import Case


def equilibrium(case: Case) -> Equilibrium | None:
    """None where contacts take energy. Without a bath the temperature is known afterwards alone:
    forces take a part of the energy of the start."""
    section = case.spheres
    touching = isinstance(section.pair, ContactLaw)
    if (touching and not section.pair.elastic) or not still_walls(case):
        return None
    for surface in surfaces(case):
        contact = surface.contact
        if contact is not None and (contact.restitution not in (None, 1.0) or contact.friction):
            return None
    bath = section.thermostat
    held = math.nan
    if bath is not None:
        free = 1.0 if not bath.scaled_every or case.walls else 1 - 1 / case.particles
        held = float(bath.held_kT * free)
    return Equilibrium(held, touching)
