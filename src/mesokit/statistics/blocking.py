"""Error bars of correlated series by blocking.

Source: H. Flyvbjerg and H. G. Petersen, J. Chem. Phys. 91, 461 (1989).
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

FEWEST_BLOCKS = 4  # fewer give no error bar
FEWEST_MERGED = 8  # merging further than this says more about luck than about correlations
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


def plateau_error(
    residuals: ArrayLike, weights: ArrayLike, falling: bool = False
) -> NDArray[np.float64]:
    """Standard error of an estimate from what each block of time contributes to its deviation.

    Neighbouring blocks are merged level by level, element by element, until the first level
    whose successor does not rise by more than its own statistical uncertainty,
    SE / sqrt(2 (n - 1)), which is also one standard deviation of that rise in an uncorrelated
    series; about 8 blocks are always left. Where no plateau is reached, the last level is
    returned: a lower bound. Unequal blocks count as n = (sum w)^2 / sum w^2 equal ones.

    Parameters
    ----------
    residuals: (n, *shape) contributions of the blocks to (estimate - truth), linearised, so that
        they add up to zero over the blocks; for a mean, (block sum - mean * samples) / all samples.
    weights: (n,) or (n, *shape), how much data each block holds, empty blocks 0.
    falling: merge also as long as the error falls by more than its uncertainty, as it does where
        what one moment adds the next takes back, such as momentum that a wall has taken.

    Returns (*shape), nan where the data amount to fewer than 4 blocks.
    Raises ValueError if the number of blocks differs.
    Source: Flyvbjerg and Petersen (1989).

    >>> alternating = np.tile([1.0, -1.0], 8) / 16
    >>> error = plateau_error(alternating, np.ones(16))
    >>> round(float(error), 4)  # 1 / sqrt(15): merging gives no rise
    0.2582
    >>> back_and_forth = np.tile([1.0, -1.0], 128) / 256
    >>> [round(float(plateau_error(back_and_forth, np.ones(256), way)), 4) for way in (False, True)]
    [0.0626, 0.0]
    """
    return plateau(residuals, weights, falling)[0]


def plateau(
    residuals: ArrayLike, weights: ArrayLike, falling: bool = False
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Standard error as `plateau_error` gives it, and whether merging blocks changed it no more.

    Parameters and errors: those of `plateau_error`. Returns two arrays (*shape).
    Source: Flyvbjerg and Petersen (1989).

    >>> drift = np.linspace(-1, 1, 64) / 64
    >>> [bool(plateau(series, np.ones(64))[1]) for series in (drift, np.tile([1.0, -1.0], 32))]
    [False, True]
    """
    residuals, weights = np.asarray(residuals, float), np.asarray(weights, float)
    if residuals.ndim == 0 or weights.ndim == 0 or len(residuals) != len(weights):
        raise ValueError(
            "residuals and weights must hold the same number of blocks along their first axis, "
            f"got shapes {residuals.shape} and {weights.shape}"
        )
    weights = weights.reshape(weights.shape + (1,) * (residuals.ndim - weights.ndim))
    with np.errstate(divide="ignore", invalid="ignore"):
        number, error = _level(residuals, weights)
        error = np.where(number > FEWEST_BLOCKS - _SLACK, error, np.nan)
        climbing = np.isfinite(error)
        reached = np.zeros_like(climbing)
        # All elements merge together, but each stops at its own plateau. That is the first level
        # where merging raises its error by less than one standard deviation of such a rise.
        while len(residuals) > FEWEST_MERGED and climbing.any():
            residuals, weights = merge_pairs(residuals), merge_pairs(weights)
            slack = 1 / np.sqrt(2 * (number - 1))
            number, merged = _level(residuals, weights)
            moves = merged > error * (1 + slack)
            if falling:
                moves |= merged < error * (1 - slack)
            reached |= climbing & ~moves
            climbing &= (number > FEWEST_MERGED - _SLACK) & moves
            error = np.where(climbing, merged, error)
    return np.asarray(error), np.asarray(reached)


def independent_error(residuals: ArrayLike, weights: ArrayLike) -> NDArray[np.float64]:
    """Standard error of an estimate from what independent parts contribute to its deviation.

    Such parts are groups of particles: they have no order, so that merging neighbours would only
    let chance raise the error. Parameters and result: those of `plateau_error`.

    >>> round(float(independent_error(np.repeat([1.0, -1.0], 8) / 16, np.ones(16))), 4)
    0.2582
    """
    residuals, weights = np.asarray(residuals, float), np.asarray(weights, float)
    weights = weights.reshape(weights.shape + (1,) * (residuals.ndim - weights.ndim))
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
    """Standard error of the mean of a correlated series.

    Parameters: `series` (n,), a stationary time series. Returns nan for fewer than 4 samples.
    Raises ValueError unless the series is one-dimensional.
    Source: Flyvbjerg and Petersen (1989).

    >>> repeated = np.repeat(np.random.default_rng(1).normal(size=1000), 4)
    >>> 0.028 < blocking_error(repeated) < 0.036  # 1 / sqrt(1000), not 1 / sqrt(4000)
    True
    """
    values = np.asarray(series, float)
    if values.ndim != 1:
        raise ValueError(f"series must be one-dimensional, got shape {values.shape}")
    if len(values) < FEWEST_BLOCKS:
        return float("nan")
    return float(plateau_error((values - values.mean()) / len(values), np.ones(len(values))))
