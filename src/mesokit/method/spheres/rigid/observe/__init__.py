"""Observables of rigid grains alone. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.spheres.common.observe import MeanSquareDisplacement, Observable

__getattr__ = parts_in(__name__, OBSERVABLES=Observable)

__all__ = ["OBSERVABLES", "MeanSquareDisplacement", "Observable"]
