"""Friction of rods in a viscous fluid: cylinders with flat ends, and capsules."""

import math
from typing import NamedTuple

from mesokit.theory._check import positive


class RodFriction(NamedTuple):
    """Friction of a rod: force over velocity `along` and `across`, torque over angular velocity
    `end_over_end`."""

    along: float
    across: float
    end_over_end: float


def cylinder_friction(length: float, diameter: float, viscosity: float) -> RodFriction:
    """Friction of a cylinder with flat ends, of aspect p = L/d.

    2 pi eta L/(ln p + nu) along, with nu = -0.207 + 0.980/p - 0.133/p^2; 4 pi eta L/(ln p + nu)
    across, with nu = 0.839 + 0.185/p + 0.233/p^2; pi eta L^3/(3 (ln p + delta)) end over end, with
    delta = -0.662 + 0.917/p - 0.050/p^2.

    Parameters: `length` L and `diameter` d in cells; `viscosity` eta, dynamic. Raises ValueError
    for a value not above 0 and for p out of 2 to 30, for which the fit was made. Source: M. M.
    Tirado, C. Lopez Martinez and J. Garcia de la Torre, J. Chem. Phys. 81, 2047 (1984).

    >>> [round(f, 1) for f in cylinder_friction(10.0, 2.0, viscosity=1.0)]
    [39.4, 50.4, 927.7]
    """
    positive(length=length, diameter=diameter, viscosity=viscosity)
    p = length / diameter
    if not 2 <= p <= 30:
        raise ValueError(f"length over diameter = {p:g}: expected from 2 to 30")
    log = math.log(p)
    unit = math.pi * viscosity * length
    return RodFriction(
        2 * unit / (log - 0.207 + 0.980 / p - 0.133 / p**2),
        4 * unit / (log + 0.839 + 0.185 / p + 0.233 / p**2),
        unit * length**2 / (3 * (log - 0.662 + 0.917 / p - 0.050 / p**2)),
    )


# of eta R and eta R^3, for a length over all of 5 diameters; found by bodies of many small spheres
CAPSULE = RodFriction(38.4, 49.4, 780.0)


def capsule_friction(radius: float, viscosity: float) -> RodFriction:
    """Friction of a capsule, a cylinder with round ends, whose whole length is 5 diameters.

    Parameters: `radius` R of the cylinder and its ends in cells; `viscosity` eta, dynamic. Raises
    ValueError for a value not above 0. Source: computed from surfaces made of many small spheres,
    to 1 %. A cylinder with flat ends of this length has 3 % more along, 19 % more end over end.

    >>> [round(f, 1) for f in capsule_friction(1.0, viscosity=1.0)]
    [38.4, 49.4, 780.0]
    """
    positive(radius=radius, viscosity=viscosity)
    unit = viscosity * radius
    along, across, turning = CAPSULE
    return RodFriction(along * unit, across * unit, turning * unit * radius**2)
