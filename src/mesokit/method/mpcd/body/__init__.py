"""Shapes of bodies that move in the fluid. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.mpcd.body.protocol import Body

__getattr__ = parts_in(__name__, BODIES=Body)

__all__ = ["BODIES", "Body"]
