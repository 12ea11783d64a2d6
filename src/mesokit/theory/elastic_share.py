"""Share of collisions that a contact time makes elastic."""

import math

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
