"""Thermostats. A new one is a file here."""

from __future__ import annotations

from mesokit.case.registry import parts_in
from mesokit.method.mpcd.thermostat.protocol import Thermostat

RULES = parts_in(__path__, __name__, Thermostat)

__all__ = ["RULES", "Thermostat"]
