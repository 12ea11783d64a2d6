"""Observables of fluids of MPCD and of solutes in them. A new observable is a file here."""

from mesokit.case.registry import parts_in
from mesokit.observe import Observable

__getattr__ = parts_in(__name__, OBSERVABLES=Observable)

__all__ = ["OBSERVABLES", "Observable"]
