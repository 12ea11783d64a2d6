"""Chi-square of a profile against theory, over waves whose noise the run is long enough to know."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.estimate import Estimate, per_block
from mesokit.seam.result import Comparison

Array = NDArray[np.floating[Any]]
FEWEST = 8  # blocks of time
MOST = 1 / 3  # correlation of one block of time with the next: of 32 blocks 16 are independent
BESIDE = 3  # modes on either side that are as slow as one, but for chance


def mode_chi_square(
    estimate: Estimate, expected: Array, periodic: bool, note: str
) -> list[Comparison]:
    """Chi-square of a profile (n,) per degree of freedom, over Fourier or cosine modes, beside 1.

    Modes of a uniform system are independent of each other where bins are not. The mean is left
    out, it is mostly conserved. So are the longest waves, which diffusion levels in L^2/(4 pi^2 D):
    those whose neighbouring blocks of time are correlated by more than `MOST`. The others
    forget by a factor from block to block, which neighbouring waves share. Nothing is returned
    with fewer than 8 blocks, with empty bins, or if no wave is short enough for the run.
    """
    from scipy.fft import dct
    from scipy.special import gammaincc

    deviation, residuals = estimate.value - expected, estimate.residuals
    known = np.isfinite(deviation).all() and np.isfinite(residuals).all()
    if len(residuals) < FEWEST or not known:
        return []
    if periodic:
        mode, noise = _real_fourier(deviation), _real_fourier(residuals)
    else:
        mode, noise = (dct(a, norm="ortho", axis=-1) for a in (deviation, residuals))
    mode, noise = mode[1:], noise[:, 1:]
    kept = _memory(noise)
    weights = per_block(estimate.weights)
    blocks = weights.sum() ** 2 / (weights**2).sum()  # as if they were independent
    variance = (noise**2).sum(axis=0) * blocks / (blocks - 1) * (1 + kept) / (1 - kept)
    if periodic:  # sine and cosine of one wave have the same variance
        pairs = len(variance) // 2 * 2
        variance[:pairs] = np.repeat(variance[:pairs].reshape(-1, 2).mean(axis=1), 2)
    slow = np.flatnonzero(kept > MOST)
    first = int(slow[-1]) + 1 if len(slow) else 0
    first += first % 2 if periodic else 0
    mode, variance = mode[first:], variance[first:]
    if not len(mode) or not (variance > 0).all():
        return []
    chi2, dof = float((mode**2 / variance).sum()), len(mode)
    p = float(gammaincc(dof / 2, chi2 / 2))
    note += f"; p = {p:.2g}, {dof} degrees of freedom"
    if first:
        note += f"; without the {first} longest modes, for which the run is short"
    what = "chi-square per degree of freedom"
    return [Comparison(what, chi2 / dof, (2 / dof) ** 0.5, 1.0, "", note)]


def _memory(noise: Array) -> Array:
    """Correlation of what neighbouring blocks (blocks, n) add, 0 at least, averaged over modes.

    Deviations from their own mean are by 1/blocks less correlated than those from the truth.
    """
    blocks, modes = noise.shape
    with np.errstate(divide="ignore", invalid="ignore"):
        own = (noise[1:] * noise[:-1]).sum(axis=0) / (noise**2).sum(axis=0)
    own = (np.nan_to_num(own) * blocks + 1) / (blocks - 1)
    window = [slice(max(i - BESIDE, 0), i + BESIDE + 1) for i in range(modes)]
    return np.maximum([own[near].mean() for near in window], 0.0)


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
