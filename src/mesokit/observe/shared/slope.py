"""Slope of a curve where it is a straight line: the data choose the window of the fit.

A displacement bends from free flight to diffusion, and the fit must begin beyond. Fits over windows
that begin ever later, each at twice the lag of the one before, end at the same longest lag. The
first that agrees with all later ones is taken, and their scatter beyond noise goes into its error.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.estimate import Estimate, fit

Array = NDArray[np.floating[Any]]
FEWEST = 3  # points of a fit
AGREE = 3.0  # standard errors of the difference of two slopes that agree
DECADE = math.log(10.0)
SEEN = 2.0  # standard errors of a change of the slope that counts where theory expects one


class Slope(NamedTuple):
    """Slope and its standard error, the fitted line (n,), nan outside of its window, and whether
    the curve is straight there; `growth` is by how much the slope changes in a decade of lags."""

    value: float
    error: float
    line: Array
    straight: bool
    growth: float


def late_slope(time: Array, curve: Estimate, first: float, grows: bool = False) -> Slope | None:
    """Slope of a curve at late lags; None with fewer than three of them.

    Points weigh as 1/t^2, as their errors grow like t.

    Parameters
    ----------
    time: (n,) lags, ascending.
    curve: its value (n,) and how that scatters.
    first: the lag from which on the curve may be a straight line; lag 0 is never used.
    grows: whether theory expects the slope to change for ever, slowly.

    Where it is seen to, or nowhere agrees with the slope at later lags, the growth over a decade of
    lags is part of the error.

    >>> time, noise = np.arange(65.0), np.random.default_rng(1).normal(size=(65, 32)).cumsum(axis=0)
    >>> bent = time + np.expm1(-time)  # free flight at first
    >>> groups = bent[:, None] + 0.01 * noise
    >>> value = groups.mean(axis=1)
    >>> curve = Estimate(value, (groups - value[:, None]).T / 32, np.ones((32, 65)))
    >>> found = late_slope(time, curve, 0.0)
    >>> abs(found.value - 1) < 2 * found.error, found.straight, bool(np.isnan(found.line[1]))
    (True, True, True)
    """
    use = (time >= first) & (time > 0)
    if use.sum() < FEWEST:
        return None
    basis = np.stack([np.ones_like(time), time], axis=1)
    windows = [use & (time >= start) for start in _starts(time[use])]
    fits = [fit(curve, basis, _weight(time, window)) for window in windows]
    slopes = np.stack([_row(time, basis, window) for window in windows])
    value = slopes @ curve.value
    apart = slopes[:, None] - slopes[None]  # differences of any two
    noise = np.stack([curve.linear(row).error for row in apart])
    off = abs(value[:, None] - value[None])
    agree = [bool((off[k, k + 1 :] <= AGREE * noise[k, k + 1 :]).all()) for k in range(len(value))]
    chosen = agree.index(True)  # of the last there is nothing to differ from
    straight = len(value) == 1 or chosen < len(value) - 1
    errors = curve.linear(slopes).error
    spread = _scatter(off[chosen, chosen:], noise[chosen, chosen:], errors[chosen:])
    bend, unsure = _bend(time, curve, use if straight else windows[-2])
    growth = DECADE * bend if not straight or (grows and bend > SEEN * unsure) else 0.0
    return Slope(
        float(value[chosen]),
        float(np.sqrt(errors[chosen] ** 2 + spread + growth**2)),
        np.where(windows[chosen], basis @ fits[chosen].value, np.nan),
        straight,
        growth,
    )


def _starts(time: Array) -> list[float]:
    """Where windows begin: at the first lag, then at twice the one before, an octave at least."""
    starts = [float(time[0])]
    while 4 * starts[-1] <= time[-1] and (time >= 2 * starts[-1]).sum() >= FEWEST:
        starts.append(2 * starts[-1])
    return starts


def _weight(time: Array, window: NDArray[np.bool_]) -> Array:
    """1/t^2 within a window."""
    return np.where(window, 1 / np.maximum(time, time[window][0]) ** 2, 0.0)


def _row(time: Array, basis: Array, window: NDArray[np.bool_], coefficient: int = 1) -> Array:
    """The combination (n,) of the values that a coefficient of a fit is."""
    root = np.sqrt(_weight(time, window))[:, None]
    return np.asarray((np.linalg.pinv(basis * root) * root.T)[coefficient])


def _scatter(off: Array, noise: Array, errors: Array) -> float:
    """Mean square of what slopes differ by beyond noise, each weighing by its own error."""
    weight = 1 / errors**2
    if not np.isfinite(weight).all():
        return 0.0
    return max(0.0, float((weight * (off**2 - noise**2)).sum() / weight.sum()))


def _bend(time: Array, curve: Estimate, use: NDArray[np.bool_]) -> tuple[float, float]:
    """By how much the slope changes while the lag grows by a factor of e, and the standard error of
    that: c of a + b t + c t ln t.

    The scale of time is that of the lags, which leaves c as it is.
    """
    if use.sum() <= FEWEST:
        return 0.0, math.inf
    t = time / time[use].max()
    basis = np.stack([np.ones_like(t), t, t * np.log(np.where(t > 0, t, 1.0))], axis=1)
    row = _row(t, basis, use, 2) / time[use].max()
    return curve.scalar(row @ curve.value, row)
