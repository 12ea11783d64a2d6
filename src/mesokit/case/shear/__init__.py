"""Histories of shear: how the shear rate of a box changes in time. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.case.shear.protocol import ShearHistory

__getattr__ = parts_in(__name__, HISTORIES=ShearHistory)

__all__ = ["HISTORIES", "ShearHistory"]
