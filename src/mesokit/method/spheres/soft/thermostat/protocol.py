"""Base of the thermostats of soft spheres."""

from mesokit.case.component import component
from mesokit.case.registry import family


@family("thermostat of soft spheres", "rule", "mesokit.soft_thermostat")
@component
class SoftThermostat:
    """Brings heat in and takes it out. Without one energy is kept."""

    @property
    def held_kT(self) -> float:
        """Thermal energy that it holds."""
        return 0.0

    def decay(self, timestep: float) -> float:
        """Factor of velocities in a step, beside noise; 1 without friction."""
        return 1.0

    @property
    def scaled_every(self) -> int:
        """Number of steps after which velocities are scaled to the thermal energy; 0: never."""
        return 0
