"""Potentials. A new one is a file here and a name in `Bond`, `Pair` or `Angle`."""

from __future__ import annotations

from typing import get_args

from mesokit.potential.bending import Bending
from mesokit.potential.fene import FENE
from mesokit.potential.harmonic import Harmonic, Spring
from mesokit.potential.lennard_jones import LennardJones
from mesokit.potential.wca import WCA

Bond = Harmonic | Spring | FENE
Pair = WCA | LennardJones
Angle = Bending
BONDS: tuple[type, ...] = get_args(Bond)
PAIRS: tuple[type, ...] = get_args(Pair)
ANGLES: tuple[type, ...] = get_args(Angle) or (Bending,)

__all__ = [
    "ANGLES",
    "BONDS",
    "FENE",
    "PAIRS",
    "WCA",
    "Angle",
    "Bending",
    "Bond",
    "Harmonic",
    "LennardJones",
    "Pair",
    "Spring",
]
