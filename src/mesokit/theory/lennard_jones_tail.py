"""Energy and pressure of a Lennard-Jones fluid beyond its cut-off."""

import math
from typing import NamedTuple

from mesokit.theory._check import not_negative, positive


class LennardJonesTail(NamedTuple):
    """Energy of a particle and pressure, to be added."""

    energy: float
    pressure: float


def lennard_jones_tail(density: float, cutoff: float) -> LennardJonesTail:
    """Energy and pressure beyond the cut-off in 3D, where g(r) = 1 (Frenkel and Smit 2002,
    section 3.2.2), in units of epsilon and sigma.

    Parameters: `density` particles per volume; `cutoff` distance beyond which there is no force;
    the energy is not shifted.

    >>> tail = lennard_jones_tail(0.8, 3.0)
    >>> round(tail.energy, 5), round(tail.pressure, 5)
    (-0.24811, -0.3968)
    """
    not_negative(density=density)
    positive(cutoff=cutoff)
    cube = cutoff**-3.0
    energy = 8 / 3 * math.pi * density * (cube**3 / 3 - cube)
    return LennardJonesTail(energy, 16 / 3 * math.pi * density**2 * (2 / 3 * cube**3 - cube))
