"""Observables of flocks. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.flock.observe.protocol import FlockObservable
from mesokit.observe import Observable

__getattr__ = parts_in(__name__, OBSERVABLES=Observable)

__all__ = ["OBSERVABLES", "FlockObservable"]
