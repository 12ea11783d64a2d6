"""Flow between two plates at rest, driven by a uniform acceleration."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive
from mesokit.theory._least_squares import weighted_least_squares

Array = NDArray[np.float64]


class PoiseuilleFit(NamedTuple):
    """Viscosity from the curvature of a profile, and the velocity that it has at the walls."""

    viscosity: float
    viscosity_error: float
    slip: float
    slip_error: float


def poiseuille_velocity(
    y: ArrayLike, height: float, acceleration: float, viscosity: float
) -> Array:
    """Velocity g y (H - y)/(2 nu) at the distance y from the lower plate.

    Parameters: `y` any shape, in [0, height]; `height` H of the slit in cells; `acceleration` g
    of the fluid; `viscosity` nu, kinematic. Raises ValueError for a height or viscosity not above
    0. Source: the Navier-Stokes equation, no slip. Valid for laminar flow that does not vary along
    the slit, height well above a cell, velocities well below the speed of sound.

    >>> poiseuille_velocity([0, 5, 10], height=10, acceleration=0.01, viscosity=0.5).tolist()
    [0.0, 0.25, 0.0]
    >>> round(float(poiseuille_velocity(15, 30, 0.002, 0.87)), 6)
    0.258621
    """
    positive(height=height, viscosity=viscosity)
    y = np.asarray(y, dtype=float)
    return np.asarray(acceleration * y * (height - y) / (2 * viscosity))


def poiseuille_fit(
    y: ArrayLike,
    velocity: ArrayLike,
    height: float,
    acceleration: float,
    error: ArrayLike | None = None,
) -> PoiseuilleFit:
    """Viscosity and wall slip of a measured profile, by weighted least squares.

    The parabola slip + s y (H - y) is fitted: nu = g/(2 s) comes from the curvature alone, so slip
    at the walls does not bias it.

    Parameters:
        y: (n,) heights; in cells, `height` H likewise. Leave out cells cut by a wall.
        velocity: (n,) mean velocities. A mean over a bin of width b lies s b^2/12 below the value
            at its centre: it is read as slip, not as viscosity.
        acceleration: g, not 0.
        error: (n,) standard errors of the velocities, independent of each other; without them all
            points weigh alike and the scatter about the fit gives the errors.

    Raises ValueError for shapes that differ, fewer than 3 points, errors not above 0, g = 0.
    Source: linear least squares; the error of nu is first order in that of the curvature.

    >>> y = np.arange(0.5, 10)
    >>> u = 0.003 + poiseuille_velocity(y, 10, 0.01, 0.5)
    >>> fit = poiseuille_fit(y, u, 10, 0.01, error=np.full(10, 1e-3))
    >>> round(fit.viscosity, 6), round(fit.slip, 6), round(fit.viscosity_error, 5)
    (0.5, 0.003, 0.00218)
    """
    positive(height=height)
    if acceleration == 0:
        raise ValueError("acceleration = 0: expected another value, no viscosity without flow")
    y = np.asarray(y, dtype=float)
    basis = np.stack([np.ones_like(y), y * (height - y)], axis=-1)
    (slip, scale), covariance = weighted_least_squares(basis, velocity, error)
    viscosity = acceleration / (2 * scale)
    return PoiseuilleFit(
        viscosity=float(viscosity),
        viscosity_error=float(abs(viscosity / scale) * np.sqrt(covariance[1, 1])),
        slip=float(slip),
        slip_error=float(np.sqrt(covariance[0, 0])),
    )
