"""No thermostat."""

from __future__ import annotations

from typing import ClassVar, Literal, NamedTuple

from mesokit.case.component import component, tag
from mesokit.method.mpcd.thermostat.protocol import Thermostat, stretch, target
from mesokit.theory.transport import Thermostat as Named


@component
class NoThermostat(Thermostat):
    """Leave the energy to the collision rule."""

    rule: Literal["none"] = tag("none")

    acts: ClassVar[bool] = False
    needs_energy: ClassVar[bool] = False
    canonical: ClassVar[bool] = True
    in_theory: ClassVar[Named | None] = "none"

    def kernel(self, kT: float, floor: float) -> NoRescaling:
        return NoRescaling(kT)


class NoRescaling(NamedTuple):
    """No thermostat; kT only sets the temperature of the start."""

    kT: float


target.register(NoRescaling)(lambda thermostat, variate, freedom, energy: energy)


stretch.register(NoRescaling)(lambda thermostat, variate, freedom, energy: ())
