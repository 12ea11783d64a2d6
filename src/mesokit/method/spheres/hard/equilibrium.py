"""Hard spheres in thermal equilibrium."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mesokit.method.spheres.common.expected.equilibrium import (
    Equilibrium,
    of_start,
    still_walls,
    surfaces,
)

if TYPE_CHECKING:
    from mesokit.case.case import Case


def equilibrium(case: Case) -> Equilibrium | None:
    """None where collisions take energy, or baths and walls of two temperatures are there."""
    section = case.spheres
    if not (section.collision.elastic and still_walls(case) and _keep_energy(case)):
        return None
    heating, warm = section.heating, set()
    if heating is not None:
        if heating.bath_kT is None:
            return None
        warm.add(heating.bath_kT)
    for surface in surfaces(case):
        if surface.rule == "diffuse":
            given = surface.contact.temperature if surface.contact is not None else None
            warm.add(float(section.kT if given is None else given))
    if len(warm) > 1:
        return None
    if warm:
        return Equilibrium(warm.pop(), True)
    even = not section.collision.rough or section.first_spin_kT == section.kT
    kept = even and section.collision.hard and not section.gravity
    return Equilibrium(of_start(case) if kept else math.nan, True)


def _keep_energy(case: Case) -> bool:
    """Whether walls that are not warm take none."""
    for surface in surfaces(case):
        contact = surface.contact
        if contact is None or surface.rule == "diffuse":
            continue
        if contact.restitution not in (None, 1.0):
            return False
        if contact.tangential not in (None, -1.0, 1.0) or contact.friction is not None:
            return False
    return True
