"""Thermostats. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.mpcd.thermostat.protocol import Thermostat

__getattr__ = parts_in(__name__, RULES=Thermostat)

__all__ = ["RULES", "Thermostat"]
