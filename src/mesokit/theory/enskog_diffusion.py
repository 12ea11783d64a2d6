"""Diffusion of hard disks and spheres (Enskog)."""

import math

ALL_ORDERS = 1.01896  # over the first, of spheres (Pekeris 1955)


def enskog_diffusion(
    density: float, diameter: float, kT_over_m: float, contact: float, dimension: int
) -> float:
    """Self-diffusion coefficient of equal smooth elastic hard disks or spheres.

    Chapman and Enskog (1970, section 16.1) in molecular chaos: of disks the first approximation.
    Backflow makes it larger at medium densities (1.24 times at n = 0.5 in 3D), cages make it
    smaller near freezing; of disks it grows with the logarithm of time and size.

    Parameters: `density` number per area or volume, in 1/a^d; `diameter` in a; `kT_over_m` thermal
    energy over mass, in (a/time)^2; `contact` pair distribution at contact, such as `contact_value`
    gives; `dimension` 2 or 3.

    A fluid of spheres of n = 0.5, which fill 0.2618 of the volume.

    >>> from mesokit.theory import contact_value
    >>> chi = contact_value(0.2618, 3)
    >>> round(enskog_diffusion(0.5, 1.0, 1.0, chi, 3), 4)
    0.1996
    """
    thermal = math.sqrt(kT_over_m / math.pi)
    if dimension == 2:
        return thermal / (2 * density * diameter * contact)
    return ALL_ORDERS * 3 * thermal / (8 * density * diameter**2 * contact)
