"""Velocity autocorrelation of a fluid particle, one component: C(0) = kT/m."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import dimension_two_or_three, positive
from mesokit.theory.mean_square_displacement import _check_decorrelation

Array = NDArray[np.float64]


def vacf_molecular_chaos(
    steps: ArrayLike, decorrelation: float, kT: float = 1.0, mass: float = 1.0
) -> Array:
    """Velocity autocorrelation kT/m (1 - g)^n of one component after n steps.

    Parameters: `steps` n >= 0, any shape; `decorrelation` g in (0, 2), see `msd_molecular_chaos`;
    `kT`, `mass`. Raises ValueError for g out of range. Source: independent collisions. Valid for
    the first collisions; the long-time tail takes over later.

    >>> vacf_molecular_chaos([0, 1, 2], 0.5).tolist()
    [1.0, 0.5, 0.25]
    """
    positive(kT=kT, mass=mass)
    _check_decorrelation(decorrelation)
    return kT / mass * (1 - decorrelation) ** np.asarray(steps, dtype=float)


def vacf_tail(
    time: ArrayLike,
    viscosity: float,
    diffusion: float,
    density: float,
    dimension: int,
    kT: float = 1.0,
    mass: float = 1.0,
) -> Array:
    """Long-time tail (d-1)/d kT/rho [4 pi (nu + D) t]^(-d/2) of one component, rho = density mass.

    Parameters: `time` above 0, any shape; `viscosity` nu; `diffusion` D of the particle; `density`
    particles per cell; `dimension` 2 or 3; `kT`, `mass`. Raises ValueError for a value out of
    range. Source: Ernst, Hauge and van Leeuwen (1970). Valid between the time of sound to cross a
    cell and L^2/(4 pi^2 (nu + D)) of a box L: in a 2D box of 64 cells the tail alone reads 0.8 of
    the measured value; `vacf_modes` includes the box.

    >>> round(float(vacf_tail(10, viscosity=0.5, diffusion=0.1, density=5, dimension=2)), 6)
    0.001326
    """
    dimension_two_or_three(dimension)
    positive(viscosity=viscosity, density=density, kT=kT, mass=mass)
    t = _after_zero(time)
    spread = 4 * math.pi * (viscosity + diffusion) * t
    return (dimension - 1) / dimension * kT / (density * mass) * spread ** (-dimension / 2)


def vacf_modes(
    time: ArrayLike,
    viscosity: float,
    diffusion: float,
    density: float,
    box: ArrayLike,
    kT: float = 1.0,
    mass: float = 1.0,
) -> Array:
    """The tail in a periodic box: (d-1)/d kT/(rho V) times the sum over k of exp(-(nu + D) k^2 t).

    The sum is over all k = 2 pi (n_x/L_x, ...) but zero, as the total momentum is at rest.

    Parameters: as in `vacf_tail`; `box` (d,) sides in cells, which give the dimension. Raises
    ValueError for a value out of range. Source: derived in docs/theory, the mode-coupling sum
    whose limit of a large box is the tail. Valid from the time of sound to cross a cell.

    >>> round(float(vacf_modes(10, 0.5, 0.1, 5, box=(64, 64))), 6)
    0.001302
    """
    sides = np.asarray(box, dtype=float)
    if sides.shape not in ((2,), (3,)) or not np.all(sides > 0):
        raise ValueError(f"box = {box!r}: expected 2 or 3 sides above 0")
    positive(viscosity=viscosity, density=density, kT=kT, mass=mass)
    t = _after_zero(time)
    # the sum over a cubic lattice is a product of one sum an axis
    product = np.ones_like(t)
    for side in sides:
        rate = (viscosity + diffusion) * (2 * math.pi / side) ** 2
        n = np.arange(1, 2 + int(math.sqrt(40 / (rate * t.min()))))
        product = product * (1 + 2 * np.exp(-rate * t[..., None] * n**2).sum(axis=-1))
    d = len(sides)
    return (d - 1) / d * kT / (density * mass * float(np.prod(sides))) * (product - 1)


def _after_zero(time: ArrayLike) -> Array:
    t = np.asarray(time, dtype=float)
    if np.any(t <= 0):
        raise ValueError(f"time = {time!r}: expected above 0")
    return t
