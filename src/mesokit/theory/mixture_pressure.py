"""Equation of state of mixtures of hard disks and spheres."""

from collections.abc import Sequence

from mesokit.theory.hard_sphere_pressure import compressibility


def mixture_compressibility(
    packing_fraction: float, moments: Sequence[float], dimension: int
) -> float:
    """Z = P/(n kT) of a mixture of additive hard disks or spheres in equilibrium.

    Disks after Santos, Yuste and Lopez de Haro (1999), from the equation of state of equal disks;
    spheres after Boublik (1970) and Mansoori, Carnahan, Starling and Leland (1971).

    Parameters: `packing_fraction` part of the area or volume that they fill; `moments` means of the
    diameter, its square and, in 3D, its cube; in a, a^2, a^3; `dimension` 2 or 3.

    Half of diameter 1, half of 0.6.

    >>> round(mixture_compressibility(0.4, (0.8, 0.68, 0.608), 3), 3)
    6.287
    >>> round(mixture_compressibility(0.4, (0.8, 0.68), 2), 3)
    2.761
    """
    phi = packing_fraction
    if dimension == 2:
        share = moments[0] ** 2 / moments[1]
        return 1 + (1 - share) * phi / (1 - phi) + share * (compressibility(phi, 2) - 1)
    one, two, three = moments
    free = 1 - phi
    first = 3 * phi * one * two / three / free**2
    second = phi**2 * two**3 / three**2 * (3 - phi) / free**3
    return 1 / free + first + second
