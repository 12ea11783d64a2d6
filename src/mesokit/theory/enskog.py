"""Collision rate and diffusion of hard disks and spheres (Enskog)."""

import math


def contact_value(packing_fraction: float, dimension: int) -> float:
    """Pair distribution of equal hard disks or spheres at contact.

    Disks after Henderson (1975), spheres after Carnahan and Starling (1969); the disks' is 0.2 %
    too high at 0.4 and 1.2 % at 0.6.

    Parameters: `packing_fraction` part of the area or volume that they fill; `dimension` 2 or 3.

    >>> round(contact_value(0.5, 2), 4), round(contact_value(0.3, 3), 4)
    (3.125, 2.4781)
    """
    phi = packing_fraction
    if dimension == 2:
        return (1 - 7 * phi / 16) / (1 - phi) ** 2
    return (1 - phi / 2) / (1 - phi) ** 3


def enskog_rate(
    density: float, diameter: float, kT_over_m: float, packing_fraction: float, dimension: int
) -> float:
    """Collisions of a sphere per time in equilibrium.

    Parameters: `density` number per area or volume, in 1/a^d; `diameter` in a; `kT_over_m` thermal
    energy over mass, in (a/time)^2; `packing_fraction`, `dimension` as in `contact_value`.

    Disks that fill a fifth of the area.

    >>> import math
    >>> round(enskog_rate(0.2 * 4 / math.pi, 1.0, 1.0, 0.2, 2), 4)
    1.2871
    """
    chi = contact_value(packing_fraction, dimension)
    factor = 2.0 if dimension == 2 else 4.0
    speed = math.sqrt(math.pi * kT_over_m)
    return factor * density * diameter ** (dimension - 1) * chi * speed


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
