"""Thermostats of soft spheres. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.spheres.soft.thermostat.protocol import SoftThermostat

__getattr__ = parts_in(__name__, THERMOSTATS=SoftThermostat)

__all__ = ["THERMOSTATS", "SoftThermostat"]
