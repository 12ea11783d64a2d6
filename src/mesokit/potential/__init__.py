"""Potentials. A new one is a file here."""

from __future__ import annotations

from mesokit.case.registry import parts_in
from mesokit.potential.protocol import Angle, Bond, Pair

BONDS = parts_in(__path__, __name__, Bond)
PAIRS = parts_in(__path__, __name__, Pair)
ANGLES = parts_in(__path__, __name__, Angle)

__all__ = ["ANGLES", "BONDS", "PAIRS", "Angle", "Bond", "Pair"]
