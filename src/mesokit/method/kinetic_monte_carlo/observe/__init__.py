"""Observables of lattices. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable
from mesokit.observe import Observable

__getattr__ = parts_in(__name__, OBSERVABLES=Observable)

__all__ = ["OBSERVABLES", "LatticeObservable"]
