"""Friction of an ellipsoid that is drawn or turned in a viscous fluid."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import all_positive, positive


class EllipsoidFriction(NamedTuple):
    """Friction of an ellipsoid, one value for each of its axes.

    `translation` force over velocity along the axis; `rotation` torque over angular velocity
    about it.
    """

    translation: NDArray[np.float64]
    rotation: NDArray[np.float64]


def ellipsoid_friction(half_axes: ArrayLike, viscosity: float) -> EllipsoidFriction:
    """Friction 16 pi eta/(X + A_i a_i^2) along axis i, (16 pi eta/3)(a_j^2 + a_k^2)/(A_j a_j^2 +
    A_k a_k^2) about it.

    X is the integral of 1/D over s from 0, A_i that of 1/((a_i^2 + s) D), with D the root of the
    product of all a_i^2 + s.

    Parameters: `half_axes` (3,) a_i in cells; `viscosity` eta, dynamic. Raises ValueError for a
    value not above 0. Source: F. Perrin, J. Phys. Radium 5, 497 (1934); H. Brenner, Int. J.
    Multiphase Flow 1, 195 (1974). Valid without slip and inertia, far from all else.

    >>> found = ellipsoid_friction([2.0, 1.0, 1.0], viscosity=1.0)
    >>> [round(float(f), 3) for f in found.translation[:2] / (6 * math.pi)]
    [1.204, 1.379]
    >>> [round(float(f), 3) for f in found.rotation[:2] / (8 * math.pi)]
    [1.613, 3.01]
    """
    axes = np.asarray(half_axes, float)
    if axes.shape != (3,):
        raise ValueError(f"half_axes = {half_axes!r}: expected 3 of them")
    all_positive(half_axes=axes)
    positive(viscosity=viscosity)
    from scipy.special import elliprf

    square = axes**2
    weight = np.array([2 * depolarisation(axes, i) / axes.prod() for i in range(3)]) * square
    along = 16 * math.pi * viscosity / (2 * elliprf(*square) + weight)
    others = square.sum() - square, weight.sum() - weight
    return EllipsoidFriction(along, 16 / 3 * math.pi * viscosity * others[0] / others[1])


def depolarisation(half_axes: ArrayLike, axis: int) -> float:
    """Depolarisation factor of an ellipsoid along an axis, (abc/2) A_i as in `ellipsoid_friction`.

    1/3 for a sphere; the three factors of a body add up to 1.

    Parameters: `half_axes` (3,) in cells; `axis` i, 0 to 2. Raises ValueError for a half axis not
    above 0. Source: J. A. Osborn, Phys. Rev. 67, 351 (1945).

    >>> round(depolarisation([2.0, 1.0, 1.0], 0), 4), round(depolarisation([2.0, 1.0, 1.0], 1), 4)
    (0.1736, 0.4132)
    """
    all_positive(half_axes=half_axes)
    from scipy.special import elliprd

    axes = np.asarray(half_axes, float)
    others = np.delete(axes, axis) ** 2
    return float(axes.prod() / 3 * elliprd(*others, axes[axis] ** 2))
