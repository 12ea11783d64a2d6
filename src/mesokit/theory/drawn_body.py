"""Spheres and disks that a force draws through a fluid in a periodic box."""

import math

from mesokit.theory._check import not_negative, positive
from mesokit.theory.cubic_array import cubic_array_drag
from mesokit.theory.square_array import DENSEST, square_array_drag


def sphere_friction_in_cube(
    radius: float, box_length: float, viscosity: float, slip: float = 0.0
) -> float:
    """Force over velocity of a sphere in a periodic cube, 6 pi eta R over the mobility
    1/K + (1 - 2 phi) b/(R + 2 b).

    1/K = 1 - 2.8373 R/L + (4 pi/3)(R/L)^3 - 27.4 (R/L)^6 is `cubic_array_drag` of the volume
    fraction phi. So slip makes the first term (1 + 3 b/R)/(1 + 2 b/R), leaves the second, and
    divides the third by 1 + 2 b/R; in higher terms it is left out.

    The force F is met by a uniform acceleration of all, sphere included. Where the fluid alone
    takes -F, V is 1/(1 - phi) times as fast. A sphere heavier than its fluid by dM has
    (1 - dM/M_all)^2 of the mobility, in the frame where the whole momentum is zero.

    Parameters: `radius` R, `box_length` L and `slip` length b in cells; `viscosity` eta, dynamic.
    Raises ValueError for a value out of range, and where spheres would overlap. Source: H.
    Hasimoto, J. Fluid Mech. 5, 317 (1959), and as in `cubic_array_drag`; slip: A. B. Basset, A
    Treatise on Hydrodynamics (1888), with its images derived in docs/theory.md. Valid for Reynolds
    numbers well below 1, and slip for phi below 0.1.

    >>> round(sphere_friction_in_cube(3.0, 16, viscosity=8.7), 1)
    994.5
    >>> round(sphere_friction_in_cube(3.0, 16, viscosity=8.7, slip=0.15), 1)
    915.1
    """
    positive(radius=radius, box_length=box_length, viscosity=viscosity)
    _require_room(radius, box_length, 0.5)
    not_negative(slip=slip)
    fraction = 4 / 3 * math.pi * (radius / box_length) ** 3
    mobility = 1 / cubic_array_drag(fraction) + (1 - 2 * fraction) * slip / (radius + 2 * slip)
    return 6 * math.pi * viscosity * radius / mobility


def disk_friction_in_square(
    radius: float, box_length: float, viscosity: float, slip: float = 0.0
) -> float:
    """Force over velocity of a disk in a periodic square, eta times `square_array_drag`.

    For few disks 4 pi eta/(-ln(phi)/2 - 0.738 + b/(R + 2 b) + phi/(1 + 2 b/R)), with phi the part
    of the square that is disk: without a box there is none (Stokes' paradox).

    Parameters, frame and errors as in `sphere_friction_in_cube`; `viscosity` eta in 2D. Source:
    that of `square_array_drag`. Valid for Reynolds numbers well below 1.

    >>> round(disk_friction_in_square(3.0, 30, viscosity=8.7), 2)
    106.91
    """
    positive(radius=radius, box_length=box_length, viscosity=viscosity)
    _require_room(radius, box_length, math.sqrt(DENSEST / math.pi))
    return viscosity * square_array_drag(math.pi * (radius / box_length) ** 2, slip / radius)


def einstein_diffusion(friction: float, kT: float = 1.0) -> float:
    """Diffusion coefficient kT over friction, of a place or of an angle.

    Parameters: `friction`, force over velocity or torque over angular velocity, in the box where
    the body diffuses; `kT`. Raises ValueError for a value not above 0. Source: A. Einstein, Ann.
    Phys. 17, 549 (1905). Valid at times above that of the velocity to decay.

    >>> round(einstein_diffusion(sphere_friction_in_cube(3.0, 16, viscosity=8.7)), 6)
    0.001006
    """
    positive(friction=friction, kT=kT)
    return kT / friction


def _require_room(radius: float, box_length: float, most: float) -> None:
    """Raise ValueError for a radius that is more than so much of the box."""
    if radius > most * box_length:
        raise ValueError(
            f"radius = {radius!r}, box_length = {box_length!r}: expected a radius of at most "
            f"{most:.4g} of the box"
        )
