"""Times and speeds of a case of soft spheres: how long a contact takes, what a step may be."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mesokit.method.soft_spheres.pair.protocol import ContactLaw

if TYPE_CHECKING:
    from mesokit.case.box import Box
    from mesokit.method.soft_spheres.section import SoftSpheres

IN_CONTACT, WARNED, REFUSED = 50, 20, 10  # steps in a contact: usual, and fewest without complaint
OF_FLIGHT = 0.005  # of the time in which a sphere of a fluid flies its diameter
FASTEST = 3.0  # thermal velocities of two that collide, hardly more


def lightest(section: SoftSpheres, box: Box) -> float:
    """The smallest mass."""
    d = box.dimension
    return min(kind.mean_mass(d) * (1 - kind.spread) ** d for kind in section.kinds)


def speed_of_collision(section: SoftSpheres, box: Box) -> float:
    """How fast spheres may meet: by thermal motion, or after a fall through the box."""
    thermal = FASTEST * math.sqrt(section.kT / lightest(section, box))
    fall = sum(abs(g) * length for g, length in zip(section.gravity, box.size, strict=False))
    return max(thermal, math.sqrt(2 * fall))


def shortest_contact(section: SoftSpheres, box: Box) -> float:
    """The shortest time that a contact takes; infinite for spheres that never meet."""
    law, mass = section.pair, 0.5 * lightest(section, box)
    assert isinstance(law, ContactLaw)
    return law.contact_time_of(mass, speed_of_collision(section, box))


def timestep_of(section: SoftSpheres, box: Box) -> float:
    """Time of a step."""
    if section.timestep is not None:
        return section.timestep
    law = section.pair
    if isinstance(law, ContactLaw):
        time = shortest_contact(section, box)
        return time / IN_CONTACT if math.isfinite(time) else OF_FLIGHT
    kT = max(section.kT, section.thermostat.held_kT if section.thermostat else 0.0, 1.0)
    diameter: float = law.diameter  # type: ignore[attr-defined]
    return OF_FLIGHT * diameter * math.sqrt(lightest(section, box) / kT)
