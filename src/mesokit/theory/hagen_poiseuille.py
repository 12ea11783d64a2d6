"""Flow along a round pipe, driven by a uniform acceleration."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive


def hagen_poiseuille_velocity(
    r: ArrayLike, radius: float, acceleration: float, viscosity: float
) -> NDArray[np.float64]:
    """Velocity g (R^2 - r^2)/(4 nu) at the distance r from the axis.

    Parameters: `r` any shape, in [0, radius]; `radius` R of the pipe in cells; `acceleration` g
    along it; `viscosity` nu, kinematic. Raises ValueError for a radius or viscosity not above 0.
    Source: Landau and Lifshitz, Fluid Mechanics, eq. (17.9). Valid for laminar flow, radius well
    above a cell, velocities well below the speed of sound.

    >>> hagen_poiseuille_velocity([0, 5, 10], 10, acceleration=0.01, viscosity=0.5).tolist()
    [0.5, 0.375, 0.0]
    """
    positive(radius=radius, viscosity=viscosity)
    r = np.asarray(r, dtype=float)
    return np.asarray(acceleration * (radius**2 - r**2) / (4 * viscosity))


def hagen_poiseuille_flow_rate(radius: float, acceleration: float, viscosity: float) -> float:
    """Volume per time, pi g R^4/(8 nu).

    Parameters, errors and range as in `hagen_poiseuille_velocity`. Source: Landau and Lifshitz,
    Fluid Mechanics, eq. (17.10), Poiseuille's formula.

    >>> round(hagen_poiseuille_flow_rate(10, 0.01, 0.5), 4)
    78.5398
    """
    positive(radius=radius, viscosity=viscosity)
    return math.pi * acceleration * radius**4 / (8 * viscosity)
