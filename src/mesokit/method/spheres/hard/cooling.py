"""How the temperature of hard spheres goes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mesokit.method.spheres.common.expected.cooling import Cooling, haff_time, uniform
from mesokit.method.spheres.hard.equilibrium import equilibrium

if TYPE_CHECKING:
    from mesokit.case.case import Case


class HardCooling:
    """A bath or warm walls of one temperature, or Haff's law."""

    answers = "granular-temperature"

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, section = case, case.spheres
        collision, state = section.collision, equilibrium(case)
        self.known = Cooling(collision.rough)
        warm = section.heating is not None or case.walls
        if warm and state is not None and not math.isnan(state.kT):
            held = state.kT if section.heating is not None or self._warm_walls() else math.nan
            self.known = self.known._replace(held=held, fluctuates=True)
        constant = collision.constant_restitution
        smooth = not collision.rough and section.heating is None
        if constant is not None and uniform(case) and smooth:
            self.known = self.known._replace(restitution=constant)

    def _warm_walls(self) -> bool:
        return any(
            surface.rule == "diffuse"
            for wall in self.case.walls
            for surface in wall.surfaces().values()
        )

    def haff_time(self, kT: float) -> float:
        """The time of Haff's law, from a temperature."""
        return haff_time(self.case, self.known.restitution, kT)
