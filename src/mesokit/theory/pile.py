"""The smallest piles: one grain on two disks, or on a ring of spheres, on a floor."""

import math
from typing import NamedTuple

from mesokit.theory._check import positive, whole


class PileFriction(NamedTuple):
    """Smallest coefficients of friction between grains and at the floor."""

    grains: float
    floor: float


def pile_friction(base: int, weight: float = 1.0, spacing: float = 1.0) -> PileFriction:
    """Friction without which a grain on a ring of equal ones pushes them apart (derived here).

    The line from a base grain to the top has an angle b with the vertical, sin(b) = spacing/(2
    sin(pi/n)). A base grain has no torque about its floor contact: the force of the top points
    there, at b/2 to the normal. So grains need mu = tan(b/2), and the floor, which bears the weight
    of the base too, w/(n + w) of that. Three disks: 2 - sqrt(3) and a third of it; four spheres:
    sqrt(3) - sqrt(2) and a quarter. Neighbours in the base may touch, and then do not press.

    Parameters: `base` grains on the floor: n = 2 disks, or a regular polygon of 3 to 5 spheres;
    `weight` w of the top, all of the same radius, over that of a base grain; `spacing` of
    neighbours in the base, in diameters, from 1. Raises ValueError for numbers out of range, or a
    top that would fall through. Exact.

    >>> [round(mu, 6) for mu in pile_friction(2)], [round(mu, 6) for mu in pile_friction(3)]
    ([0.267949, 0.089316], [0.317837, 0.079459])
    """
    whole(2, base=base)
    positive(weight=weight, spacing=spacing)
    sine = spacing / (2 * math.sin(math.pi / base))
    if spacing < 1 or sine >= 1:
        most = 2 * math.sin(math.pi / base)
        raise ValueError(
            f"base = {base}, spacing = {spacing:g}: expected a spacing from 1 to below {most:.4g}"
        )
    friction = math.tan(math.asin(sine) / 2)
    return PileFriction(friction, friction * weight / (base + weight))
