"""Body forces. A new one is a file here and a name in `Force`."""

from __future__ import annotations

from typing import get_args

from mesokit.mpcd.field.none import NoForce
from mesokit.mpcd.field.sinusoidal import Sinusoidal
from mesokit.mpcd.field.uniform import Uniform

Force = NoForce | Uniform | Sinusoidal
RULES: tuple[type, ...] = get_args(Force)

__all__ = ["RULES", "Force", "NoForce", "Sinusoidal", "Uniform"]
