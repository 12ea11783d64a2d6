"""Second virial coefficient, and the part of a Lennard-Jones fluid beyond its cut-off."""

import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

from mesokit.theory._check import not_negative, positive


def second_virial(
    energy: Callable[[float], float], kT: float, cutoff: float, dimension: int
) -> float:
    """B_2 = -1/2 integral of (exp(-U/kT) - 1): P = n kT (1 + B_2 n) of a dilute gas.

    Parameters: `energy` U of a distance; 0 beyond the cutoff; `kT` thermal energy, in units of U;
    `cutoff` longest distance at which U is not 0, in a; `dimension` 2 or 3.

    Lennard-Jones, whose second virial coefficient vanishes at a temperature of 3.418.

    >>> def energy(r):
    ...     return 4 * (r**-12 - r**-6)
    >>> round(second_virial(energy, 3.417928, 200.0, 3), 4)
    0.0
    >>> round(second_virial(energy, 1.0, 200.0, 3), 3)
    -5.316
    """
    from scipy.integrate import quad

    around = 2 * math.pi if dimension == 2 else 4 * math.pi

    def integrand(r: float) -> float:
        depth = -energy(r) / kT if r > 0 else -math.inf
        return float(math.expm1(max(depth, -700.0)) * r ** (dimension - 1))

    points = [x for x in (0.5, 0.8, 1.0, 1.2, 2.0, 5.0, 20.0) if x < cutoff]
    ends = [1e-3, *points, cutoff]
    total = sum(
        quad(integrand, low, high, epsabs=1e-12)[0] for low, high in itertools.pairwise(ends)
    )
    core = -(ends[0] ** dimension) / dimension  # no pair comes so near
    return -0.5 * around * (total + core)


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
