"""Thermostat that sets every cell to the same temperature."""

from __future__ import annotations

from typing import ClassVar, Literal, NamedTuple

from mesokit.case.component import component, tag
from mesokit.method.mpcd.thermostat.protocol import Thermostat, target
from mesokit.theory.transport import Thermostat as Named


@component
class Rescale(Thermostat):
    """Scale the relative velocities of a cell to exactly the mean thermal energy.

    Keeps the temperature but not its fluctuations; the mean velocity of the cell is left alone.
    """

    rule: Literal["rescale"] = tag("rescale")

    one_temperature: ClassVar[bool] = False
    in_theory: ClassVar[Named | None] = "rescale"

    def kernel(self, kT: float, floor: float) -> Isokinetic:
        return Isokinetic(kT, floor)


class Isokinetic(NamedTuple):
    """Thermal energy to set."""

    kT: float
    floor: float


@target.register(Isokinetic)
def _(thermostat, variate, freedom, energy):
    return 0.5 * freedom * thermostat.kT
