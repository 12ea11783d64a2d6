"""Decay of transverse velocity fluctuations (shear waves)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive
from mesokit.theory._least_squares import weighted_least_squares

Array = NDArray[np.float64]


class ViscosityFit(NamedTuple):
    """A viscosity and its standard error."""

    viscosity: float
    error: float


def transverse_correlation(k: ArrayLike, time: ArrayLike, viscosity: float) -> Array:
    """Normalised autocorrelation exp(-nu k^2 t) of a transverse Fourier mode of the velocity.

    Parameters: `k` wave numbers and `time` delays, shapes that broadcast; `viscosity` nu,
    kinematic. Raises ValueError for a viscosity not above 0. Source: linearised fluctuating
    hydrodynamics of a simple fluid. Valid for k well below pi and times above the timestep.

    >>> round(float(transverse_correlation(2 * np.pi / 20, 10, 0.87)), 5)
    0.42373
    """
    positive(viscosity=viscosity)
    k, time = np.asarray(k, dtype=float), np.asarray(time, dtype=float)
    return np.asarray(np.exp(-viscosity * k * k * time))


def transverse_viscosity_fit(
    k: ArrayLike, time: ArrayLike, correlation: ArrayLike, error: ArrayLike
) -> ViscosityFit:
    """Viscosity from normalised correlations of transverse modes, with weights.

    exp(-nu k^2 t) itself is fitted, not its logarithm, which noise would bias: Gauss-Newton, from
    the slope of the logarithm where the values are clear of zero.

    Parameters:
        k: (n,) wave numbers, or one for all.
        time: (n,) delays.
        correlation: (n,) values, 1 at time 0; error: (n,) standard errors, independent of each
            other (errors of one and the same run at neighbouring delays are not, which makes the
            quoted error too small), or one for all.

    Raises ValueError for shapes that do not broadcast, errors not above 0, no value clear of zero,
    no convergence. Source: weighted least squares, linearised at the solution.

    >>> t = np.arange(1.0, 20)
    >>> fit = transverse_viscosity_fit(0.3, t, transverse_correlation(0.3, t, 0.87), 0.01)
    >>> round(fit.viscosity, 6), round(fit.error, 4)
    (0.87, 0.0063)
    """
    k, time, correlation, error = np.broadcast_arrays(
        *(np.asarray(a, dtype=float) for a in (k, time, correlation, error))
    )
    if not np.all((error > 0) & np.isfinite(error)):
        raise ValueError(f"error = {error!r}: expected finite numbers above 0")
    x = k * k * time
    clear = (correlation > 3 * error) & (x > 0)
    if not clear.any():
        raise ValueError("correlation: expected a value at k, time > 0 more than 3 errors above 0")
    c = correlation[clear]
    (viscosity,), _ = weighted_least_squares(x[clear, None], -np.log(c), error[clear] / c)
    for _ in range(50):
        model = np.exp(-viscosity * x)
        basis = (-x * model)[:, None]
        (change,), covariance = weighted_least_squares(basis, correlation - model, error)
        viscosity += change
        if abs(change) <= 1e-12 * abs(viscosity):
            return ViscosityFit(float(viscosity), float(np.sqrt(covariance[0, 0])))
    raise ValueError("correlation: expected values that decay as exp(-nu k^2 t), the fit diverges")
