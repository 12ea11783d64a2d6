"""Stress in a silo whose walls carry a part of the weight by friction (Janssen 1895)."""

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import dimension_two_or_three, none_negative, one_of, positive


def stress_ratio(angle: float, state: Literal["active", "at-rest"] = "active") -> float:
    """Horizontal over vertical stress, the K of Janssen's law.

    `active`, (1 - sin(angle))/(1 + sin(angle)): grains on the verge of sliding down and sideways
    (Rankine 1857). `at-rest`, 1 - sin(angle): filled between walls that do not yield (Jaky 1944),
    an empirical law. Real fillings lie at 0.3 to 1; the smallest possible K is the active one.

    Parameters: `angle` of internal friction, in radians: that of the slope at which a heap slides,
    not that of two grains; `state` of the filling. Raises ValueError for an angle that is not above
    0 and below pi/2, or another state.

    >>> angle = math.radians(30)
    >>> round(stress_ratio(angle), 6), round(stress_ratio(angle, "at-rest"), 6)
    (0.333333, 0.5)
    """
    one_of(("active", "at-rest"), state=state)
    if not 0 < angle < math.pi / 2:
        raise ValueError(f"angle = {angle!r}: expected a number above 0 and below pi/2")
    sine = math.sin(angle)
    return (1 - sine) / (1 + sine) if state == "active" else 1 - sine


def janssen_length(diameter: float, friction: float, ratio: float, dimension: int) -> float:
    """Depth at which the stress in a silo levels off: D/(4 mu K) in 3D, D/(2 mu K) in 2D.

    Parameters: `diameter` D of a round silo, or the distance of the walls in 2D; `friction` mu of
    grains at the wall; `ratio` K of horizontal to vertical stress; `dimension` 2 or 3. Raises
    ValueError for numbers not above 0. Source: H. A. Janssen, Z. Ver. Dtsch. Ing. 39, 1045 (1895).

    >>> janssen_length(20.0, 0.5, 0.5, 3), janssen_length(20.0, 0.5, 0.5, 2)
    (20.0, 40.0)
    """
    positive(diameter=diameter, friction=friction, ratio=ratio)
    dimension_two_or_three(dimension)
    return diameter / (2 * (dimension - 1) * friction * ratio)


def janssen_stress(
    depth: ArrayLike, length: float, density: float, gravity: float, load: float = 0.0
) -> NDArray[np.float64]:
    """Mean vertical stress of grains at a depth in a silo.

    rho g l (1 - exp(-z/l)) + load exp(-z/l). The horizontal stress at the wall is K times that.
    Approximate: friction is fully mobilised at all places of the wall, K is the same everywhere,
    and stress is even across the silo. Measured loads depend on how the silo was filled.

    Parameters: `depth` z below the surface; `length` l, such as `janssen_length`; `density` mass of
    the filling in a volume (area in 2D), with voids; `gravity`; `load` on the surface, as a stress.
    Raises ValueError for numbers out of range.

    >>> janssen_stress([0.0, 20.0, 1000.0], 20.0, 1.0, 1.0).round(4).tolist()
    [0.0, 12.6424, 20.0]
    """
    none_negative(depth=depth, load=load)
    positive(length=length, density=density, gravity=gravity)
    far = np.asarray(depth, float) / length
    return np.asarray(-density * gravity * length * np.expm1(-far) + load * np.exp(-far))


def janssen_share(height: ArrayLike, length: float) -> NDArray[np.float64]:
    """Load on the floor of a silo over the weight of the filling: (l/h) (1 - exp(-h/l)).

    Parameters: `height` h of the filling, from 0, where walls carry nothing; `length` l, such as
    `janssen_length`. Approximate as `janssen_stress`. Raises ValueError for numbers out of range.

    >>> janssen_share([0.0, 20.0, 40.0], 20.0).round(6).tolist()
    [1.0, 0.632121, 0.432332]
    """
    none_negative(height=height)
    positive(length=length)
    far = np.asarray(height, float) / length
    return np.asarray(np.where(far > 0, -np.expm1(-far) / np.where(far > 0, far, 1.0), 1.0))
