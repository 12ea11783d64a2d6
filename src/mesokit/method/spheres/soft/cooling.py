"""How the temperature of soft spheres goes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mesokit.method.spheres.common.expected.cooling import Cooling, haff_time, uniform
from mesokit.method.spheres.soft.equilibrium import equilibrium
from mesokit.method.spheres.soft.pair.protocol import ContactLaw

if TYPE_CHECKING:
    from mesokit.case.case import Case


class SoftCooling:
    """A bath, or Haff's law of contacts whose restitution does not depend on the speed."""

    answers = "granular-temperature"

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, section = case, case.spheres
        bath, law, state = section.thermostat, section.pair, equilibrium(case)
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
