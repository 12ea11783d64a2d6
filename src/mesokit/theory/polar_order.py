"""Polar order of birds at random, and of birds that all see one another."""

import math
from typing import NamedTuple

import numpy as np

from mesokit.theory._check import dimension_two_or_three, whole
from mesokit.theory.heading_memory import vectorial_memory

SMALL = 0.05  # of the correction for the number of birds, beyond which the next one matters


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


class CrowdOrder(NamedTuple):
    """Polar order of birds that all see one another.

    many: of infinitely many, nan where order and disorder are both stable.
    mean, mean_square: of a number of them, nan where they are not known.
    """

    many: float
    mean: float
    mean_square: float


def vectorial_order(strength: float, number: int, dimension: int) -> CrowdOrder:
    """Polar order of birds with vectorial noise that all see one another.

    Parameters: `strength` eta, 0 to 1; `number` N of birds; `dimension` 2 or 3. A bird flies along
    m + eta xi, with m the mean heading and xi a random direction. Of infinitely many birds the
    order phi = |m| is then a fixed point of g(phi), the mean of the part of that unit vector along
    m: the slope of the potential of a sphere in 3D, 1 - eta^2/(3 phi^2) for phi > eta and 2 phi/(3
    eta) below; elliptic integrals in 2D, phi/(2 eta) for small phi. In 3D birds are ordered below
    eta = 2/3, where phi falls from 2/3 to 0, for below eta the slope of g is 2/(3 eta) whatever
    phi: there is no second branch. In 2D the ordered branch ends at eta = 0.6715 and disorder is
    stable above 1/2; between them both are, with an unstable branch between: `many` is then nan.

    Of N birds this is the first order in 1/N about the fixed point, with the variance of the order
    (that of one heading along m over N (1 - g'^2)) and its shift by it and by the headings across
    m. It leaves out terms of 1/N^2 and passages to and from order, which are the rarer the more
    birds there are; where the correction is more than 5 % (few birds, near the threshold) mean and
    mean square are nan. Raises ValueError for another dimension, strength, or no bird. Source:
    derived here; the noise is that of G. Gregoire and H. Chate, Phys. Rev. Lett. 92, 025702 (2004).

    >>> [round(float(x), 4) for x in vectorial_order(0.5, 400, 3)]
    [0.8963, 0.8966, 0.8039]
    >>> vectorial_order(0.6, 400, 2).many
    nan
    """
    whole(1, number=number)
    dimension_two_or_three(dimension)
    if not 0 <= strength <= 1:
        raise ValueError(f"strength must be from 0 to 1, got {strength}")
    if strength == 0:
        return CrowdOrder(1.0, 1.0, 1.0)
    if strength >= _strength_at(_last(dimension), dimension):  # no ordered branch
        return _disordered(strength, number, dimension)
    if strength > (dimension - 1) / dimension:
        return CrowdOrder(math.nan, math.nan, math.nan)
    return _ordered(strength, number, dimension)


def _last(dimension: int) -> float:
    """The largest strength over order on the stable branch: it ends there."""
    if dimension == 3:
        return 1.0
    from scipy.optimize import minimize_scalar

    found = minimize_scalar(
        lambda y: -_strength_at(y, 2), bounds=(0.5, 1.0), method="bounded", options={"xatol": 1e-9}
    )
    return float(found.x)


def _strength_at(y: float, dimension: int) -> float:
    """The strength at which phi = eta/y is a fixed point: g is a function of y alone."""
    return y * vectorial_memory(y, dimension)


def _ordered(strength: float, number: int, dimension: int) -> CrowdOrder:
    from scipy.optimize import brentq

    y = float(brentq(lambda y: _strength_at(y, dimension) - strength, 0.0, _last(dimension)))
    phi = strength / y
    # f: the part of a heading along m, averaged over the cosine c of the noise
    if dimension == 3:
        cosine, weight = np.polynomial.legendre.leggauss(400)
        weight = 0.5 * weight
    else:
        cosine, weight = np.cos(np.pi * (np.arange(2000) + 0.5) / 2000), np.full(2000, 1 / 2000)
    length = np.sqrt(phi**2 + strength**2 + 2 * phi * strength * cosine)
    f = (phi + strength * cosine) / length
    along = float(weight @ f**2)
    slope = float(weight @ ((1 - f**2) / length))
    bend = float(weight @ (-3 * f * (1 - f**2) / length**2))
    variance = (along - phi**2) / (1 - slope**2)
    shift = (0.5 * bend * variance + 0.5 * (1 - along) / phi) / (1 - slope)
    if abs(shift) > SMALL * number * phi or variance > SMALL * number * phi**2:
        return CrowdOrder(phi, math.nan, math.nan)
    mean = phi + shift / number
    return CrowdOrder(phi, mean, phi**2 + (2 * phi * shift + variance) / number)


def _disordered(strength: float, number: int, dimension: int) -> CrowdOrder:
    """The mean heading is normal, and keeps a share g' of itself; 3D has no further term."""
    slope = (dimension - 1) / (dimension * strength)
    square = 1 / (number * (1 - slope**2) + slope**2) if slope < 1 else math.inf
    if dimension == 2:
        cubic = 1 / (16 * strength**3)
        more = 4 * slope * cubic * square / (1 - slope**2)
        square *= 1 + more
    else:
        more = square / strength**2
    if more > SMALL:
        return CrowdOrder(0.0, math.nan, math.nan)
    return CrowdOrder(0.0, disordered_order(1, dimension) * math.sqrt(square), square)
