"""What is measured of a flock. A new observable is a file here."""

from __future__ import annotations

from mesokit.case.registry import parts_in
from mesokit.method.flock.observe.protocol import FlockObservable
from mesokit.observe.shared.protocol import Observable

OBSERVABLES = parts_in(__path__, __name__, Observable)

__all__ = ["OBSERVABLES", "FlockObservable"]
