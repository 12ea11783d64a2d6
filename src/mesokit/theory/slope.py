"""Disks and spheres on a plane, by Coulomb's law of friction: they slide, roll or do both."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import none_negative, not_negative, positive


class Rolling(NamedTuple):
    """Acceleration down the plane, whether the body rolls without sliding, and of its spin.

    `spin` is the rate at which the angular velocity times the radius grows.
    """

    acceleration: float
    rolls: bool
    spin: float


def down_slope(angle: float, friction: float, gravity: float, kappa: float) -> Rolling:
    """How a body that was put on a slope starts to move.

    It rolls with g sin(angle)/(1 + kappa) if tan(angle) <= mu (1 + 1/kappa), and slides with
    g (sin(angle) - mu cos(angle)) else; the spin then grows by mu g cos(angle)/kappa. A body that
    cannot turn (kappa infinite) stays if tan(angle) <= mu.

    Parameters: `angle` of the slope, in radians; `friction` Coulomb's mu; `gravity` g; `kappa`
    moment of inertia over m r^2: 1/2 of a disk, 2/5 of a sphere, `math.inf` of a block.

    >>> down_slope(math.radians(20), 0.5, 1.0, 0.4).rolls
    True
    >>> slides = down_slope(math.radians(60), 0.2, 1.0, 0.5)
    >>> round(slides.acceleration, 6), round(slides.spin, 6)
    (0.766025, 0.2)
    """
    not_negative(friction=friction, gravity=gravity)
    if kappa != math.inf:
        positive(kappa=kappa)
    if math.tan(angle) <= friction * (1 + 1 / kappa):
        rolling = gravity * math.sin(angle) / (1 + kappa)
        return Rolling(rolling, True, rolling)
    normal = gravity * math.cos(angle)
    return Rolling(gravity * math.sin(angle) - friction * normal, False, friction * normal / kappa)


class EndOfSliding(NamedTuple):
    """When a body that slides begins to roll, and how fast it is then."""

    time: float
    speed: float


def end_of_sliding(speed: float, friction: float, gravity: float, kappa: float) -> EndOfSliding:
    """A body that was thrown along a level floor without spin: it rolls from the time
    kappa v/(mu g (1 + kappa)) on, with v/(1 + kappa).

    >>> end = end_of_sliding(1.0, 0.5, 1.0, 0.4)
    >>> round(end.time, 6), round(end.speed, 6)
    (0.571429, 0.714286)
    """
    positive(speed=speed, friction=friction, gravity=gravity, kappa=kappa)
    return EndOfSliding(kappa * speed / (friction * gravity * (1 + kappa)), speed / (1 + kappa))


class Thrown(NamedTuple):
    """Velocity, angular velocity times the radius, and distance gone, at each time."""

    speed: NDArray[np.float64]
    spin: NDArray[np.float64]
    distance: NDArray[np.float64]


def slide_to_roll(
    time: ArrayLike, speed: float, friction: float, gravity: float, kappa: float
) -> Thrown:
    """Motion of a body that was thrown along a level floor without spin.

    Until `end_of_sliding` it slows down by mu g, and its spin grows by mu g/kappa; then it rolls.

    Parameters: `time` since then, from 0; `speed` v at time 0; `friction` mu; `gravity` g; `kappa`
    as `down_slope`, finite. Raises ValueError for numbers out of range.

    >>> motion = slide_to_roll([0.0, 0.4, 1.0], 1.0, 0.5, 1.0, 0.4)
    >>> motion.speed.round(6).tolist(), motion.spin.round(6).tolist()
    ([1.0, 0.8, 0.714286], [0.0, 0.5, 0.714286])
    """
    none_negative(time=time)
    end = end_of_sliding(speed, friction, gravity, kappa)
    t = np.asarray(time, float)
    sliding = np.minimum(t, end.time)
    slowing = friction * gravity * sliding
    slid = speed * sliding - 0.5 * slowing * sliding
    rolled = end.speed * (t - sliding)
    return Thrown(
        np.asarray(speed - slowing), np.asarray(slowing / kappa), np.asarray(slid + rolled)
    )
