"""Second virial coefficient of a potential of pairs."""

import itertools
import math
from collections.abc import Callable


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
