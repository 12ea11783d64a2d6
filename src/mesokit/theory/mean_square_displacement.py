"""Mean square displacement of a fluid particle."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive


def msd_molecular_chaos(
    steps: ArrayLike,
    timestep: float,
    decorrelation: float,
    dimension: int,
    kT: float = 1.0,
    mass: float = 1.0,
) -> NDArray[np.float64]:
    """Mean square displacement after n steps, exact when successive collisions are independent.

    d kT/m dt^2 [n (2/g - 1) - 2 (1 - g) (1 - (1 - g)^n)/g^2], g = decorrelation. It is ballistic,
    d kT/m dt^2, for one step and grows by 2 d D dt a step for many, D = kT dt/m (1/g - 1/2).

    Parameters:
        steps: n >= 0, any shape.
        timestep: time between two collisions.
        decorrelation: g in (0, 2), one minus the factor by which a collision multiplies the mean
            velocity; `decorrelation_from_diffusion` gives it from D.
        dimension: number of components summed.
        kT, mass: thermal energy and particle mass.

    Raises ValueError for a value out of range. Source: derived in docs/theory, the double sum of a
    geometric velocity correlation. Valid for a mean free path of a cell or more; below, the flow
    that a particle stirs up pushes it on, by 10 to 18 % at mean free path 0.1.

    >>> msd_molecular_chaos([0, 1, 2], 0.1, 0.5, 3).round(5).tolist()
    [0.0, 0.03, 0.09]
    """
    positive(timestep=timestep, dimension=dimension, kT=kT, mass=mass)
    _check_decorrelation(decorrelation)
    n = np.asarray(steps, dtype=float)
    if np.any(n < 0):
        raise ValueError(f"steps = {steps!r}: expected 0 or more")
    g = decorrelation
    scale = dimension * kT / mass * timestep**2
    return np.asarray(scale * (n * (2 / g - 1) - 2 * (1 - g) * (1 - (1 - g) ** n) / g**2))


def decorrelation_from_diffusion(
    diffusion: float, timestep: float, kT: float = 1.0, mass: float = 1.0
) -> float:
    """Decorrelation g per collision of D = kT dt/m (1/g - 1/2), the inverse of that law.

    Parameters as in `msd_molecular_chaos`, `diffusion` D at molecular chaos. Raises ValueError
    unless all are above 0.

    >>> round(decorrelation_from_diffusion(0.15, 0.1), 12)
    0.5
    """
    positive(diffusion=diffusion, timestep=timestep, kT=kT, mass=mass)
    return 1 / (diffusion * mass / (kT * timestep) + 0.5)


def _check_decorrelation(decorrelation: float) -> None:
    if not 0 < decorrelation < 2:
        raise ValueError(f"decorrelation = {decorrelation!r}: expected above 0 and below 2")
