"""Flow of grains out of a silo through an orifice (Beverloo, Leniger and van de Velde 1961)."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import (
    all_positive,
    dimension_two_or_three,
    none_negative,
    not_negative,
    positive,
)
from mesokit.theory._least_squares import weighted_least_squares

PREFACTOR = {2: 1.03, 3: 0.58}


def beverloo_rate(
    opening: ArrayLike,
    diameter: float,
    density: float,
    gravity: float,
    dimension: int,
    prefactor: float | None = None,
    blocked: float = 1.4,
) -> NDArray[np.float64]:
    """Mass that leaves a silo per time, whatever the height of the filling.

    C rho sqrt(g) (D - k d)^(5/2) in 3D, with the power 3/2 in 2D; 0 below k d, where grains jam.
    Empirical: usual are C = 0.55 to 0.65 and k = 1.4 (up to 3 for grains that are not round) of a
    round hole in a flat floor; of a slot C = 1.03 for each unit of its length, which is the value
    in 2D. Both depend on friction and the packing: fit them (`beverloo_fit`). Grains stop
    by themselves below some 5 d in 3D, more in 2D.

    Parameters: `opening` D, diameter of the hole or width of the slot; `diameter` d of grains;
    `density` rho, mass of the filling in a volume (area in 2D), with voids; `gravity` g;
    `dimension` 2 or 3; `prefactor` C, None for 0.58 in 3D and 1.03 in 2D; `blocked` k.

    Raises ValueError for numbers out of range. Source: W. A. Beverloo, H. A. Leniger and J. van de
    Velde, Chem. Eng. Sci. 15, 260 (1961); of slots R. M. Nedderman, U. Tuzun, S. B. Savage and
    G. T. Houlsby, Chem. Eng. Sci. 37, 1597 (1982).

    >>> beverloo_rate([1.0, 5.0, 10.0], 1.0, 0.6, 1.0, 3).round(4).tolist()
    [0.0, 8.5573, 75.4789]
    """
    none_negative(opening=opening)
    positive(diameter=diameter, density=density, gravity=gravity)
    not_negative(blocked=blocked)
    dimension_two_or_three(dimension)
    factor = PREFACTOR[dimension] if prefactor is None else prefactor
    positive(prefactor=factor)
    free = np.maximum(np.asarray(opening, float) - blocked * diameter, 0.0)
    return np.asarray(factor * density * math.sqrt(gravity) * free ** (dimension - 0.5))


def beverloo_line(rate: ArrayLike, dimension: int) -> NDArray[np.float64]:
    """The power of a flow rate that is linear in the opening: rate^(2/3) in 2D, rate^(2/5) in 3D.

    Parameters: `rate` of mass, or of grains; `dimension` 2 or 3. Raises ValueError for negative
    rates.

    >>> rates = beverloo_rate([5.0, 6.0, 7.0], 1.0, 0.6, 1.0, 3)
    >>> np.diff(beverloo_line(rates, 3)).round(6).tolist()
    [0.655589, 0.655589]
    """
    none_negative(rate=rate)
    dimension_two_or_three(dimension)
    return np.asarray(np.asarray(rate, float) ** (2 / (2 * dimension - 1)))


class BeverlooFit(NamedTuple):
    """Constants C and k of Beverloo's law with standard errors."""

    prefactor: float
    blocked: float
    prefactor_error: float
    blocked_error: float


def beverloo_fit(
    opening: ArrayLike,
    rate: ArrayLike,
    error: ArrayLike | None,
    diameter: float,
    density: float,
    gravity: float,
    dimension: int,
) -> BeverlooFit:
    """C and k of measured flow rates, by a line through rate^(2/3) or rate^(2/5).

    Parameters: `opening`, `rate` openings and the rates of mass through them, above 0; `error`
    their standard errors, None for the scatter about the line; the others as `beverloo_rate`.
    Raises ValueError for numbers out of range, or too few points.

    >>> rates = beverloo_rate([6.0, 8.0, 10.0], 1.0, 0.8, 1.0, 2, 1.1, 2.1)
    >>> found = beverloo_fit([6.0, 8.0, 10.0], rates, 0.01 * rates, 1.0, 0.8, 1.0, 2)
    >>> round(found.prefactor, 6), round(found.blocked, 6)
    (1.1, 2.1)
    """
    positive(diameter=diameter, density=density, gravity=gravity)
    dimension_two_or_three(dimension)
    all_positive(opening=opening, rate=rate)
    opening, rate = np.asarray(opening, float), np.asarray(rate, float)
    power = 2 / (2 * dimension - 1)
    line = rate**power
    spread = None if error is None else power * line * np.asarray(error, float) / rate
    # About the mean opening slope and height are almost independent.
    middle = float(opening.mean())
    basis = np.stack([np.ones_like(opening), opening - middle], axis=-1)
    (height, slope), covariance = weighted_least_squares(basis, line, spread)
    factor = float(slope ** (1 / power) / (density * math.sqrt(gravity)))
    blocked = float((middle - height / slope) / diameter)
    to_blocked = np.array([-1 / slope, height / slope**2]) / diameter
    return BeverlooFit(
        factor,
        blocked,
        float(factor / power / slope * math.sqrt(covariance[1, 1])),
        math.sqrt(to_blocked @ covariance @ to_blocked),
    )
