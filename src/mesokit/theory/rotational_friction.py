"""Rotation of a sphere or disk in a fluid: friction, and how its velocity and its axis decay."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import (
    dimension_two_or_three,
    none_negative,
    not_negative,
    positive,
)
from mesokit.theory.velocity_autocorrelation import _after_zero

Array = NDArray[np.float64]


def rotational_friction(
    radius: float,
    viscosity: float,
    dimension: int = 3,
    box_length: float = math.inf,
    slip: float = 0.0,
    collisional_share: float = 0.0,
) -> float:
    """Torque over angular velocity of a sphere or disk, 8 pi eta R^3 or 4 pi eta R^2 times
    1/(1/(1/(1 - phi) - c/d) + d b/R).

    In a periodic box the images of the body, of volume share phi, turn the fluid back. Where
    collisions do not conserve angular momentum, the share c of the viscosity does not resist to
    rigid rotation: (1 - c/3), in 2D (1 - c/2) in a large box. D_r = kT over this.

    Parameters: `radius` R in cells; `viscosity` eta, dynamic; `dimension` d; `box_length` of a
    periodic cube or square; `slip` length b in cells; `collisional_share` c (0 for rules +a).
    Raises ValueError for a value out of range. Source: phi: M. Linke, J. Kofinger and G.
    Hummer, J. Phys. Chem. Lett. 9, 2874 (2018); c: I. O. Gotze, H. Noguchi and G. Gompper, Phys.
    Rev. E 76, 046705 (2007); together derived in docs/theory.md, to first order in phi. Valid
    without inertia.

    >>> round(rotational_friction(3.0, viscosity=8.7) / (8 * math.pi * 8.7 * 27), 6)
    1.0
    >>> round(rotational_friction(3, 8.7, 3, 16, 0.15) / (8 * math.pi * 8.7 * 27), 4)
    0.891
    """
    dimension_two_or_three(dimension)
    positive(radius=radius, viscosity=viscosity)
    not_negative(slip=slip, collisional_share=collisional_share)
    unit = (4 if dimension == 2 else 8) * math.pi * viscosity * radius**dimension
    volume = math.pi * radius**dimension * (1 if dimension == 2 else 4 / 3)
    fraction = volume / box_length**dimension
    if not 0 <= fraction < 1 or 2 * radius > box_length or collisional_share > 1:
        raise ValueError(
            f"box_length = {box_length!r}, collisional_share = {collisional_share!r}: expected"
            " above the diameter, and at most 1"
        )
    without_slip = 1 / (1 - fraction) - collisional_share / dimension
    return unit / (1 / without_slip + dimension * slip / radius)


def orientation_memory(time: ArrayLike, rotational_diffusion: float, dimension: int) -> Array:
    """Correlation <e(0).e(t)> of an axis that diffuses, exp(-(d - 1) D_r t).

    Parameters: `time` t, any shape; `rotational_diffusion` D_r; `dimension` d. Raises ValueError
    for a value out of range. Source: P. Debye, Polar Molecules (1929). Valid at times above that of
    the angular velocity to decay.

    >>> orientation_memory([0.0, 10.0], 0.05, dimension=3).round(4)
    array([1.    , 0.3679])
    """
    dimension_two_or_three(dimension)
    none_negative(time=time)
    not_negative(rotational_diffusion=rotational_diffusion)
    return np.exp(-(dimension - 1) * rotational_diffusion * np.asarray(time, float))


def angular_vacf_tail(
    time: ArrayLike,
    viscosity: float,
    diffusion: float,
    density: float,
    dimension: int,
    kT: float = 1.0,
    mass: float = 1.0,
) -> Array:
    """Long-time tail pi kT/rho [4 pi (nu + D) t]^(-d/2 - 1) of <Omega_z(0) Omega_z(t)>.

    Parameters: as in `vacf_tail`; `diffusion` D of the centre of the body. Raises ValueError for a
    value out of range. Source: E. H. Hauge and A. Martin-Lof, J. Stat. Phys. 7, 259 (1973); half
    the vorticity that is left at the place of the body. Valid between R^2/nu and L^2/(4 pi^2 nu) of
    a box L, for any shape and slip.

    >>> round(float(angular_vacf_tail(10, 0.5, 0.1, 5, dimension=2)), 8)
    0.00011052
    """
    dimension_two_or_three(dimension)
    positive(viscosity=viscosity, density=density, kT=kT, mass=mass)
    spread = 4 * math.pi * (viscosity + diffusion) * _after_zero(time)
    return math.pi * kT / (density * mass) * spread ** (-dimension / 2 - 1)
