"""Theory of soft spheres: equilibrium and cooling."""

import math
from typing import Any

from mesokit.case.case import Case
from mesokit.method.spheres.common.expected.cooling import Cooling, haff_time, uniform
from mesokit.method.spheres.common.expected.equilibrium import Equilibrium, still_walls, surfaces
from mesokit.method.spheres.common.motion import SphereDisplacement
from mesokit.method.spheres.soft.pair.protocol import ContactLaw


def soft_equilibrium(case: Case) -> Equilibrium | None:
    """Equilibrium, None where contacts take energy; its temperature is nan without a bath, since
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


class SoftDisplacement(SphereDisplacement):
    """Displacement in a fluid of soft spheres, for which there is no theory."""

    def _keeps_momentum(self) -> bool:
        bath = self.case.spheres.thermostat
        return not self.case.walls and (bath is None or bath.decay(self.timestep) == 1.0)


class SoftCooling:
    """A bath, or Haff's law of contacts whose restitution does not depend on the speed."""

    answers = "granular-temperature"

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, section = case, case.spheres
        bath, law, state = section.thermostat, section.pair, soft_equilibrium(case)
        self.known = Cooling(section.turns)
        if bath is not None and state is not None:
            fluctuates = not bath.scaled_every
            self.known = self.known._replace(held=float(bath.held_kT), fluctuates=fluctuates)
        if bath is None and uniform(case) and isinstance(law, ContactLaw) and not section.turns:
            mass = 0.5 * section.kinds[0].mean_mass(case.box.dimension)
            slow, fast = (law.restitution_of(mass, speed) for speed in (0.1, 1.0))
            time = law.contact_time_of(mass, math.sqrt(section.kT / mass) or 1.0)
            if math.isclose(slow, fast, rel_tol=1e-9):
                self.known = self.known._replace(restitution=slow, contact_time=time)

    def haff_time(self, kT: float) -> float:
        """The time of Haff's law, from a temperature."""
        return haff_time(self.case, self.known.restitution, kT)
