"""Observables of spheres and disks of both methods. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.observe import Observable
from mesokit.observe.mean_square_displacement import MeanSquareDisplacement

__getattr__ = parts_in(__name__, OBSERVABLES=Observable)

__all__ = ["OBSERVABLES", "MeanSquareDisplacement", "Observable"]
