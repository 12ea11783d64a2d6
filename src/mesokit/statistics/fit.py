"""Fits and comparisons of data that carry error bars."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray


class ChiSquare(NamedTuple):
    """Sum of squared deviations in standard errors, degrees of freedom, and the probability `p`
    of a larger sum by chance (nan without a degree of freedom)."""

    chi2: float
    dof: int
    p: float


class Fit(NamedTuple):
    """Polynomial c0 + c1 x + c2 x^2 + ... fitted to data with error bars.

    `coefficients` and their standard `errors` (degree + 1,), lowest power first, their
    `covariance` (degree + 1, degree + 1), and the quality of the fit as in `ChiSquare`.
    """

    coefficients: NDArray[np.float64]
    errors: NDArray[np.float64]
    covariance: NDArray[np.float64]
    chi2: float
    dof: int
    p: float

    def __call__(self, x: ArrayLike) -> NDArray[np.float64]:
        """The fitted polynomial at `x`, (*x.shape)."""
        return np.asarray(np.polynomial.polynomial.polyval(np.asarray(x), self.coefficients))

    def error_at(self, x: ArrayLike) -> NDArray[np.float64]:
        """Standard error of the fitted polynomial at `x`, (*x.shape)."""
        powers = np.vander(np.ravel(x), len(self.errors), increasing=True)
        variance = np.einsum("ij,jk,ik->i", powers, self.covariance, powers)
        return np.asarray(np.sqrt(variance).reshape(np.shape(x)))


def weighted_polynomial(x: ArrayLike, y: ArrayLike, error: ArrayLike, degree: int) -> Fit:
    """Least-squares polynomial through points with independent error bars.

    Parameters
    ----------
    x, y: (n,) points.
    error: (n,) or a number, standard errors of `y`, taken at face value (not rescaled).
    degree: degree of the polynomial.

    Raises ValueError for a negative degree, for fewer distinct `x` than coefficients, and for
    values that are not finite or errors that are not positive: leave such points out.
    Also for powers of x that double precision cannot tell apart.
    Source: W. H. Press et al., Numerical Recipes, 3rd ed. (Cambridge, 2007), Sec. 15.4.

    >>> fit = weighted_polynomial([0, 1, 2, 3], [1, 2, 5, 10], error=0.1, degree=2)
    >>> fit.coefficients.round(6) + 0.0, fit.dof
    (array([1., 0., 1.]), 1)
    """
    y = np.asarray(y, float)
    x, y, error = np.broadcast_arrays(np.asarray(x, float), y, np.asarray(error, float))
    _check(x, y, error)
    if degree < 0:
        raise ValueError(f"degree must not be negative, got {degree}")
    if x.ndim != 1 or len(np.unique(x)) <= degree:
        raise ValueError(
            f"a polynomial of degree {degree} needs one-dimensional data with at least "
            f"{degree + 1} distinct x, got shape {x.shape} with {len(np.unique(x))}"
        )
    powers = np.vander(x, degree + 1, increasing=True)
    design = powers / error[:, None]
    scale = np.linalg.norm(design, axis=0)
    if np.linalg.cond(design / scale) > 1e10:
        raise ValueError("the powers of x are too alike: subtract a typical x or lower the degree")
    inverse = np.linalg.pinv(design / scale) / scale[:, None]
    coefficients = inverse @ (y / error)
    covariance = inverse @ inverse.T
    quality = chi_square(y, powers @ coefficients, error, fitted=degree + 1)
    return Fit(coefficients, np.sqrt(np.diag(covariance)), covariance, *quality)


def weighted_line(x: ArrayLike, y: ArrayLike, error: ArrayLike) -> Fit:
    """Least-squares straight line: `coefficients` are intercept and slope.

    Parameters, errors and source as in `weighted_polynomial`.

    >>> fit = weighted_line([0, 1, 2], [1, 3, 5], error=1.0)
    >>> fit.coefficients.round(6), round(float(fit.errors[1]), 4)  # slope error 1 / sqrt(2)
    (array([1., 2.]), 0.7071)
    """
    return weighted_polynomial(x, y, error, degree=1)


def chi_square(
    measured: ArrayLike, expected: ArrayLike, error: ArrayLike, fitted: int = 0
) -> ChiSquare:
    """Chi-square test of independent measurements against what is expected.

    Parameters
    ----------
    measured, expected, error: arrays that broadcast together; `error` are standard errors.
    fitted: number of parameters of `expected` that were fitted to these data.

    Raises ValueError for values that are not finite, errors that are not positive, and more
    fitted parameters than data.
    Source: W. H. Press et al., Numerical Recipes, 3rd ed. (Cambridge, 2007), Sec. 15.1.

    >>> chi_square([1.0, 2.0], [1.5, 2.0], error=0.5)
    ChiSquare(chi2=1.0, dof=2, p=0.6065306597126334)
    """
    from scipy.special import gammaincc

    measured, expected, error = np.broadcast_arrays(
        np.asarray(measured, float), np.asarray(expected, float), np.asarray(error, float)
    )
    _check(measured, expected, error)
    chi2 = float((((measured - expected) / error) ** 2).sum())
    dof = measured.size - fitted
    if dof < 0:
        raise ValueError(f"{fitted} fitted parameters exceed {measured.size} data")
    return ChiSquare(chi2, dof, float(gammaincc(dof / 2, chi2 / 2)) if dof else float("nan"))


def deviation(measured: ArrayLike, expected: ArrayLike, error: ArrayLike) -> NDArray[np.float64]:
    """(measured - expected) / error: the deviation in standard errors, element by element.

    Parameters: arrays that broadcast together. Without an error, equal values deviate by 0 and
    others by infinity; nan stays nan. Raises ValueError for a negative error.

    >>> deviation([1.0, 2.0, 2.0], [1.5, 2.0, 1.0], [0.5, 0.0, 0.0])
    array([-1.,  0., inf])
    """
    difference, error = np.subtract(measured, expected, dtype=float), np.asarray(error, float)
    if (error < 0).any():
        raise ValueError("a standard error must not be negative")
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where((difference == 0) & (error == 0), 0.0, difference / error)


def _check(x: NDArray[Any], y: NDArray[Any], error: NDArray[Any]) -> None:
    if not (np.isfinite(x) & np.isfinite(y) & np.isfinite(error)).all():
        raise ValueError("data and errors must be finite: leave out points without them")
    if not (error > 0).all():
        raise ValueError("standard errors must be positive")
