"""Collision rules. A new one is a file here."""

from __future__ import annotations

from mesokit.case.registry import parts_in
from mesokit.method.mpcd.collision.protocol import CollisionRule, Gas

RULES = parts_in(__path__, __name__, CollisionRule)

__all__ = ["RULES", "CollisionRule", "Gas"]
