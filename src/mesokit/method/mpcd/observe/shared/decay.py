"""Fits to the decay of a correlation function, with error bars that know how lags correlate."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.estimate import Estimate
from mesokit.statistics import MultipleTau

Array = NDArray[np.floating[Any]]
LOWEST = (0.5, 0.2)  # of the correlation, that a fit looks at: later lags add little but noise
FEWEST = 4  # lags; the lower limit serves where the sampling is too coarse for the upper one
DRAWS = 400  # of noise
BEYOND = 1.4  # times the root mean square of the largest of noise: what is none of it


def averaged(correlator: MultipleTau, scale: float = 1.0) -> tuple[NDArray[np.int64], Estimate]:
    """Correlation averaged over all signals, times a scale: lags (n,) in samples, and values.

    Lags whose averages are longer than a block of time are left out.
    """
    lags: list[NDArray[np.int64]] = [np.zeros(0, np.int64)]
    values, weights = [np.zeros(0)], np.zeros(0)
    residuals: list[Array] = []
    for lag, sums, counts in correlator.products(within_blocks=True):
        sums = sums.reshape(*sums.shape[:2], -1).mean(axis=-1)
        total = counts.sum(axis=0)
        mean = sums.sum(axis=0) / total
        weights = weights if residuals else counts[:, 0]
        lags.append(lag)
        values.append(scale * mean)
        residuals.append(scale * (sums - mean * counts) / total)
    each = np.concatenate(residuals, axis=1) if residuals else np.zeros((0, 0))
    return np.concatenate(lags), Estimate(np.concatenate(values), each, weights)


def normalised(correlator: MultipleTau) -> tuple[NDArray[np.int64], Estimate]:
    """The same over that at lag 0."""
    lags, found = averaged(correlator)
    zero, zero_residual = found.value[:1], found.residuals[:, :1]
    with np.errstate(divide="ignore", invalid="ignore"):
        value = found.value / zero
        residuals = (found.residuals - value * zero_residual) / zero
    return lags, found._replace(value=value, residuals=residuals)


def largest_error(off: Array, curve: Estimate) -> float:
    """Standard error of the largest of the deviations (n,) of a curve from theory.

    Which one is the largest is chance as well: of noise alone it scatters more than any that is
    chosen beforehand. Such noise, with the scatter of the blocks, is drawn many times. A deviation
    that is none of it has its own error.
    """
    error = curve.error
    alone = np.sqrt((curve.residuals**2).sum(axis=0))
    scale = np.divide(error, alone, out=np.zeros_like(alone), where=alone > 0)
    draws = np.random.default_rng(1).normal(size=(DRAWS, len(curve.residuals)))
    noise = np.abs(draws @ (curve.residuals * scale)).max(axis=1)
    by_chance, worst = float(np.sqrt((noise**2).mean())), int(np.argmax(np.abs(off)))
    return float(error[worst]) if abs(off[worst]) > BEYOND * by_chance else by_chance


def fit_curve(
    time: Array,
    curve: Estimate,
    model: Callable[..., Array],
    start: list[float],
    use: NDArray[np.bool_],
) -> Estimate | None:
    """Least squares parameters (p,) of `model(time, *parameters)` over the points in `use`.

    All points weigh alike: their errors are so correlated that weights would only let the
    shortest lags, where the law does not hold yet, decide. None where the fit fails.
    """
    from scipy.optimize import curve_fit

    if use.sum() <= len(start) or not np.isfinite(curve.value[use]).all():
        return None
    try:
        parameters = curve_fit(model, time[use], curve.value[use], p0=start)[0]
    except RuntimeError:
        return None
    steps = 1e-6 * np.maximum(abs(parameters), 1e-6)
    slopes = [
        (model(time[use], *(parameters + step)) - model(time[use], *(parameters - step)))
        / (2 * step.sum())
        for step in np.diag(steps)
    ]
    matrix = np.linalg.pinv(np.stack(slopes, axis=1))
    return Estimate(parameters, curve.residuals[:, use] @ matrix.T, curve.weights)


def fit_decay(
    time: Array, curve: Estimate, late: NDArray[np.bool_], below: float = np.inf
) -> Estimate | None:
    """Rate and amplitude (2,) of an exponential, fitted to the points that are `late` enough, as
    far as the correlation is above noise; None where these are too few, or end above `below`."""
    for lowest in LOWEST:
        noise = np.flatnonzero(~(curve.value > lowest))
        use = (np.arange(len(time)) < (noise[0] if len(noise) else len(time))) & late
        if use.sum() >= FEWEST:
            break
    if use.sum() < 3 or curve.value[use][-1] >= below:
        return None
    start = [-np.log(curve.value[use][-1]) / time[use][-1], 1.0]
    return fit_curve(time, curve, lambda t, rate, size: size * np.exp(-rate * t), start, use)
