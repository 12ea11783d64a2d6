"""Walks whose steps remember the direction of the last: a bird alone."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def msd_persistent_walk(
    steps: ArrayLike, length: float, memory: float, share: float = 1.0
) -> NDArray[np.float64]:
    """Mean square displacement after n steps, l^2 [n (1 + a)/(1 - a) - 2 a (1 - a^n)/(1 - a)^2].

    Parameters: `steps` n, any shape; `length` l of a step; `memory` a, the mean cosine of the angle
    between neighbouring steps, from 0 to 1 (with 1 the walk is straight: l^2 n^2); `share` of the
    axes that count. Raises ValueError for a memory out of range. Source: G. I. Taylor, Proc. London
    Math. Soc. 20, 196 (1921), for a walk in steps (as the freely rotating chain).

    >>> msd_persistent_walk([1, 2, 1000], 0.5, 0.5).round(4).tolist()
    [0.25, 0.75, 749.0]
    """
    n, a = np.asarray(steps, float), float(memory)
    if not 0 <= a <= 1:
        raise ValueError(f"memory must be from 0 to 1, got {memory}")
    lost = 1 - a
    # where the two terms nearly cancel: sum over j, k of a^|j - k| in powers of 1 - a
    few = n**2 - lost * (n**3 - n) / 3 + lost**2 * (n**3 - n) * (n - 2) / 12
    with np.errstate(divide="ignore", invalid="ignore"):
        exact = n * (1 + a) / np.float64(lost) - 2 * a * (1 - a**n) / np.float64(lost) ** 2
    return np.asarray(share * length**2 * np.where(lost * n < 1e-3, few, exact))


def persistent_diffusion(length: float, timestep: float, memory: float, dimension: int) -> float:
    """Diffusion coefficient l^2 (1 + a)/((1 - a) 2 d dt) of such a walk at late times.

    Parameters as above, and the time `timestep` of a step and the `dimension` d; infinite for a
    memory of 1. Raises ValueError for a memory out of range. Source as above.

    >>> persistent_diffusion(0.5, 1.0, 0.5, 2)
    0.1875
    """
    if not 0 <= memory <= 1:
        raise ValueError(f"memory must be from 0 to 1, got {memory}")
    if memory == 1:
        return float("inf")
    return length**2 * (1 + memory) / ((1 - memory) * 2 * dimension * timestep)
