"""Thermostats. A new one is a file here and a name in `Thermostat`."""

from __future__ import annotations

from typing import get_args

from mesokit.mpcd.thermostat.maxwell_boltzmann import MaxwellBoltzmann
from mesokit.mpcd.thermostat.none import NoThermostat
from mesokit.mpcd.thermostat.rescale import Rescale

Thermostat = NoThermostat | MaxwellBoltzmann | Rescale
RULES: tuple[type, ...] = get_args(Thermostat)

__all__ = ["RULES", "MaxwellBoltzmann", "NoThermostat", "Rescale", "Thermostat"]
