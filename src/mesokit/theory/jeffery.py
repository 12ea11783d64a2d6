"""Turning of bodies in a shear flow."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import dimension_two_or_three, not_negative, positive


def jeffery_period(aspect: float, shear_rate: float) -> float:
    """Time of a whole turn of a spheroid or an ellipse in a shear flow, 2 pi (r + 1/r)/rate.

    Parameters: `aspect` r, half axis of revolution over the other; `shear_rate`. Raises ValueError
    for a value not above 0. Source: G. B. Jeffery, Proc. R. Soc. A 102, 161 (1922), also for every
    orbit out of the plane. Valid without inertia and noise, in fluids that conserve angular
    momentum.

    >>> round(jeffery_period(2.0, 1.0), 3), round(jeffery_period(3.0, 1.0), 3)
    (15.708, 20.944)
    """
    positive(aspect=aspect, shear_rate=shear_rate)
    return 2 * math.pi * (aspect + 1 / aspect) / shear_rate


def jeffery_angle(time: ArrayLike, aspect: float, shear_rate: float) -> NDArray[np.float64]:
    """Angle phi of the axis from the gradient towards the flow, tan phi = r tan(t rate/(r + 1/r)).

    For an axis in the plane of the shear that starts along the gradient; phi goes on growing.

    Parameters: `time` t, any shape; `aspect`, `shear_rate`, errors, source and validity as in
    `jeffery_period`. In radians.

    >>> jeffery_angle([0.0, 1.0, 7.853982], aspect=2.0, shear_rate=1.0).round(4)
    array([0.    , 0.7019, 3.1416])
    """
    positive(aspect=aspect, shear_rate=shear_rate)
    phase = np.asarray(time, float) * shear_rate / (aspect + 1 / aspect)
    # r tan(phase) on the branch of the phase
    sine, cosine = np.sin(phase), np.cos(phase)
    return np.asarray(
        phase + np.arctan2((aspect - 1) * sine * cosine, cosine**2 + aspect * sine**2)
    )


def spin_in_shear(
    shear_rate: float, dimension: int = 3, collisional_share: float = 0.0, fraction: float = 0.0
) -> float:
    """Angular velocity of a free sphere or disk in a shear flow, (rate/2)/(1 - (1 - phi) c/d).

    Half the rate where collisions conserve angular momentum. Else the stress is not symmetric, and
    a fluid that turns drags a body on to turn faster than itself.

    Parameters: `shear_rate`; `dimension` d; `collisional_share` c of the viscosity that does not
    conserve angular momentum (0 for rules +a); `fraction` phi, volume of the body over that of a
    periodic cube or square with the shear as its mean. Raises ValueError for a value out of range.
    Source: derived in docs/theory.md, to first order in phi; the stress is that of I. O. Gotze, H.
    Noguchi and G. Gompper, Phys. Rev. E 76, 046705 (2007). Valid without inertia, with or without
    slip.

    >>> spin_in_shear(0.01), round(spin_in_shear(0.01, collisional_share=0.94), 5)
    (0.005, 0.00728)
    """
    dimension_two_or_three(dimension)
    not_negative(collisional_share=collisional_share, fraction=fraction)
    if max(collisional_share, fraction) > 1:
        raise ValueError("collisional_share, fraction: expected at most 1")
    return 0.5 * shear_rate / (1 - (1 - fraction) * collisional_share / dimension)
