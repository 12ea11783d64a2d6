"""Cooling of a gas of inelastic hard spheres (Haff 1983)."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def haff_time(restitution: float, rate: float, dimension: int) -> float:
    """The time of Haff's law: t_H = 2 d/((1 - e^2) rate).

    Parameters: `restitution` coefficient e of smooth spheres, below 1; `rate` collisions of a
    sphere per time at the start; `dimension` 2 or 3.

    >>> from mesokit.theory import enskog_rate
    >>> import math
    >>> round(haff_time(0.9, enskog_rate(0.4 / math.pi, 1.0, 1.0, 0.1, 2), 2), 2)
    39.51
    """
    return 2 * dimension / ((1 - restitution**2) * rate)


def haff_temperature(time: ArrayLike, haff: float) -> NDArray[np.float64]:
    """Temperature over that of the start, (1 + t/t_H)^-2, as long as the gas is uniform.

    >>> haff_temperature([0.0, 1.0], 1.0)
    array([1.  , 0.25])
    """
    return np.asarray((1 + np.asarray(time, float) / haff) ** -2.0)
