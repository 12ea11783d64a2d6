"""Chi-square of histograms: classes that hold enough, and what is expected of its mean.

Counts of one moment are independent but for what is conserved: a number, momentum or energy of all
that are counted together. So the mean of chi-square over many moments, which may remember one
another, has a known value: one for each class, less one, less what each conserved sum takes away.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
LEAST = 5.0  # expected in a class: with fewer its counts are far from normal numbers


def classes(probability: Array, count: float, least: float = LEAST) -> NDArray[np.int64]:
    """The class of each bin: neighbours join until so many are expected of `count` in each.

    >>> classes(np.array([0.02, 0.1, 0.4, 0.4, 0.06, 0.02]), 50)
    array([0, 0, 1, 2, 2, 2])
    """
    found, filled = np.zeros(len(probability), np.int64), 0.0
    for i, p in enumerate(np.asarray(probability) * count):
        if i:
            found[i] = found[i - 1] + (filled >= least)
            filled = filled if filled < least else 0.0
        filled += p
    if filled < least and found[-1]:
        found[found == found[-1]] -= 1
    return found


def joined(values: Array, of: NDArray[np.int64]) -> Array:
    """Sums over the bins of each class.

    >>> joined(np.array([1.0, 2.0, 3.0]), np.array([0, 1, 1]))
    array([1., 5.])
    """
    return np.bincount(of, weights=values).astype(float)


def chi_square(counts: Array, probability: Array) -> float:
    """Sum over classes of (count - expected)^2 / expected.

    >>> chi_square(np.array([40.0, 60.0]), np.array([0.5, 0.5]))
    4.0
    """
    expected = counts.sum() * probability
    return float(((counts - expected) ** 2 / expected).sum())


def taken(covariance: Array, probability: Array) -> float:
    """The part of the mean of chi-square that a conserved sum takes, at most 1.

    `covariance` is that of each class with a term of the sum, scaled to a variance of 1.

    >>> p = np.array([0.5, 0.5])  # the sign of a normal number, and the number itself
    >>> round(taken(np.array([-1, 1]) / np.sqrt(2 * np.pi), p), 3)
    0.637
    """
    return float((np.asarray(covariance) ** 2 / probability).sum())
