"""Collision rules. A new one is a file here and a name in `Collision`."""

from __future__ import annotations

from typing import get_args

from mesokit.mpcd.collision.at import AT
from mesokit.mpcd.collision.at_plus_a import ATPlusA
from mesokit.mpcd.collision.srd import SRD
from mesokit.mpcd.collision.srd_plus_a import SRDPlusA

Collision = SRD | AT | SRDPlusA | ATPlusA
RULES: tuple[type, ...] = get_args(Collision)

__all__ = ["AT", "RULES", "SRD", "ATPlusA", "Collision", "SRDPlusA"]
