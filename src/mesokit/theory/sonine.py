"""Velocities near those of Maxwell: the first correction, by a Sonine polynomial."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory.maxwell import (
    maxwell_component_cdf,
    maxwell_component_pdf,
    maxwell_speed_cdf,
    maxwell_speed_pdf,
)

Array = NDArray[np.float64]


def sonine_component_cdf(velocity: ArrayLike, cumulant: float) -> Array:
    """Probability that a component lies below the given value, in thermal velocities sqrt(kT/m).

    Its density is Maxwell's times 1 + a_2 (u^4 - 6 u^2 + 3)/8 (van Noije and Ernst 1998).

    Parameters: `velocity` component u over sqrt(kT/m); `cumulant` fourth cumulant a_2, small
    against 1.

    >>> [round(float(sonine_component_cdf(1.0, cumulant)), 6) for cumulant in (0.0, 0.1)]
    [0.841345, 0.847394]
    """
    u = np.asarray(velocity, dtype=float)
    changed = maxwell_component_pdf(u) * (u**3 - 3 * u)
    return np.asarray(maxwell_component_cdf(u) - cumulant / 8 * changed)


def sonine_speed_cdf(speed: ArrayLike, dimension: int, cumulant: float) -> Array:
    """Probability that a speed lies below the given value, in thermal velocities sqrt(kT/m).

    The density of velocities is Maxwell's times 1 + a_2 S(u^2/2), with the Sonine polynomial
    S(x) = x^2/2 - (d + 2) x/2 + d (d + 2)/8 (van Noije and Ernst 1998).

    Parameters: `speed` u over sqrt(kT/m); `dimension` d, 2 or 3; `cumulant` fourth cumulant
    a_2, small against 1.

    >>> [round(float(sonine_speed_cdf(1.0, 3, cumulant)), 6) for cumulant in (0.0, 0.1)]
    [0.198748, 0.222945]
    """
    u = np.asarray(speed, dtype=float)
    changed = u * maxwell_speed_pdf(u, dimension) * (dimension / 2 + 1 - u * u / 2)
    return np.asarray(maxwell_speed_cdf(u, dimension) + cumulant / 4 * changed)


def fourth_cumulant(restitution: float, dimension: int, heated: bool = False) -> float:
    """a_2 = d/(d + 2) <v^4>/<v^2>^2 - 1 of smooth inelastic spheres, 0 of Maxwell's.

    To first order in a_2 in a dilute uniform gas: cooling freely, or held by random kicks (van
    Noije and Ernst 1998).

    Parameters: `restitution` coefficient e, constant; `dimension` 2 or 3; `heated` whether random
    kicks (white noise) give back what collisions take.

    >>> round(fourth_cumulant(0.5, 3), 5), round(fourth_cumulant(0.5, 3, heated=True), 5)
    (0.05246, 0.0256)
    >>> round(fourth_cumulant(0.9, 2), 5)
    -0.02686
    """
    e, d = restitution, dimension
    above = 16 * (1 - e) * (1 - 2 * e**2)
    if heated:
        return above / (73 + 56 * d - 3 * (35 + 8 * d) * e + 30 * (1 - e) * e**2)
    return above / (9 + 24 * d + (8 * d - 41) * e + 30 * (1 - e) * e**2)
