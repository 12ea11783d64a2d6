"""Two spheres that collide by a linear spring and a dashpot."""

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
