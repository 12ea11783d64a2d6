"""Bond length of the bead-spring model of Kremer and Grest."""

import math
from itertools import pairwise
from typing import NamedTuple

from mesokit.theory._check import one_of, positive


class BondLength(NamedTuple):
    """Where the bond's energy is least, mean length, and root mean square."""

    minimum: float
    mean: float
    root_mean_square: float


def kremer_grest_bond(
    dimension: int = 3,
    k: float = 30.0,
    longest: float = 1.5,
    epsilon: float = 1.0,
    sigma: float = 1.0,
    kT: float = 1.0,
) -> BondLength:
    """Length of a bond of FENE and WCA potentials in equilibrium.

    FENE: -(k R0^2/2) ln(1 - (r/R0)^2); WCA: 4 epsilon ((sigma/r)^12 - (sigma/r)^6) + epsilon below
    2^(1/6) sigma.

    Parameters:
        dimension: 2 or 3.
        k, longest: spring constant, energy over area, and largest length R0.
        epsilon, sigma: energy and diameter of the repulsion.
        kT: thermal energy.

    Raises ValueError for a value out of range. Source: K. Kremer and G. S. Grest, J. Chem. Phys.
    92, 5057 (1990); mean with the weight r^(d-1) exp(-U/kT) by quadrature. Valid for two beads
    alone; in chains the repulsion of the others changes it by less than 0.3 %.

    >>> [round(length, 5) for length in kremer_grest_bond()]
    [0.9609, 0.97012, 0.97069]
    """
    one_of((2, 3), dimension=dimension)
    positive(k=k, longest=longest, epsilon=epsilon, sigma=sigma, kT=kT)
    from scipy.integrate import quad
    from scipy.optimize import brentq

    def energy(r: float) -> float:
        inverse = (sigma / r) ** 6
        repulsion = 4 * epsilon * (inverse * inverse - inverse) + epsilon if inverse > 0.5 else 0.0
        return repulsion - k * longest**2 / 2 * math.log1p(-((r / longest) ** 2))

    def slope(r: float) -> float:
        inverse = (sigma / r) ** 6
        repulsion = -24 * epsilon / r * (2 * inverse * inverse - inverse) if inverse > 0.5 else 0.0
        return repulsion + k * r / (1 - (r / longest) ** 2)

    touching = min(2 ** (1 / 6) * sigma, longest)
    least = float(brentq(slope, 1e-3 * touching, touching * (1 - 1e-12), xtol=1e-14))

    def moment(n: int) -> float:
        def weight(r: float) -> float:
            return r ** (n + dimension - 1) * math.exp(-(energy(r) - energy(least)) / kT)

        # pieces of the smooth potential, so that the quadrature misses no peak
        ends = sorted({least / 2, least, touching, longest})
        return math.fsum(quad(weight, a, b, epsabs=0, epsrel=1e-11)[0] for a, b in pairwise(ends))

    norm = moment(0)
    return BondLength(least, moment(1) / norm, math.sqrt(moment(2) / norm))
