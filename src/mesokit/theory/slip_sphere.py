"""Friction and diffusion of a smooth sphere, which a central force keeps the fluid away from."""

import math

from mesokit.theory._check import dimension_two_or_three, positive
from mesokit.theory.finite_size import diffusion_in_box


def enskog_friction(
    radius: float,
    density: float,
    mass: float,
    dimension: int = 3,
    kT: float = 1.0,
    solvent_mass: float = 1.0,
) -> float:
    """Friction of a smooth sphere or disk by the hits of an ideal gas without memory.

    (8/3) sqrt(2 pi kT mu) n R^2 in 3D and 2 sqrt(2 pi kT mu) n R in 2D, with mu the reduced mass.

    Parameters: `radius` R; `density`, particles per cell; `mass` of the sphere; `dimension` 2 or
    3; `kT`; `solvent_mass`. Raises ValueError for a value out of range. Source: J. T. Hynes, Annu.
    Rev. Phys. Chem. 28, 301 (1977); in 2D from the same pressure 4 n sqrt(m kT/2 pi) u on a surface
    that moves at u along its normal. Valid at times too short for the fluid to give anything back.

    >>> round(enskog_friction(3.0, density=10, mass=1130), 1)
    601.3
    """
    dimension_two_or_three(dimension)
    positive(radius=radius, density=density, mass=mass, kT=kT, solvent_mass=solvent_mass)
    thermal = math.sqrt(2.0 * math.pi * kT * mass * solvent_mass / (mass + solvent_mass))
    if dimension == 2:
        return 2.0 * thermal * density * radius
    return 8.0 / 3.0 * thermal * density * radius**2


def slip_sphere_diffusion(
    radius: float,
    viscosity: float,
    enskog: float | None = None,
    box_length: float | None = None,
    kT: float = 1.0,
) -> float:
    """Diffusion coefficient kT/(4 pi eta R) + kT/enskog of a sphere that slips, less its images.

    Parameters: `radius` R; `viscosity` eta, dynamic; `enskog`, the friction by hits
    (`enskog_friction`; none: no mean free path); `box_length` L of a periodic cube (none:
    infinite); `kT`. Raises ValueError for a value not above 0. Source: J. T. Padding and A. A.
    Louis, Phys. Rev. E 74, 031402 (2006); images: H. Hasimoto, J. Fluid Mech. 5, 317 (1959), whose
    next term, of order R^2/L^3, is zero for a slipping sphere: its flow is that of a point force.
    Approximate: the two frictions are not independent.

    >>> round(slip_sphere_diffusion(3.0, viscosity=8.7, enskog=601.3, box_length=24), 5)
    0.00399
    """
    positive(radius=radius, viscosity=viscosity, kT=kT)
    free = kT / (4.0 * math.pi * viscosity * radius)
    if enskog is not None:
        positive(enskog=enskog)
        free += kT / enskog
    if box_length is None:
        return free
    return diffusion_in_box(free, box_length, viscosity, kT)
