"""Fits and chi-square: known answers, and statistics over many replicas."""

import numpy as np
import pytest

from mesokit.statistics import chi_square, deviation, weighted_line, weighted_polynomial


def test_line_through_the_textbook_formula():
    x, y = np.array([0.0, 1, 2, 4]), np.array([1.0, 2, 4, 9])
    error = np.array([0.5, 1, 2, 1])
    w = 1 / error**2
    s, sx, sxx = w.sum(), (w * x).sum(), (w * x * x).sum()
    sy, sxy = (w * y).sum(), (w * x * y).sum()
    delta = s * sxx - sx**2
    fit = weighted_line(x, y, error)
    assert fit.coefficients == pytest.approx(
        [(sxx * sy - sx * sxy) / delta, (s * sxy - sx * sy) / delta], rel=1e-12
    )
    assert fit.errors == pytest.approx([np.sqrt(sxx / delta), np.sqrt(s / delta)], rel=1e-12)
    assert fit.covariance[0, 1] == pytest.approx(-sx / delta, rel=1e-12)
    assert fit.chi2 == pytest.approx((((y - fit(x)) / error) ** 2).sum(), rel=1e-12)
    assert fit.dof == 2
    assert fit.p == pytest.approx(np.exp(-fit.chi2 / 2), rel=1e-12)  # exact for two dof


def test_exact_polynomials_come_back_whatever_the_units():
    x = 1e-6 * np.arange(9.0)
    expected = [2.0, -3e6, 5e12]
    fit = weighted_polynomial(x, np.polyval(expected[::-1], x), error=0.1, degree=2)
    assert fit.coefficients == pytest.approx(expected, rel=1e-9)
    assert fit.chi2 == pytest.approx(0, abs=1e-15) and fit.p == 1.0
    assert fit(3e-6) == pytest.approx(2 - 9 + 45)
    assert fit([[0.0, 1e-6]]).shape == fit.error_at([[0.0, 1e-6]]).shape == (1, 2)


def test_errors_and_p_value_over_many_replicas():
    replicas = 2000
    rng = np.random.default_rng(21)
    x, error = np.linspace(-1, 2, 12), np.linspace(0.1, 0.5, 12)
    truth = np.array([1.0, -2.0, 0.5])
    noisy = np.polyval(truth[::-1], x) + error * rng.normal(size=(replicas, 12))
    fits = [weighted_polynomial(x, y, error, degree=2) for y in noisy]
    pulls = np.array([(fit.coefficients - truth) / fit.errors for fit in fits])
    # Normal pulls: mean 0 +- 1/sqrt(2000), standard deviation 1 +- 1/sqrt(4000). 4 sigma, 3 pairs.
    assert abs(pulls.mean(axis=0)).max() < 4 / np.sqrt(replicas)
    assert abs(pulls.std(axis=0) - 1).max() < 4 / np.sqrt(2 * replicas)
    at = np.array([(fit(1.5) - np.polyval(truth[::-1], 1.5)) / fit.error_at(1.5) for fit in fits])
    assert abs(at.std() - 1) < 4 / np.sqrt(2 * replicas)
    # p is uniform: mean 1/2 +- 1/sqrt(12 * 2000); variance 1/12 with relative error 2/sqrt(5 n).
    p = np.array([fit.p for fit in fits])
    assert abs(p.mean() - 0.5) < 4 / np.sqrt(12 * replicas)
    assert 12 * p.var() == pytest.approx(1, abs=4 * np.sqrt(0.8 / replicas))
    assert all(fit.dof == 9 for fit in fits)


def test_chi_square_known_values():
    # 95 % quantile of chi-square with 5 degrees of freedom is 11.0705.
    measured = np.zeros(5)
    measured[0] = np.sqrt(11.0705)
    chi2, dof, p = chi_square(measured, 0.0, 1.0)
    assert (chi2, dof) == (pytest.approx(11.0705), 5)
    assert p == pytest.approx(0.05, abs=1e-5)
    assert chi_square(measured, 0.0, 2.0).chi2 == pytest.approx(11.0705 / 4)
    assert chi_square([1.0], [2.0], 1.0, fitted=1)[1] == 0
    assert np.isnan(chi_square([1.0], [2.0], 1.0, fitted=1).p)


def test_deviation_in_standard_errors():
    assert np.array_equal(deviation([1.0, 3.0], 2.0, [0.5, 0.25]), [-2.0, 4.0])
    assert np.array_equal(deviation([1, 2], [1, 1], 0), [0, np.inf])
    assert np.isnan(deviation(np.nan, 1.0, 1.0)) and np.isnan(deviation(1.0, 1.0, np.nan))
    with pytest.raises(ValueError, match="negative"):
        deviation(1.0, 1.0, -1.0)


def test_bad_data_are_refused():
    with pytest.raises(ValueError, match="finite"):
        weighted_line([0, 1, 2], [1, np.nan, 2], 1.0)
    with pytest.raises(ValueError, match="finite"):
        weighted_line([0, 1, 2], [1, 2, 3], [1, 1, np.nan])
    with pytest.raises(ValueError, match="positive"):
        weighted_line([0, 1, 2], [1, 2, 3], [1, 0, 1])
    with pytest.raises(ValueError, match="2 distinct x"):
        weighted_line([1, 1, 1], [1, 2, 3], 1.0)
    with pytest.raises(ValueError, match="degree"):
        weighted_polynomial([0, 1], [0, 1], 1.0, degree=-1)
    with pytest.raises(ValueError, match="too alike"):
        weighted_polynomial(1e6 + np.arange(9.0), np.arange(9.0), 1.0, degree=4)
    with pytest.raises(ValueError, match="exceed"):
        chi_square([1.0], [1.0], 1.0, fitted=2)
