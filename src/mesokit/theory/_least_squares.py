"""Linear least squares with error bars, for the fits of this package."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def weighted_least_squares(
    basis: Array, values: ArrayLike, error: ArrayLike | None
) -> tuple[Array, Array]:
    """Coefficients (p,) and their covariance (p, p) for the basis functions (n, p).

    Given standard errors are taken at face value; without them the scatter sets the scale.
    """
    values = np.asarray(values, dtype=float)
    points, unknowns = basis.shape
    if values.shape != (points,):
        raise ValueError(f"values of shape {values.shape}: expected ({points},)")
    if points < unknowns + (error is None):
        raise ValueError(f"{points} points: expected at least {unknowns + (error is None)}")
    weight = np.ones(points)
    if error is not None:
        sigma = np.asarray(error, dtype=float)
        if sigma.shape != values.shape or not np.all((sigma > 0) & np.isfinite(sigma)):
            raise ValueError(f"error = {error!r}: expected {points} finite numbers above 0")
        weight = 1 / sigma
    # the QR factor keeps the condition number that the normal equations would square
    q, r = np.linalg.qr(basis * weight[:, None])
    coefficients = np.linalg.solve(r, q.T @ (values * weight))
    inverse = np.linalg.inv(r)
    covariance = inverse @ inverse.T
    if error is None:
        residual = values - basis @ coefficients
        covariance = covariance * (residual @ residual / (points - unknowns))
    return coefficients, covariance
