"""Maps without their noise, and without the bins that hold next to nothing."""

import numpy as np

from mesokit.report.flow.data import Array

FULL = 0.5  # of a bin that is fluid: its own value is good enough


def smoothed(values: Array, periodic: tuple[bool, bool], width: float) -> Array:
    """Values (nx, ny) averaged over about so many bins; nan stays nan, and counts for nothing."""
    from scipy.ndimage import gaussian_filter

    filled = np.isfinite(values)
    mode = ["wrap" if goes_on else "nearest" for goes_on in periodic]
    weight = gaussian_filter(filled.astype(float), width, mode=mode)
    sums = gaussian_filter(np.where(filled, values, 0.0), width, mode=mode)
    return np.where(filled, sums / np.maximum(weight, 1e-9), np.nan)


def rim_filled(velocity: Array, share: Array, periodic: tuple[bool, bool]) -> Array:
    """The velocity (nx, ny, 2) with the mean of their neighbours in bins that solids cut.

    These hold few particles, whose noise would stand out along every surface.

    Parameters: the velocity, nan in solids; `share` (nx, ny) of each bin that is fluid.
    """
    cut = (share > 0) & (share < FULL)
    if not cut.any():
        return velocity
    mode = ["wrap" if goes_on else "constant" for goes_on in periodic]
    weight = np.where(np.isfinite(velocity).all(axis=-1) & ~cut, share, 0.0)
    near = _near(weight, mode)
    sums = [_near(weight * np.nan_to_num(velocity[..., k]), mode) for k in range(2)]
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.stack(sums, axis=-1) / near[..., None]
    return np.where((cut & (near > 0))[..., None], mean, velocity)


def _near(values: Array, mode: list[str]) -> Array:
    """Sums over a bin and its eight neighbours."""
    from scipy.ndimage import convolve1d

    for axis in range(2):
        values = convolve1d(values, np.ones(3), axis=axis, mode=mode[axis])
    return values
