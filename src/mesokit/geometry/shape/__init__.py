"""Shapes of walls. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.geometry.shape_protocol import Wall

__getattr__ = parts_in(__name__, SHAPES=Wall)

__all__ = ["SHAPES", "Wall"]
