"""Shapes of walls. A new one is a file here and a name in `SHAPES`."""

from __future__ import annotations

from mesokit.geometry.plates import Plates
from mesokit.geometry.surface import Surface

Wall = Plates
SHAPES: tuple[type, ...] = (Plates,)

__all__ = ["SHAPES", "Plates", "Surface", "Wall"]
