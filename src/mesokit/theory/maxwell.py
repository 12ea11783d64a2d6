"""Velocities in thermal equilibrium."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import one_of, positive

Array = NDArray[np.float64]


def maxwell_component_pdf(velocity: ArrayLike, kT: float = 1.0, mass: float = 1.0) -> Array:
    """Probability density of one velocity component: normal, mean 0, variance kT/m.

    Parameters: `velocity` any shape; `kT`, `mass`. Raises ValueError unless both are above 0.
    Source: Maxwell (1860). In a finite system of N particles at rest the variance is
    (1 - 1/N) kT/m.

    >>> round(float(maxwell_component_pdf(0.0)), 6)
    0.398942
    """
    positive(kT=kT, mass=mass)
    v = np.asarray(velocity, dtype=float)
    return np.asarray(np.exp(-mass * v * v / (2 * kT)) * math.sqrt(mass / (2 * math.pi * kT)))


def maxwell_component_cdf(velocity: ArrayLike, kT: float = 1.0, mass: float = 1.0) -> Array:
    """Probability that a velocity component lies below the given value; see the density.

    >>> round(float(maxwell_component_cdf(1.0)), 6)
    0.841345
    """
    from scipy.special import ndtr

    positive(kT=kT, mass=mass)
    return np.asarray(ndtr(np.asarray(velocity, dtype=float) * math.sqrt(mass / kT)))


def maxwell_speed_pdf(
    speed: ArrayLike, dimension: int, kT: float = 1.0, mass: float = 1.0
) -> Array:
    """Probability density of the speed |v| in 1, 2 or 3 dimensions; 0 below zero speed.

    Parameters as for a component. Source: Maxwell (1860): chi distribution times sqrt(kT/m).

    >>> round(float(maxwell_speed_pdf(1.0, 3)), 6)
    0.483941
    """
    one_of((1, 2, 3), dimension=dimension)
    positive(kT=kT, mass=mass)
    s = np.asarray(speed, dtype=float)
    x = np.maximum(s, 0) * math.sqrt(mass / kT)
    norm = 2 ** (1 - dimension / 2) / math.gamma(dimension / 2) * math.sqrt(mass / kT)
    return np.where(s < 0, 0.0, norm * x ** (dimension - 1) * np.exp(-x * x / 2))


def maxwell_speed_cdf(
    speed: ArrayLike, dimension: int, kT: float = 1.0, mass: float = 1.0
) -> Array:
    """Probability that the speed lies below the given value; see its density.

    >>> round(float(maxwell_speed_cdf(1.0, 2)), 6)
    0.393469
    """
    from scipy.special import gammainc

    one_of((1, 2, 3), dimension=dimension)
    positive(kT=kT, mass=mass)
    s = np.maximum(np.asarray(speed, dtype=float), 0)
    return np.asarray(gammainc(dimension / 2, mass * s * s / (2 * kT)))
