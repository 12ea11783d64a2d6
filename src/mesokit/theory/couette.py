"""Uniform shear: between two plates that move along themselves, and in a periodic box."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive


def couette_velocity(
    y: ArrayLike, height: float, upper: float, lower: float | None = None
) -> NDArray[np.float64]:
    """Velocity lower + (upper - lower) y/H at the distance y from the lower plate.

    Parameters: `y` any shape, in [0, height]; `height` H in cells; `upper`, `lower` velocities of
    the plates; without `lower` they move against each other, giving U (2 y/H - 1). Raises
    ValueError for a height not above 0. Source: the Navier-Stokes equation, no slip, steady state.
    Valid for laminar flow and any viscosity that does not depend on the shear.

    >>> couette_velocity([0, 10, 20], height=20, upper=0.1).tolist()
    [-0.1, 0.0, 0.1]
    """
    positive(height=height)
    lower = -upper if lower is None else lower
    y = np.asarray(y, dtype=float)
    return np.asarray(lower + (upper - lower) * y / height)


def lees_edwards_velocity(y: ArrayLike, length: float, shear_rate: float) -> NDArray[np.float64]:
    """Velocity shear_rate (y - length/2) at the height y of a sheared periodic box.

    Parameters: `y` any shape, in [0, length]; `length` of the box along the gradient; `shear_rate`
    of either sign. Raises ValueError for a length not above 0. Source: Lees and Edwards (1972).
    Valid in the steady state and in the frame where the total momentum is zero.

    >>> lees_edwards_velocity([0, 10, 20], 20, 0.1).tolist()
    [-1.0, 0.0, 1.0]
    """
    positive(length=length)
    return shear_rate * (np.asarray(y, dtype=float) - length / 2)


def lees_edwards_relaxation_time(length: float, viscosity: float) -> float:
    """Time length^2/(pi^2 nu): start from rest needs several of it to reach the steady profile.

    Parameters: `length` of the box along the gradient; `viscosity` nu, kinematic. Raises ValueError
    unless both are above 0. Source: an upper bound. The deviation from the linear profile is
    periodic and odd about the middle, so that its slowest mode is k = 2 pi/length and dies within
    a quarter of this time; with plates instead of the images it is this time.

    >>> round(lees_edwards_relaxation_time(20, 0.87), 2)
    46.58
    """
    positive(length=length, viscosity=viscosity)
    return length**2 / (math.pi**2 * viscosity)
