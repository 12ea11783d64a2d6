"""Dense flow of grains: stress ratio and packing fraction by the inertial number."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import all_positive, dimension_two_or_three, none_negative, positive

DISK = math.sqrt(math.pi) / 2  # root of the area of a disk over its diameter
STATIC, DYNAMIC = math.tan(math.radians(20.9)), math.tan(math.radians(32.76))


def inertial_number(
    rate: ArrayLike, pressure: ArrayLike, diameter: float, density: float, dimension: int
) -> NDArray[np.float64]:
    """Time in which pressure moves a grain by its size, over the time in which shear does: I.

    Spheres: rate d sqrt(rho/P). Disks: rate sqrt(m/P) with the mass m of a disk (da Cruz et al.
    2005), which is 0.886 rate d sqrt(rho/P). Flow is quasi-static below some 1e-3, and a gas above
    some 0.3.

    Parameters: `rate` of shear, of either sign; `pressure` P, above 0; `diameter` d; `density` rho,
    mass of a grain over its volume (area in 2D), without voids; `dimension` 2 or 3. Raises
    ValueError for numbers out of range. Source: GDR MiDi, Eur. Phys. J. E 14, 341 (2004).

    >>> [inertial_number([0.1, 1.0], 1.0, 1.0, 1.0, d).round(6).tolist() for d in (2, 3)]
    [[0.088623, 0.886227], [0.1, 1.0]]
    """
    all_positive(pressure=pressure)
    positive(diameter=diameter, density=density)
    dimension_two_or_three(dimension)
    size = diameter * (DISK if dimension == 2 else 1.0)
    times = size * np.sqrt(density / np.asarray(pressure, float))
    return np.asarray(np.abs(np.asarray(rate, float)) * times)


def friction_of_disks(
    inertial: ArrayLike, static: float = 0.25, slope: float = 1.1
) -> NDArray[np.float64]:
    """Shear stress over pressure of disks in plane shear, mu(I) = 0.25 + 1.1 I.

    A fit to simulations of slightly polydisperse disks with friction 0.4 between grains, up to I of
    some 0.2. Restitution hardly matters there; with less friction the static value is smaller.

    Parameters: `inertial` number I of disks (`inertial_number`); `static`, `slope` of the line.
    Raises ValueError for numbers out of range. Source: F. da Cruz, S. Emam, M. Prochnow, J.-N. Roux
    and F. Chevoir, Phys. Rev. E 72, 021309 (2005).

    >>> friction_of_disks([0.0, 0.1]).round(4).tolist()
    [0.25, 0.36]
    """
    none_negative(inertial=inertial, static=static, slope=slope)
    return np.asarray(static + slope * np.asarray(inertial, float))


def fraction_of_disks(
    inertial: ArrayLike, static: float = 0.81, slope: float = 0.3
) -> NDArray[np.float64]:
    """Packing fraction of disks in plane shear, phi(I) = 0.81 - 0.3 I.

    Parameters: as `friction_of_disks`, with its source and range.

    >>> fraction_of_disks([0.0, 0.1]).round(4).tolist()
    [0.81, 0.78]
    """
    none_negative(inertial=inertial, static=static, slope=slope)
    return np.asarray(static - slope * np.asarray(inertial, float))


def friction_of_spheres(
    inertial: ArrayLike, static: float = STATIC, dynamic: float = DYNAMIC, scale: float = 0.279
) -> NDArray[np.float64]:
    """Shear stress over pressure of flowing spheres: mu_s + (mu_2 - mu_s)/(I_0/I + 1).

    Fitted to glass beads on slopes: mu_s = tan 20.9, mu_2 = tan 32.76 degrees, I_0 = 0.279. The
    packing fraction was taken as 0.6. Other grains have other constants.

    Parameters: `inertial` number I of spheres (`inertial_number`); `static` mu_s at rest; `dynamic`
    mu_2 of fast flow; `scale` I_0. Raises ValueError for numbers out of range. Source: P. Jop,
    Y. Forterre and O. Pouliquen, Nature 441, 727 (2006).

    >>> friction_of_spheres([0.0, 0.279, 1e9]).round(4).tolist()
    [0.3819, 0.5127, 0.6435]
    """
    none_negative(inertial=inertial, static=static, dynamic=dynamic)
    positive(scale=scale)
    number = np.asarray(inertial, float)
    return np.asarray(static + (dynamic - static) * number / (scale + number))
