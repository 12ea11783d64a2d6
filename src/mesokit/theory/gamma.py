"""Kinetic energy of a cell about its centre of mass, in thermal equilibrium."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import dimension_two_or_three, positive

Array = NDArray[np.float64]


def cell_energy_pdf(energy: ArrayLike, particles: int, dimension: int, kT: float = 1.0) -> Array:
    """Probability density of the relative kinetic energy of N particles: Gamma(d(N-1)/2, kT).

    Parameters: `energy` any shape, 0 below zero; `particles` N >= 2; `dimension` 2 or 3; `kT`.
    Raises ValueError for a value out of range. Source: Huang, Chatterji, Sutmann, Gompper and
    Winkler (2010), the law that the Maxwell-Boltzmann thermostat imposes. Exact in equilibrium.

    >>> round(float(cell_energy_pdf(1.0, 2, 2)), 6)
    0.367879
    """
    from scipy.special import gammaln, xlogy

    shape = _shape(particles, dimension, kT)
    x = np.asarray(energy, dtype=float) / kT
    inside = np.maximum(x, 0)
    with np.errstate(divide="ignore"):  # the density of one degree of freedom diverges at zero
        log = xlogy(shape - 1, inside) - inside - gammaln(shape)
    return np.where(x < 0, 0.0, np.exp(log) / kT)


def cell_energy_cdf(energy: ArrayLike, particles: int, dimension: int, kT: float = 1.0) -> Array:
    """Probability that the relative kinetic energy of a cell lies below a value; see the density.

    >>> round(float(cell_energy_cdf(1.0, 2, 2)), 6)
    0.632121
    """
    from scipy.special import gammainc

    shape = _shape(particles, dimension, kT)
    return np.asarray(gammainc(shape, np.maximum(np.asarray(energy, dtype=float) / kT, 0)))


def cell_energy_variance(particles: int, dimension: int, kT: float = 1.0) -> float:
    """Variance f (kT)^2/2 of that energy, f = d(N-1) degrees of freedom; its mean is f kT/2.

    >>> cell_energy_variance(11, 3)
    15.0
    """
    return _shape(particles, dimension, kT) * kT**2


def _shape(particles: int, dimension: int, kT: float) -> float:
    dimension_two_or_three(dimension)
    positive(kT=kT)
    if particles < 2 or particles != int(particles):
        raise ValueError(f"particles = {particles!r}: expected a whole number, 2 or more")
    return dimension * (particles - 1) / 2
