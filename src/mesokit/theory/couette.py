"""Flow between two plates that move along themselves."""

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
