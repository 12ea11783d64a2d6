"""Velocities scaled to a temperature."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.soft.thermostat.protocol import SoftThermostat


@component
class RescaleAll(SoftThermostat):
    """All velocities are scaled to exactly the mean kinetic energy, every so many steps.

    Holds the mean and not the fluctuations: to bring a fluid to a temperature. Spins are left
    alone.
    """

    rule: Literal["rescale"] = tag("rescale")
    kT: float = param(1.0, doc="thermal energy to set", unit="kT", gt=0, le=1e9)
    every: int = param(10, doc="steps between two times", unit="steps", ge=1, le=10**9)

    @property
    def held_kT(self) -> float:
        return self.kT

    @property
    def scaled_every(self) -> int:
        return self.every
