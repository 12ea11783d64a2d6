"""Collision rules of hard spheres. A new rule is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.spheres.hard.collision.protocol import SphereCollision

__getattr__ = parts_in(__name__, RULES=SphereCollision)

__all__ = ["RULES", "SphereCollision"]
