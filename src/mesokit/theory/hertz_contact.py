"""Two elastic spheres that collide (Hertz 1882)."""

import math
from typing import NamedTuple

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
