"""Surfaces in one dimension: steps between columns, and how heights differ over a distance."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import whole

ANGLES = 16384  # at which integrals are taken


def solid_on_solid_steps(
    step: ArrayLike, ratio: float, columns: int | None = None
) -> NDArray[np.float64]:
    """Probability of a step between two neighbouring columns of a surface without overhangs.

    Parameters: `step` dh in atoms; `ratio` q = exp(-J/kT), from 0 to below 1, where a step costs
    the energy J |dh|; `columns` of a ring, whose steps add up to 0. In a long chain (1 - q)/(1 + q)
    q^|dh|. Raises ValueError for another ratio, or fewer than two columns. Source: Boltzmann's
    distribution; W. K. Burton, N. Cabrera and F. C. Frank, Phil. Trans. R. Soc. A 243, 299 (1951).

    >>> solid_on_solid_steps([0, 1, 2], 0.5).round(4).tolist()
    [0.3333, 0.1667, 0.0833]
    >>> solid_on_solid_steps([0, 1], 0.5, 10).round(4).tolist()
    [0.3531, 0.1736]
    """
    if not 0 <= ratio < 1:
        raise ValueError(f"ratio = {ratio!r}: expected a number from 0 to below 1")
    d = abs(np.asarray(step, float))
    if columns is None:
        return np.asarray((1 - ratio) / (1 + ratio) * ratio**d)
    whole(2, columns=columns)
    angle = 2 * math.pi * (np.arange(ANGLES) + 0.5) / ANGLES
    # transform of q^|dh|, over its largest value
    each = (1 - ratio) ** 2 / (1 - 2 * ratio * np.cos(angle) + ratio**2)
    others = np.cos(np.multiply.outer(d, angle)) @ each ** (columns - 1)
    return np.asarray(ratio**d * others * (1 - ratio) / (1 + ratio) / (each**columns).sum())


def ring_differences(
    distance: ArrayLike, columns: int, square_step: float = 1.0
) -> NDArray[np.float64]:
    """Mean square difference of the heights of two columns of a ring.

    Parameters: `distance` r in columns; `columns` L; `square_step`, the mean square of a step to
    the next column. All orders of the steps are as likely, and their sum is 0: r (L - r)/(L - 1)
    times the mean square of a step, which is 1 in the single-step model. Raises ValueError for
    fewer than two columns. Source: P. Meakin et al., Phys. Rev. A 34, 5091 (1986).

    >>> ring_differences([1, 2, 5], 10).round(4).tolist()
    [1.0, 1.7778, 2.7778]
    """
    whole(2, columns=columns)
    r = np.asarray(distance, float)
    return np.asarray(square_step * r * (columns - r) / (columns - 1))


def ring_width(columns: int, square_step: float = 1.0) -> float:
    """Mean square width of the surface of a ring: (L + 1)/12 times the mean square of a step.

    Parameters and source: those of `ring_differences`, of which it is half the mean over all r.

    >>> ring_width(15), round(float(ring_differences(range(15), 15).mean()) / 2, 6)
    (1.3333333333333333, 1.333333)
    """
    whole(2, columns=columns)
    return square_step * (columns + 1) / 12
