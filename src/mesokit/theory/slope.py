"""Disks and spheres on an inclined plane, by Coulomb's law of friction."""

import math
from typing import NamedTuple

from mesokit.theory._check import not_negative, positive


class Rolling(NamedTuple):
    """Acceleration down the plane, and whether the body rolls without sliding."""

    acceleration: float
    rolls: bool


def down_slope(angle: float, friction: float, gravity: float, kappa: float) -> Rolling:
    """How a body that was put on a slope starts to move.

    It rolls with g sin(angle)/(1 + kappa) if tan(angle) <= mu (1 + 1/kappa), and slides with
    g (sin(angle) - mu cos(angle)) else.

    Parameters: `angle` of the slope, in radians; `friction` Coulomb's mu; `gravity` g; `kappa`
    moment of inertia over m r^2: 1/2 of a disk, 2/5 of a sphere.

    >>> down_slope(math.radians(20), 0.5, 1.0, 0.4).rolls
    True
    """
    not_negative(friction=friction, gravity=gravity)
    positive(kappa=kappa)
    if math.tan(angle) <= friction * (1 + 1 / kappa):
        return Rolling(gravity * math.sin(angle) / (1 + kappa), True)
    return Rolling(gravity * (math.sin(angle) - friction * math.cos(angle)), False)


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
