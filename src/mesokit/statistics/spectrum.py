"""Power spectrum of a time series, and the frequency at which it oscillates, with error bars."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.statistics.blocking import correlated_error

SEGMENTS = 8  # non-overlapping lengths into which a series is cut
FEWEST_SAMPLES = 64
PERIODS = 3  # of an oscillation in a piece whose phase is taken
LOWEST = 2  # frequencies too slow for the segments to tell a peak from a slope
CLEAR = 4.0  # times the background at which a peak is one


class Spectrum(NamedTuple):
    """Power per frequency (n,), one-sided: its integral is the variance; standard errors (n,)."""

    frequency: NDArray[np.float64]
    power: NDArray[np.float64]
    error: NDArray[np.float64]


class Frequency(NamedTuple):
    """Mean frequency of an oscillation and its standard error; `contrast`, the power at the peak
    over that of the frequencies around it."""

    value: float
    error: float
    contrast: float


def spectrum(series: ArrayLike, interval: float) -> Spectrum:
    """Power spectrum by Welch's method: Hann windows that overlap by half, the mean taken off.

    Parameters
    ----------
    series: (n,) samples at equal times.
    interval: time between two samples.

    Empty for fewer than 64 samples. Raises ValueError for an interval not above 0 or a series that
    is not one-dimensional.
    Source: P. D. Welch, IEEE Trans. Audio Electroacoust. 15, 70 (1967); the error is that of his
    eq. (9), power sqrt((1 + 2 rho^2)/K), for K segments with rho = 1/6.

    >>> noise = np.random.default_rng(1).normal(size=4096)
    >>> found = spectrum(noise, 0.5)
    >>> bool(abs(np.trapezoid(found.power, found.frequency) - 1) < 0.1)
    True
    """
    from scipy.signal import welch

    values = np.asarray(series, float)
    if values.ndim != 1 or not interval > 0:
        raise ValueError(
            f"expected a one-dimensional series and an interval above 0, got shape {values.shape} "
            f"and {interval}"
        )
    if len(values) < FEWEST_SAMPLES:
        return Spectrum(np.zeros(0), np.zeros(0), np.zeros(0))
    length = 2 * (len(values) // SEGMENTS // 2)
    frequency, power = welch(
        values - values.mean(), 1 / interval, nperseg=length, detrend="constant"
    )
    pieces = len(values) // (length // 2) - 1
    error = power * math.sqrt((1 + 2 / 36) / pieces)
    return Spectrum(frequency[1:], power[1:], error[1:])


def dominant_frequency(series: ArrayLike, interval: float) -> Frequency | None:
    """The frequency of the highest peak of the spectrum, None if there is no clear one.

    The peak is where the power, over that of its surroundings, is largest. The series is then cut
    into pieces of a few periods; the frequency is the mean rate at which the phase goes on from
    piece to piece, the error from how it scatters. Where the phase wanders, this error is that of
    the mean frequency, and smaller than the width of the peak.

    Parameters, errors and source of the spectrum as in `spectrum`; of the rest: K. S. Miller and
    M. M. Rochwarger, IEEE Trans. Inf. Theory 18, 588 (1972).

    >>> time = 0.5 * np.arange(4000)
    >>> noise = np.random.default_rng(1).normal(size=4000)
    >>> found = dominant_frequency(np.cos(2 * np.pi * 0.0317 * time) + noise, 0.5)
    >>> bool(abs(found.value - 0.0317) < 3 * found.error), found.error < 1e-4
    (True, True)
    """
    values = np.asarray(series, float)
    found = spectrum(values, interval)
    if not len(found.power) or not found.power.any():
        return None
    ratio = found.power / _background(found.power)
    peak = LOWEST + int(np.argmax(ratio[LOWEST:]))
    first, contrast = float(found.frequency[peak]), float(ratio[peak])
    if contrast < CLEAR:
        return None
    length = max(math.ceil(PERIODS / (first * interval)), len(values) // 64)
    pieces = len(values) // length
    if pieces < 4:
        return Frequency(first, math.nan, contrast)
    used = (values - values.mean())[: pieces * length]
    turning = np.exp(-2j * np.pi * first * interval * np.arange(pieces * length))
    window = np.hanning(length + 2)[1:-1]
    phase = ((used * turning).reshape(pieces, length) * window).sum(axis=1)
    steps = phase[1:] * phase[:-1].conj()
    turn = np.angle(steps.sum())
    aligned = steps * np.exp(-1j * turn)
    scale = 2 * np.pi * length * interval
    error = correlated_error(aligned.imag / aligned.real.sum(), np.ones(len(steps))) / scale
    return Frequency(first + float(turn) / scale, float(error), contrast)


def mean_spectrum(found: Sequence[Spectrum]) -> Spectrum:
    """Mean of the spectra of independent series of equal length.

    >>> one, other = Spectrum(*np.ones((3, 2))), Spectrum(np.ones(2), 3 * np.ones(2), np.ones(2))
    >>> mean_spectrum([one, other]).power
    array([2., 2.])
    """
    power = np.mean([one.power for one in found], axis=0)
    error = np.sqrt(np.sum([one.error**2 for one in found], axis=0)) / len(found)
    return Spectrum(found[0].frequency, power, error)


def mean_frequency(found: Sequence[Frequency | None]) -> Frequency | None:
    """Mean over the independent series that have a clear oscillation, None if none has.

    >>> mean_frequency([Frequency(1.0, 0.3, 9.0), None, Frequency(2.0, 0.4, 5.0)])
    Frequency(value=1.5, error=0.25, contrast=5.0)
    """
    clear = [one for one in found if one is not None]
    if not clear:
        return None
    return Frequency(
        float(np.mean([one.value for one in clear])),
        float(np.sqrt(np.sum([one.error**2 for one in clear]))) / len(clear),
        min(one.contrast for one in clear),
    )


def _background(power: NDArray[np.float64]) -> NDArray[np.float64]:
    """Median of the power around each frequency, from half of it to twice and a few at least."""
    n = len(power)
    at = np.arange(n)
    low, high = np.minimum(at // 2, at - 4), np.maximum(2 * at, at + 4)
    return np.array([np.median(power[max(a, 0) : b + 1]) for a, b in zip(low, high, strict=True)])
