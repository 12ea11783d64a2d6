"""Ratio of two running averages, such as momentum over mass in a bin, with its error bar."""

import numpy as np
from numpy.typing import NDArray

from mesokit.statistics.blocking import correlated_error
from mesokit.statistics.blocks import Blocks


def ratio(numerator: Blocks, weight: Blocks) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Ratio of the means of two series and its standard error, fluctuating weights included.

    R = sum N / sum W over all samples; the error is that of the mean of the linearised residual
    N_b - R W_b over the blocks, divided by the mean weight (delta method), of
    correlated blocks as in `Blocks.error`.

    Parameters
    ----------
    numerator: series of shape (*bins, *components), for example momentum per bin.
    weight: series of shape (*bins), for example mass per bin, fed in step with the numerator.

    Returns value and error, (*bins, *components). The value is nan where the weight is zero; the
    error is nan also where the weight lies in fewer than 4 blocks, or so unevenly that it
    amounts to fewer, so that a bin visited once claims no precision.
    Raises ValueError where the two series differ in length, blocks or bins.
    Source: W. G. Cochran, Sampling Techniques, 3rd ed. (Wiley, 1977), Ch. 6.

    >>> momentum, mass = Blocks(shape=(2,)), Blocks(shape=(2,))
    >>> for particles in (1.0, 2.0, 1.0, 2.0, 3.0):
    ...     momentum.add([0.5 * particles, 0.0])
    ...     mass.add([particles, 0.0])
    >>> ratio(momentum, mass)
    (array([0.5, nan]), array([ 0., nan]))
    """
    same = (numerator.count, numerator.capacity) == (weight.count, weight.capacity)
    if not same or numerator.shape[: len(weight.shape)] != weight.shape:
        raise ValueError(
            f"cannot divide {numerator.count} samples of shape {numerator.shape} "
            f"(capacity {numerator.capacity}) by {weight.count} of shape {weight.shape} "
            f"(capacity {weight.capacity}): they must be fed in step, with the same leading shape"
        )
    above, _ = numerator.sums()
    below, _ = weight.sums()
    below = below.reshape(below.shape + (1,) * (above.ndim - below.ndim))
    total = below.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        value = np.where(total == 0, np.nan, above.sum(axis=0) / total)
        return value, correlated_error((above - value * below) / total, below)
