"""Inelastic collapse of spheres in a line, and contact times that avoid it."""

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


CORRELATED = 1.87  # measured in 2D at a packing fraction of 0.25; 2 in molecular chaos


def elastic_share(rate: float, contact_time: float, correlated: float = CORRELATED) -> float:
    """Share of the collisions of an elastic gas that follow another within the contact time.

    Either sphere has collided during the contact time before: 1 - exp(-2 rate t_c) in molecular
    chaos (Luding and McNamara 1998), with a little less than 2 in a gas of disks.

    Parameters: `rate` collisions of a sphere per time; `contact_time` in the same unit;
    `correlated` the factor in place of 2.

    >>> [round(elastic_share(1.0, x), 3) for x in (0.02, 0.1, 0.3)]
    [0.037, 0.171, 0.429]
    """
    return -math.expm1(-correlated * rate * contact_time)
