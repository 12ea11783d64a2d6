"""Shapes of walls. A new one is a file here."""

from __future__ import annotations

from mesokit.case.registry import parts_in
from mesokit.geometry.shape_protocol import Wall

SHAPES = parts_in(__path__, __name__, Wall)

__all__ = ["SHAPES", "Wall"]
