"""Flow driven by a force that varies as a sine across a periodic box."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive


def kolmogorov_velocity(
    y: ArrayLike,
    length: float,
    acceleration: float,
    viscosity: float,
    time: float = math.inf,
    waves: int = 1,
) -> NDArray[np.float64]:
    """Velocity g/(nu k^2) (1 - exp(-nu k^2 t)) sin(k y), k = 2 pi waves/length, from rest.

    Parameters: `y` any shape; `length` of the box along y; `acceleration` g, amplitude of
    g sin(k y); `viscosity` nu; `time` since the force was switched on (steady if infinite); `waves`
    in the box. Raises ValueError for length, viscosity or waves not above 0 or a time below 0.
    Source: the Navier-Stokes equation. Valid while stable: in a box longer along the flow than
    across it the flow breaks up for velocities above about 1.4 nu k; use a square or cubic box.

    >>> round(float(kolmogorov_velocity(5, 20, acceleration=0.01, viscosity=0.8)), 5)
    0.12665
    """
    positive(length=length, viscosity=viscosity, waves=waves)
    if not time >= 0:
        raise ValueError(f"time = {time!r}: expected 0 or more")
    k = 2 * math.pi * waves / length
    amplitude = acceleration / (viscosity * k * k) * -math.expm1(-viscosity * k * k * time)
    return amplitude * np.sin(k * np.asarray(y, dtype=float))


def kolmogorov_onset_time(length: float, viscosity: float, waves: int = 1) -> float:
    """Time 1/(nu k^2) in which the flow comes within 1/e of its steady state.

    Parameters as in `kolmogorov_velocity`; wait 5 of these before measuring to 1 %.

    >>> round(kolmogorov_onset_time(20, 0.8), 3)
    12.665
    """
    positive(length=length, viscosity=viscosity, waves=waves)
    return (length / (2 * math.pi * waves)) ** 2 / viscosity


def kolmogorov_viscosity(
    amplitude: float, length: float, acceleration: float, waves: int = 1
) -> float:
    """Viscosity g/(U k^2) from the amplitude U of the steady profile U sin(k y).

    Parameters as in `kolmogorov_velocity`. Raises ValueError unless amplitude and acceleration are
    not 0 and have the same sign.

    >>> round(kolmogorov_viscosity(0.12665, 20, 0.01), 3)
    0.8
    """
    positive(length=length, waves=waves)
    if not amplitude * acceleration > 0:
        raise ValueError(
            f"amplitude = {amplitude!r}: expected the sign of acceleration = {acceleration!r},"
            " and neither 0"
        )
    return acceleration / amplitude * (length / (2 * math.pi * waves)) ** 2
