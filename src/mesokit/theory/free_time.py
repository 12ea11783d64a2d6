"""Times of flight of hard spheres between two collisions."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import one_of
from mesokit.theory.maxwell import maxwell_speed_pdf

Array = NDArray[np.float64]
FASTEST, POINTS = 9.0, 200  # thermal velocities; of the quadrature


class Speeds(NamedTuple):
    """Weights of speeds by Maxwell, and how often a sphere of each collides, over the mean rate."""

    weight: Array
    rate: Array


def collision_speeds(dimension: int) -> Speeds:
    """How often equal hard spheres of a speed collide in molecular chaos: as the mean of |v - v'|.

    Parameters: `dimension` 2 or 3.

    >>> found = collision_speeds(3)
    >>> float(round(found.weight.sum(), 9)), float(round(found.rate[0], 4))
    (1.0, 0.7071)
    """
    from scipy.special import erf, i0e, i1e

    one_of((2, 3), dimension=dimension)
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    u = FASTEST / 2 * (nodes + 1)
    weight = FASTEST / 2 * weights * maxwell_speed_pdf(u, dimension)
    if dimension == 3:
        mean = math.sqrt(2 / math.pi) * np.exp(-u * u / 2) + (u + 1 / u) * erf(u / math.sqrt(2))
    else:
        x = u * u / 4
        mean = math.sqrt(math.pi / 2) * ((1 + 2 * x) * i0e(x) + 2 * x * i1e(x))
    return Speeds(weight, mean / (weight @ mean))


def free_time_cdf(time: ArrayLike, dimension: int) -> Array:
    """Probability that a flight is shorter than a time, in mean free times.

    A sphere of speed v collides at a rate r(v), and flights begin with that speed as often as they
    end with it: F = 1 - <r exp(-r t)>/<r> (Visco, van Wijland and Trizac 2008). Exact for dilute
    elastic spheres. It is not exactly 1 - exp(-t).

    Parameters: `time` of flight over its mean; `dimension` 2 or 3.

    >>> [round(float(x), 4) for x in free_time_cdf([0.0, 1.0, 5.0], 3)]
    [0.0, 0.639, 0.9914]
    """
    weight, rate = collision_speeds(dimension)
    t = np.asarray(time, float)
    left = np.exp(-np.multiply.outer(t, rate)) @ (weight * rate)
    return np.asarray(1 - left)


def free_time_spread(dimension: int) -> float:
    """<t^2>/<t>^2 of times of flight: 2 <1/r> <r>, and 2 if rates did not depend on the speed.

    Parameters: `dimension` 2 or 3.

    >>> round(free_time_spread(2), 4), round(free_time_spread(3), 4)
    (2.1084, 2.0761)
    """
    weight, rate = collision_speeds(dimension)
    return float(2 * (weight @ (1 / rate)))
