"""Collision rules. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.mpcd.collision.protocol import CollisionRule, Gas

__getattr__ = parts_in(__name__, RULES=CollisionRule)

__all__ = ["RULES", "CollisionRule", "Gas"]
