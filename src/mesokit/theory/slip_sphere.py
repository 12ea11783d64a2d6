"""Diffusion of a smooth sphere, which a central force keeps the fluid away from."""

import math

from mesokit.theory._check import positive
from mesokit.theory.finite_size import diffusion_in_box


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
