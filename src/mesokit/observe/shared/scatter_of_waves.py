"""Error bars of S(q) from how far waves of one length scatter: they hold in short runs, too."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.result import Array

FEWEST = 12  # degrees of freedom that the scatter is taken from
CURVE = 2  # degree of the polynomial that S is taken for where they are


def scatter_of_waves(each: Array, lengths: Array, members: NDArray[np.int64]) -> Array:
    """Standard error (shells,) of the mean over the waves of each shell; nan of too few waves.

    Waves are independent of one another, and neighbours scatter alike about S, a smooth function
    of q: by all of it if a run is short against the time in which they decay.

    Parameters: means `each` (runs, waves) over the time of each run; `lengths` (waves,) of the
    waves, shell by shell; `members` (shells,), how many are in each.

    >>> rng = np.random.default_rng(1)
    >>> lengths = np.repeat([1.0, 2.0, 3.0], 400)
    >>> once = rng.exponential(size=(1, 1200))  # as |rho|^2 of a single sample is
    >>> error = scatter_of_waves(once, lengths, np.array([400, 400, 400]))
    >>> bool(np.all(abs(error * 400**0.5 - 1) < 0.25))
    True
    """
    ends, (runs, _) = np.cumsum(members), each.shape
    starts, last = ends - members, len(members) - 1
    found = np.full(len(members), np.nan)
    # Shell by shell: neighbours on both sides are added until there are enough degrees of freedom.
    # A polynomial in q takes the trend of S away before.
    for place in range(len(members)):
        for reach in range(len(members)):
            low, high = max(0, place - reach), min(last, place + reach)
            near = slice(int(starts[low]), int(ends[high]))
            known = len(np.unique(np.round(lengths[near], 9)))
            degree = min(CURVE, known - 1)
            freedom = runs * (near.stop - near.start) - degree - 1
            if freedom >= FEWEST:
                away = _off_the_curve(each[:, near], lengths[near], degree)
                variance = (away**2).sum() / freedom
                found[place] = np.sqrt(variance / (members[place] * runs))
                break
    return found


def _off_the_curve(each: Array, lengths: Array, degree: int) -> Array:
    """What is left (runs, waves) when the best polynomial is taken away."""
    powers = np.vander((lengths - lengths.mean()) / lengths.mean(), degree + 1)
    mean = each.mean(axis=0)
    return np.asarray(each - powers @ np.linalg.lstsq(powers, mean, rcond=None)[0])
