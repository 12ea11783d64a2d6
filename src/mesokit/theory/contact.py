"""Collisions of two spheres: by a linear spring and a dashpot, and elastic (Hertz 1882)."""

import math
from typing import NamedTuple


class Collision(NamedTuple):
    """Normal velocity after over before, and how long it takes."""

    restitution: float
    time: float


def spring_dashpot(stiffness: float, damping: float, mass: float, pulls: bool = True) -> Collision:
    """Restitution and duration of a collision with the force k x + g dx/dt at the overlap x.

    With b = g/2m and w^2 = k/m - b^2: if the dashpot may pull until the overlap is zero, t = pi/w
    and e = exp(-b t). If the contact ends where the force is zero, t = (pi - atan2(2 b w,
    w^2 - b^2))/w, and, overdamped with W^2 = b^2 - k/m, t = log((b + W)/(b - W))/W; e = exp(-b t)
    (Schwager and Poschel, Granular Matter 9, 465, 2007).

    Parameters: `stiffness`, `damping` k and g; `mass` reduced mass; `pulls` whether the force may
    pull at the end.

    >>> e, t = spring_dashpot(1e5, 20.0, 0.5)
    >>> round(e, 6), round(t, 8)
    (0.868805, 0.00703185)
    >>> e, t = spring_dashpot(1e5, 20.0, 0.5, pulls=False)
    >>> round(e, 6), round(t, 8)
    (0.872291, 0.00683158)
    >>> round(spring_dashpot(1e5, 400.0, 0.5, pulls=False).restitution, 6)
    0.156517
    """
    b, square = 0.5 * damping / mass, stiffness / mass
    if b * b < square:
        w = math.sqrt(square - b * b)
        turn = math.pi if pulls else math.pi - math.atan2(2 * b * w, w * w - b * b)
        return Collision(math.exp(-b * turn / w), turn / w)
    if pulls:
        return Collision(0.0, math.inf)
    if b * b == square:
        return Collision(math.exp(-2.0), 2.0 / b)
    w = math.sqrt(b * b - square)
    time = math.log((b + w) / (b - w)) / w
    return Collision(math.exp(-b * time), time)


# the integral of 2 ds/sqrt(1 - s^(5/2)) from 0 to 1: contact time over largest overlap and speed
DURATION = 2 * math.sqrt(math.pi) * math.gamma(1.4) / math.gamma(0.9)


class Press(NamedTuple):
    """Largest overlap and how long the collision takes."""

    overlap: float
    time: float


def hertz_contact(stiffness: float, mass: float, speed: float) -> Press:
    """Largest overlap x = (5 m v^2/4k)^(2/5) and duration 2.943275 x/v, with the force k x^(3/2).

    Parameters: `stiffness`, `mass`, `speed` k, the reduced mass, and the normal velocity before the
    collision.

    >>> found = hertz_contact(1e5, 0.5, 1.0)
    >>> round(found.overlap, 8), round(found.time / found.overlap, 6)
    (0.00828614, 2.943275)
    """
    if speed == 0:
        return Press(0.0, math.inf)
    overlap = (1.25 * mass * speed**2 / stiffness) ** 0.4
    return Press(overlap, DURATION * overlap / speed)
