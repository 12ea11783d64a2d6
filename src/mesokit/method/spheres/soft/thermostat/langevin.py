"""Friction and noise of a bath that is not shown."""

import math
from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.soft.thermostat.protocol import SoftThermostat


@component
class Langevin(SoftThermostat):
    """Friction and noise on every sphere, in the middle of the flight of a step (the splitting
    BAOAB of Leimkuhler and Matthews 2013). Momentum is not kept. Both act on
    spins as well."""

    rule: Literal["langevin"] = tag("langevin")
    kT: float = param(1.0, doc="thermal energy of the bath", unit="kT", gt=0, le=1e9)
    friction: float = param(1.0, doc="rate at which velocities decay", unit="1/time", gt=0, le=1e9)

    @property
    def held_kT(self) -> float:
        return self.kT

    def decay(self, timestep: float) -> float:
        return math.exp(-self.friction * timestep)
