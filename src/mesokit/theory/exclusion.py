"""The exclusion process: exact currents, profiles, and displacements in a single file."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import not_negative, whole


def ring_current(particles: int, sites: int) -> float:
    """Hops over a bond of a ring in a unit of time, at rate 1 of a hop to an empty site.

    Parameters: `particles` and `sites` of the ring. All states are as likely: N (L - N) / (L
    (L - 1)). Raises ValueError for more particles than sites, or fewer than two sites. Source:
    F. Spitzer, Adv. Math. 5, 246 (1970).

    >>> ring_current(50, 100) == 0.25 * 100 / 99
    True
    """
    whole(2, sites=sites)
    whole(0, particles=particles)
    if particles > sites:
        raise ValueError(f"particles = {particles!r}: expected at most {sites} sites")
    return particles * (sites - particles) / (sites * (sites - 1))


def ring_diffusion(particles: int, sites: int) -> float:
    """Variance of the displacement of a particle of a ring over time, at rate 1 of a hop.

    Parameters: `particles` N and `sites` L of the ring. (2L - 3)!/((2N - 1)! (2L - 2N - 1)!)
    ((N - 1)! (L - N)!/(L - 1)!)^2, late in time. Raises ValueError unless there are a particle and
    an empty site. Source: B. Derrida, M. R. Evans and D. Mukamel, J. Phys. A 26, 4911 (1993).

    >>> ring_diffusion(1, 10), round(ring_diffusion(9, 10) * 81, 6)
    (1.0, 1.0)
    """
    whole(1, particles=particles)
    whole(particles + 1, sites=sites)
    n, most = particles, sites
    logarithm = (
        math.lgamma(2 * most - 2)
        - math.lgamma(2 * n)
        - math.lgamma(2 * most - 2 * n)
        + 2 * (math.lgamma(n) + math.lgamma(most - n + 1) - math.lgamma(most))
    )
    return math.exp(logarithm)


def step_crossings(time: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Particles that cross the edge of a full half of an infinite chain, and their variance.

    Parameters: `time` in inverse rates of a hop. t/4 + 2^(-4/3) 1.77109 t^(1/3) and 2^(-8/3)
    0.81319 t^(2/3), from the mean and the variance of the distribution of Tracy and Widom; late in
    time, but for a constant. Raises ValueError for negative times. Source: K. Johansson, Commun.
    Math. Phys. 209, 437 (2000).

    >>> mean, variance = step_crossings([100.0, 1000.0])
    >>> round(float(mean[1] - mean[0]), 3), round(float(variance[1]), 2)
    (228.766, 12.81)
    """
    found = np.asarray(time, float)
    not_negative(time=float(found.min(initial=0.0)))
    root = np.cbrt(found)
    return found / 4 + 2 ** (-4 / 3) * 1.77109 * root, 2 ** (-8 / 3) * 0.81319 * root**2


def single_file_displacement(time: ArrayLike, part: float, rate: float) -> NDArray[np.float64]:
    """Mean square displacement of a particle in a long single file, in squares of the distance.

    Particles hop to empty neighbours on a chain and cannot pass each other: (1 - c)/c sqrt(4 D t /
    pi), where D is that of a lone particle. It holds once particles have hit their neighbours, and
    until they have crossed the chain.

    Parameters: `time` since any origin; `part` c of the sites with particles; `rate` D of hops in
    each direction. Raises ValueError unless 0 < c < 1. Source: R. Arratia, Ann. Probab. 11, 362
    (1983).

    >>> round(float(single_file_displacement(100.0, 0.5, 1.0)), 4)
    11.2838
    """
    if not 0 < part < 1:
        raise ValueError(f"part = {part!r}: expected a number between 0 and 1")
    return (1 - part) / part * np.sqrt(4 * rate * np.asarray(time, float) / math.pi)


def open_current(sites: int, enter: float, leave: float) -> float:
    """Particles that pass an open chain in a unit of time, at rate 1 of a hop forward.

    Parameters: `sites` L of the chain, `enter` alpha and `leave` beta, above 0. The ratio Z(L-1)/
    Z(L) of Z(L) = sum_p p (2L - 1 - p)!/(L! (L - p)!) (b^(p+1) - a^(p+1))/(b - a), with a =
    1/alpha, b = 1/beta; (L + 2)/(2 (2L + 1)) where both rates are 1. Raises ValueError for less
    than one site. Source: B. Derrida et al., J. Phys. A 26, 1493 (1993), eq. 39.

    >>> open_current(10, 1.0, 1.0) == 12 / 42, round(open_current(1000, 0.2, 1.0), 4)
    (True, 0.16)
    """
    whole(1, sites=sites)
    if not (enter > 0 and leave > 0):
        raise ValueError(f"enter, leave = {enter!r}, {leave!r}: expected numbers above 0")
    if enter == leave == 1:
        return (sites + 2) / (2 * (2 * sites + 1))
    return math.exp(_log_sum(sites - 1, enter, leave) - _log_sum(sites, enter, leave))


def _log_sum(sites: int, enter: float, leave: float) -> float:
    """Logarithm of Z(L)."""
    if sites == 0:
        return 0.0
    a, b = 1.0 / enter, 1.0 / leave
    terms = []
    for p in range(1, sites + 1):
        count = (
            math.log(p)
            + math.lgamma(2 * sites - p)
            - math.lgamma(sites + 1)
            - math.lgamma(sites - p + 1)
        )
        terms.append(count + _log_powers(p, a, b))
    top = max(terms)
    return top + math.log(math.fsum(math.exp(term - top) for term in terms))


def _log_powers(p: int, a: float, b: float) -> float:
    """Logarithm of a^p + a^(p-1) b + ... + b^p."""
    large, small = max(a, b), min(a, b)
    ratio = small / large
    series = (p + 1) if ratio == 1 else (1 - ratio ** (p + 1)) / (1 - ratio)
    return p * math.log(large) + math.log(series)
