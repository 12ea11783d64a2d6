"""Numbers drawn from block sums, with error bars that know of all correlations.

A profile is measured together: neighbouring bins rise and fall with the same eddies, so the error
of a fitted number is not that of independent bins. What each block of time contributes to the
deviation of the profile is therefore carried through the (linearised) fit, and the blocking is
done on what comes out of it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.statistics import Blocks, ChiSquare, plateau_error

Array = NDArray[np.floating[Any]]


class Estimate(NamedTuple):
    """`value` (*shape), what each block adds to its deviation (blocks, *shape), block weights, and
    whether one block may take back what another has added (see `plateau_error`)."""

    value: Array
    residuals: Array
    weights: Array
    falling: bool = False

    @property
    def error(self) -> Array:
        """Standard error, (*shape)."""
        return plateau_error(self.residuals, self.weights, self.falling)

    def linear(self, matrix: Array) -> Estimate:
        """The linear combinations `matrix` (p, n) of a value of shape (n,)."""
        residuals, weights = self.residuals @ matrix.T, _per_block(self.weights)
        return Estimate(matrix @ self.value, residuals, weights, self.falling)

    def scalar(self, value: float | Array, gradient: Array) -> tuple[float, float]:
        """A function of the value (n,), given what it is and its gradient: value and error."""
        error = plateau_error(self.residuals @ gradient, _per_block(self.weights), self.falling)
        return float(value), float(error)


def of_mean(blocks: Blocks, falling: bool = False) -> Estimate:
    """The mean of a series."""
    sums, samples = blocks.sums()
    mean = blocks.mean()
    residuals = (sums - np.multiply.outer(samples, mean)) / max(blocks.count, 1)
    return Estimate(mean, residuals, samples.astype(float), falling)


def of_ratio(above: Array, below: Array) -> Estimate:
    """Ratio of two block sums (blocks, *shape), as `statistics.ratio`; nan where never filled."""
    total = below.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        value = np.where(total == 0, np.nan, above.sum(axis=0) / total)
        return Estimate(value, (above - value * below) / total, below)


def fit(estimate: Estimate, basis: Array, weight: Array) -> Estimate:
    """Least squares coefficients (p,) of the basis (n, p) with weights (n,)."""
    root = np.sqrt(weight)[:, None]
    return estimate.linear(np.linalg.pinv(basis * root) * root.T)


def mode_chi_square(estimate: Estimate, expected: Array, periodic: bool) -> ChiSquare | None:
    """Chi-square of a profile (n,) against theory, taken over its Fourier or cosine modes.

    Modes of a uniform system are independent of each other where bins are not. The mean is left
    out, it is mostly conserved. None with fewer than 8 blocks or with empty bins.
    """
    from scipy.fft import dct
    from scipy.special import gammaincc

    deviation, residuals = estimate.value - expected, estimate.residuals
    if len(residuals) < 8 or not (np.isfinite(deviation).all() and np.isfinite(residuals).all()):
        return None
    weights = _per_block(estimate.weights)
    if periodic:
        mode, mode_residuals = _real_fourier(deviation), _real_fourier(residuals)
    else:
        mode, mode_residuals = (dct(a, norm="ortho", axis=-1) for a in (deviation, residuals))
    variance = plateau_error(mode_residuals, weights)[..., 1:] ** 2
    if periodic:  # sine and cosine of one wave have the same variance
        pairs = len(variance) // 2 * 2
        variance[:pairs] = np.repeat(variance[:pairs].reshape(-1, 2).mean(axis=1), 2)
    if not (variance > 0).all():
        return None
    chi2, dof = float((mode[1:] ** 2 / variance).sum()), len(variance)
    return ChiSquare(chi2, dof, float(gammaincc(dof / 2, chi2 / 2)))


def _per_block(weights: Array) -> Array:
    """One weight per block."""
    return weights.reshape(len(weights), -1).mean(axis=1)


def _real_fourier(values: Array) -> Array:
    """Orthonormal mean, cosine and sine of wave 1, of wave 2, ... along the last axis."""
    n = values.shape[-1]
    waves = np.fft.rfft(values, norm="ortho", axis=-1)
    modes = np.zeros(values.shape)
    modes[..., 0] = waves[..., 0].real
    full = waves[..., 1 : (n + 1) // 2]
    modes[..., 1 : 2 * full.shape[-1] : 2] = np.sqrt(2) * full.real
    modes[..., 2 : 2 * full.shape[-1] + 1 : 2] = np.sqrt(2) * full.imag
    if n % 2 == 0:
        modes[..., -1] = waves[..., -1].real
    return modes
