"""Error bars of correlated series, from blocks of time."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

ONE_SIGMA = 0.5 * (1 + math.erf(math.sqrt(0.5)))  # of a Gaussian, below one standard deviation
FEWEST_BLOCKS = 4  # fewer give no error bar
FEWEST_MERGED = 8  # merging further than this says more about luck than about correlations
MOST_BLOCKS = 64  # of a series that is given whole
FEWEST_PIECES = 8  # independent ones, of fewer the error is itself uncertain and too small
FEWEST_WINDOWS = 4  # that fit into the blocks: correlations at longer lags are not seen
DECAY = 1.5  # decay time of a correlation over its integral, at most (Wolff: S between 1 and 2)
_SLACK = 0.5  # a ragged block counts for less than one


def merge_pairs(blocks: NDArray[np.float64]) -> NDArray[np.float64]:
    """Add neighbouring blocks; an odd one at the end stays alone.

    Parameters: `blocks` (n, ...) of block sums. Returns ((n + 1) // 2, ...).

    >>> merge_pairs(np.array([1.0, 2.0, 3.0]))
    array([3., 3.])
    """
    merged = blocks[0::2].copy()
    merged[: len(blocks) // 2] += blocks[1::2]
    return merged


def correlated_error(residuals: ArrayLike, weights: ArrayLike) -> NDArray[np.float64]:
    """Standard error of an estimate from what each block of time contributes to its deviation.

    It is the error of `correlated`, which has the same parameters and raises the same errors.

    >>> alternating = np.tile([1.0, -1.0], 8) / 16
    >>> round(float(correlated_error(alternating, np.ones(16))), 4)  # 1 / sqrt(15)
    0.2582
    """
    return correlated(residuals, weights)[0]


def correlated(
    residuals: ArrayLike, weights: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Standard error from blocks of time that may be correlated, and how many pieces they are.

    The variance of the sum of residuals is the sum of their autocorrelation over all lags. The sum
    ends, element by element, where noise adds more than an exponential decay has left. Deviations
    are from the mean of the same blocks, so that the sum is too small by what it ends at, and is
    corrected for that. Blocks are independent where the first correlation is within its noise, and
    anticorrelated ones count as independent.

    Parameters
    ----------
    residuals: (n, *shape) contributions of the blocks to (estimate - truth), linearised, so that
        they add up to zero over the blocks; for a mean, (block sum - mean * samples) / all samples.
    weights: (n,) or (n, *shape), how much data each block holds, empty blocks 0. Unequal blocks
        count as (sum w)^2 / sum w^2 equal ones.

    Returns two arrays (*shape): the error, nan where the data amount to fewer than 4 blocks, and
    the number of independent pieces that the blocks amount to.
    Raises ValueError if the number of blocks differs.
    Source: U. Wolff, Comput. Phys. Commun. 156, 143 (2004), the automatic window and its bias.

    >>> error, pieces = correlated(np.repeat([1.0, -1.0, -1.0, 1.0], 8) / 32, np.ones(32))
    >>> round(float(error / independent_error(np.tile([1.0, -1.0], 16) / 32, np.ones(32))), 1)
    2.9
    """
    residuals, weights, number = _prepared(residuals, weights)
    with np.errstate(divide="ignore", invalid="ignore"):
        variance, of_blocks = (residuals**2).sum(axis=0), (weights**2).sum(axis=0)
        # Correlations are summed over rising lags for all elements at once. An element leaves when
        # noise, which grows with the lag, exceeds what an exponential decay would still add.
        times = np.full(variance.shape, 0.5)  # integrated correlation, in blocks
        window, growing = np.zeros(variance.shape), variance > 0
        for lag in range(1, len(residuals) // FEWEST_WINDOWS + 1):
            pairs = (weights[lag:] * weights[:-lag]).sum(axis=0) / of_blocks  # over those of lag 0
            products = (residuals[lag:] * residuals[:-lag]).sum(axis=0) / variance
            growing &= (pairs > 0) & (lag * FEWEST_WINDOWS <= number)
            if lag == 1:
                growing &= products / pairs > 1 / np.sqrt(pairs * number)
            times = np.where(growing, times + products / pairs, times)
            window += growing
            decay = DECAY / np.log((2 * times + 1) / (2 * times - 1))
            growing &= np.exp(-lag / decay) > decay / np.sqrt(lag * pairs * number)
            if not growing.any():
                break
        pieces = (number - 1 - 2 * window) / np.fmax(2 * times, 1.0)
        error = np.sqrt(variance * number / pieces)
    return np.where(number > FEWEST_BLOCKS - _SLACK, error, np.nan), pieces


def falling_error(residuals: ArrayLike, weights: ArrayLike) -> NDArray[np.float64]:
    """Standard error where one block may take back what another has added.

    Such is momentum that a wall has taken. Neighbouring blocks are merged level by level, element
    by element, until the first level whose successor neither rises nor falls by more than its own
    uncertainty, SE / sqrt(2 (n - 1)). About 8 blocks are always left. Parameters, result and
    errors raised: those of `correlated_error`.
    Source: H. Flyvbjerg and H. G. Petersen, J. Chem. Phys. 91, 461 (1989).

    >>> back_and_forth = np.tile([1.0, -1.0], 128) / 256
    >>> [round(float(of(back_and_forth, np.ones(256))), 4)
    ...  for of in (independent_error, falling_error)]
    [0.0626, 0.0]
    """
    residuals, weights, _ = _prepared(residuals, weights)
    with np.errstate(divide="ignore", invalid="ignore"):
        number, error = _level(residuals, weights)
        error = np.where(number > FEWEST_BLOCKS - _SLACK, error, np.nan)
        moving = np.isfinite(error)
        # All elements merge together, but each stops where merging changes its error by less than
        # one standard deviation of such a change.
        while len(residuals) > FEWEST_MERGED and moving.any():
            residuals, weights = merge_pairs(residuals), merge_pairs(weights)
            slack = 1 / np.sqrt(2 * (number - 1))
            number, merged = _level(residuals, weights)
            moving &= (number > FEWEST_MERGED - _SLACK) & (abs(merged - error) > error * slack)
            error = np.where(moving, merged, error)
    return np.asarray(error)


def _prepared(
    residuals: ArrayLike, weights: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Both with the same number of axes, and the number (*shape) of equal blocks that they are."""
    residuals, weights = np.asarray(residuals, float), np.asarray(weights, float)
    if residuals.ndim == 0 or weights.ndim == 0 or len(residuals) != len(weights):
        raise ValueError(
            "residuals and weights must hold the same number of blocks along their first axis, "
            f"got shapes {residuals.shape} and {weights.shape}"
        )
    weights = weights.reshape(weights.shape + (1,) * (residuals.ndim - weights.ndim))
    with np.errstate(divide="ignore", invalid="ignore"):
        number = weights.sum(axis=0) ** 2 / (weights**2).sum(axis=0)
    return residuals, weights, np.broadcast_to(number, residuals.shape[1:])


def independent_error(residuals: ArrayLike, weights: ArrayLike) -> NDArray[np.float64]:
    """Standard error of an estimate from what independent parts contribute to its deviation.

    Such parts are groups of particles, which have no order. Parameters, result and errors raised:
    those of `correlated_error`.

    >>> round(float(independent_error(np.repeat([1.0, -1.0], 8) / 16, np.ones(16))), 4)
    0.2582
    """
    residuals, weights, _ = _prepared(residuals, weights)
    with np.errstate(divide="ignore", invalid="ignore"):
        number, error = _level(residuals, weights)
    return np.where(number > FEWEST_BLOCKS - _SLACK, error, np.nan)


def _level(
    residuals: NDArray[np.float64], weights: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Effective number of blocks and standard error, as if the blocks were independent."""
    number = weights.sum(axis=0) ** 2 / (weights**2).sum(axis=0)
    return number, np.sqrt((residuals**2).sum(axis=0) * number / (number - 1))


def blocking_error(series: ArrayLike) -> float:
    """Standard error of the mean of a correlated series, whose samples are merged to 64 blocks.

    Parameters: `series` (n,), a stationary time series. Returns nan for fewer than 4 samples.
    Raises ValueError unless the series is one-dimensional.

    >>> repeated = np.repeat(np.random.default_rng(1).normal(size=1000), 4)
    >>> 0.026 < blocking_error(repeated) < 0.036  # 1 / sqrt(1000), not 1 / sqrt(4000)
    True
    """
    values = np.asarray(series, float)
    if values.ndim != 1:
        raise ValueError(f"series must be one-dimensional, got shape {values.shape}")
    if len(values) < FEWEST_BLOCKS:
        return float("nan")
    residuals, weights = (values - values.mean()) / len(values), np.ones(len(values))
    while len(residuals) > MOST_BLOCKS:
        residuals, weights = merge_pairs(residuals), merge_pairs(weights)
    return float(correlated_error(residuals, weights))


def student(values: int) -> float:
    """Factor by which the error of a mean of few values is larger than their scatter gives.

    The scatter of few values is itself uncertain. With this factor the error bar holds the truth as
    often as one standard error of many values does, 68 times of 100, whatever their number.

    Parameters: `values`, independent Gaussian numbers. Returns nan for fewer than two.
    Source: Student (W. S. Gosset), Biometrika 6, 1 (1908).

    >>> [round(student(n), 2) for n in (1, 2, 3, 4, 32)]
    [nan, 1.84, 1.32, 1.2, 1.02]
    """
    from scipy.special import stdtrit

    return float(stdtrit(values - 1, ONE_SIGMA)) if values > 1 else math.nan
