"""Observables. A new one is a file here."""

from __future__ import annotations

from mesokit.case.registry import parts_in
from mesokit.observe.shared.protocol import Accumulator, Observable
from mesokit.observe.shared.result import Comparison, Result

__getattr__ = parts_in(__name__, OBSERVABLES=Observable)

__all__ = ["OBSERVABLES", "Accumulator", "Comparison", "Observable", "Result"]
