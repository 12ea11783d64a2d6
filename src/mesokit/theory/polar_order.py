"""Polar order of birds in the limits that are exact."""

from __future__ import annotations

import math

from mesokit.theory._check import dimension_two_or_three, whole


def disordered_order(number: int, dimension: int) -> float:
    """Mean polar order of birds with directions at random, for many of them.

    Parameters: `number` N of birds; `dimension` 2 or 3. The sum of N unit vectors is then normal:
    sqrt(pi/(4 N)) in 2D (Rayleigh), sqrt(8/(3 pi N)) in 3D (Maxwell). Raises ValueError for another
    dimension or no bird. Source: Lord Rayleigh, Phil. Mag. 37, 321 (1919).

    >>> round(disordered_order(300, 2), 4), round(disordered_order(300, 3), 4)
    (0.0512, 0.0532)
    """
    whole(1, number=number)
    dimension_two_or_three(dimension)
    return math.sqrt((math.pi / 4 if dimension == 2 else 8 / (3 * math.pi)) / number)


def mean_square_order(memory: float, number: int) -> float:
    """Mean square of the polar order of N birds that all see one another: a^2 + (1 - a^2)/N.

    Parameters: `memory` a, the mean cosine by which the noise turns a bird from the common
    direction (`angular_memory`); `number` N. It is exact for any N, as birds turn from one
    direction each on its own. Raises ValueError for a memory that is not from 0 to 1, or no bird.
    Source: derived here, for T. Vicsek et al., Phys. Rev. Lett. 75, 1226 (1995).

    >>> mean_square_order(0.5, 100), mean_square_order(0.0, 100)
    (0.2575, 0.01)
    """
    whole(1, number=number)
    if not 0 <= memory <= 1:
        raise ValueError(f"memory must be from 0 to 1, got {memory}")
    return memory**2 + (1 - memory**2) / number


def disordered_binder(dimension: int) -> float:
    """Binder cumulant 1 - <phi^4>/(3 <phi^2>^2) of directions at random: 1/3 in 2D, 4/9 in 3D.

    Where all birds are aligned it is 2/3. Raises ValueError for another dimension. Source: K.
    Binder, Z. Phys. B 43, 119 (1981), for an order with two or three normal components.

    >>> round(disordered_binder(2), 4), round(disordered_binder(3), 4)
    (0.3333, 0.4444)
    """
    dimension_two_or_three(dimension)
    return 1 - (2 if dimension == 2 else 5 / 3) / 3
