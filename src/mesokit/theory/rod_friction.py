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


# of 1, 1/p, 1/p^2.. in nu along, nu across and delta; sums 2/3, 4/3 and 1/3 make a sphere of p = 1
CAPSULE = (
    (-0.230, 1.416, -0.735, 0.2157),
    (0.805, 0.657, -0.1287),
    (-0.576, 1.845, -1.973, 1.503, -0.4657),
)


def capsule_friction(length: float, diameter: float, viscosity: float) -> RodFriction:
    """Friction of a capsule, a cylinder with round ends, of aspect p = L/d.

    The same formulas as in `cylinder_friction`, with other nu and delta.

    Parameters: `length` L over all, with the ends, and `diameter` d in cells; `viscosity` eta,
    dynamic. Raises ValueError for a value not above 0 and for p out of 1 to 20. Source: fitted here
    to 0.2 % of computed values, of point forces inside the capsule that move its surface as one. A
    cylinder of p = 5 with flat ends has 3 % more along and 18 % more end over end.

    >>> [round(f, 1) for f in capsule_friction(10.0, 2.0, viscosity=1.0)]
    [38.4, 49.5, 784.5]
    """
    positive(length=length, diameter=diameter, viscosity=viscosity)
    p = length / diameter
    if not 1 <= p <= 20:
        raise ValueError(f"length over diameter = {p:g}: expected from 1 to 20")
    unit = math.pi * viscosity * length
    along, across, turning = (
        math.log(p) + sum(c / p**k for k, c in enumerate(fit)) for fit in CAPSULE
    )
    return RodFriction(2 * unit / along, 4 * unit / across, unit * length**2 / (3 * turning))
