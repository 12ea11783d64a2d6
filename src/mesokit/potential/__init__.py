"""Potentials. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.potential.protocol import Angle, Bond, Pair

__getattr__ = parts_in(__name__, BONDS=Bond, PAIRS=Pair, ANGLES=Angle)

__all__ = ["ANGLES", "BONDS", "PAIRS", "Angle", "Bond", "Pair"]
