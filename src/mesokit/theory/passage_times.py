"""How long a walker takes: to a place that it drifts to, and out of a slab that it wanders in."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import not_negative, positive

MILNE = 1.4603545088095868  # -zeta(1/2)
OVERSHOOT = 0.5825971579390106  # -zeta(1/2)/sqrt(2 pi)


def first_passage_cdf(
    time: ArrayLike, length: float, velocity: float, diffusion: float
) -> NDArray[np.float64]:
    """Probability that a drifting walker has come a length further by a time, (*time).

    The inverse Gaussian distribution: mean length/velocity, variance 2 D length/velocity^3. So are
    the times between the first arrivals at planes that are the length apart, one after the other.

    Parameters: `time` since it was a `length` before; `velocity` of the drift; `diffusion`
    coefficient. Raises ValueError for a value not above 0. Source: E. Schroedinger, Phys. Z. 16,
    289 (1915). Exact for Brownian motion; of a walker with memory once times are longer than that.

    >>> first_passage_cdf([0.0, 10.0, 1e9], length=10, velocity=1, diffusion=0.5).round(3).tolist()
    [0.0, 0.562, 1.0]
    """
    from scipy.special import log_ndtr, ndtr

    positive(length=length, velocity=velocity, diffusion=diffusion)
    t = np.maximum(np.asarray(time, float), 0.0)
    mean, shape = length / velocity, length**2 / (2 * diffusion)
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(shape / t)
        behind = np.exp(2 * shape / mean + log_ndtr(-root * (t / mean + 1)))
        return np.where(t > 0, ndtr(root * (t / mean - 1)) + behind, 0.0)


def mean_exit_time(
    width: float, diffusion: float, interval: float = 0.0, memory: float = 0.0
) -> float:
    """Mean time in which a walker leaves a slab, from any place in it: width^2/(12 D).

    A walker is out only when it is found outside: as if the slab were wider at each side, by
    0.5826 sqrt(2 D interval) for looks at an interval, and by 1.4603 sqrt(D memory) for a velocity
    that is remembered for a time (Milne's problem); both together as the root of their squares.

    Parameters: `width` of the slab; `diffusion` coefficient; `interval` between two looks;
    `memory`, the time D m/kT in which a velocity is forgotten. Raises ValueError for a value out
    of range. Source: the mean of x (width - x)/(2 D); for looks H. Chernoff, Ann. Math. Stat. 36,
    55 (1965); for memory T. W. Marshall and E. J. Watson, J. Phys. A 18, 3531 (1985). Exact for
    Brownian motion without looks, to the order of the interval with them; with memory within 3 %,
    by random walks, for slabs ten times as wide as the way on which a velocity is forgotten.

    >>> mean_exit_time(6, 0.5)
    6.0
    """
    positive(width=width, diffusion=diffusion)
    not_negative(interval=interval, memory=memory)
    looks = OVERSHOOT * math.sqrt(2 * diffusion * interval)
    further = math.hypot(looks, MILNE * math.sqrt(diffusion * memory))
    return (width**2 / 6 + further * width + further**2) / (2 * diffusion)
