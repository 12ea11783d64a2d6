"""Observables of particles that more than one method has, a file each."""

from mesokit.case.registry import parts_in
from mesokit.seam.observable import Accumulator, Observable
from mesokit.seam.result import Comparison, Result

__getattr__ = parts_in(__name__, OBSERVABLES=Observable)

__all__ = ["OBSERVABLES", "Accumulator", "Comparison", "Observable", "Result"]
