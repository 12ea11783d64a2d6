"""Restitution below which spheres in a line collapse."""

import math


def collapse_restitution(spheres: int, wall: bool = True) -> float:
    """Restitution below which infinitely many collisions may take a finite time in 1D.

    On a wall: tan^2(pi/4 (1 - 1/N)) (Bernu and Mazighi 1990). Free: each half of an even number
    moves as if on a wall; of three free ones 7 - 4 sqrt(3) (McNamara and Young 1992). The law of
    many is that of the motion in which all collide in turn; of other starts some collapse above.

    Parameters: `spheres` their number, on a wall from 2, without 3 or an even number from 4; `wall`
    whether they collide with a wall that has the same restitution.

    Raises ValueError for a number whose law is not known.

    >>> [round(collapse_restitution(n), 4) for n in (2, 3, 4, 8, 16)]
    [0.1716, 0.3333, 0.4465, 0.6735, 0.8215]
    >>> round(collapse_restitution(3, wall=False), 4)
    0.0718
    """
    if not wall and spheres == 3:
        return 7 - 4 * math.sqrt(3)
    count = spheres if wall else spheres // 2
    if count < 2 or (not wall and spheres % 2):
        where = "on a wall" if wall else "without a wall"
        raise ValueError(f"{spheres} spheres {where}: no law is known")
    return math.tan(math.pi / 4 * (1 - 1 / count)) ** 2
