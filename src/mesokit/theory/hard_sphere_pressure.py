"""Equations of state of hard disks and spheres, and of their mixtures."""

import math
from collections.abc import Callable, Sequence

# B_k / B_2^(k-1) of hard disks, k = 2 to 10 (Clisby and McCoy 2006, table 1)
DISKS = (1.0, 0.782004, 0.532232, 0.333556, 0.198843, 0.114868, 0.0649930, 0.0362193, 0.0199537)


def compressibility(packing_fraction: float, dimension: int) -> float:
    """Z = P/(n kT) of the fluid in equilibrium.

    Disks: virial series to the tenth coefficient (Clisby and McCoy 2006), continued by the ratio of
    the last two, good to 0.1 % below a packing fraction of 0.5 and 1 % at 0.6. Spheres: Kolafa
    (Boublik and Nezbeda 1986, eq. 4.46).

    Parameters: `packing_fraction` part of the area or volume that they fill; `dimension` 2 or 3.

    >>> round(compressibility(0.3, 3), 4), round(compressibility(0.4, 2), 4)
    (3.9843, 2.8294)
    """
    x = packing_fraction
    if dimension == 2:
        # B_2 n = 2 phi
        known = sum(b * (2 * x) ** k for k, b in enumerate(DISKS, start=1))
        ratio = 2 * x * DISKS[-1] / DISKS[-2]
        return 1.0 + known + DISKS[-1] * (2 * x) ** len(DISKS) * ratio / (1 - ratio)
    return (1 + x + x**2 - 2 / 3 * x**3 * (1 + x)) / (1 - x) ** 3


def compressibility_of_few(law: Callable[[float], float], packing_fraction: float, n: int) -> float:
    """Z of n hard spheres in a periodic box, to first order in 1/n, from the law of many.

    In a box of few the number around a sphere cannot fluctuate: Z falls by
    (phi/2n) d ln(d(phi Z)/dphi)/dphi (Lebowitz and Percus 1961).

    Parameters: `law` Z of many, by the packing fraction; `packing_fraction` part of the area or
    volume that they fill; `n` number of spheres.

    >>> few = compressibility_of_few(lambda phi: compressibility(phi, 3), 0.16, 12)
    >>> round(few, 3), round(compressibility(0.16, 3), 3)
    (1.944, 1.995)
    """
    x, h = packing_fraction, 1e-3 * packing_fraction
    below, here, above = ((y * law(y)) for y in (x - h, x, x + h))
    slope, bend = (above - below) / (2 * h), (above - 2 * here + below) / h**2
    return law(x) - x / (2 * n) * bend / slope


def mean_speed_factor(degrees: int) -> float:
    """Mean speed at a fixed kinetic energy of so many degrees of freedom, over that of a bath.

    Velocities are spread over a sphere, not by Maxwell: 1 + 1/(4 degrees) for many.

    >>> round(mean_speed_factor(33), 4)
    1.0076
    """
    half = 0.5 * degrees
    return math.sqrt(half) * math.exp(math.lgamma(half) - math.lgamma(half + 0.5))


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
