"""Sources and sinks of energy for hard spheres. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.spheres.hard.heating.protocol import Heating

__getattr__ = parts_in(__name__, HEATINGS=Heating)

__all__ = ["HEATINGS", "Heating"]
