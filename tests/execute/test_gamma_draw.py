"""The thermostat's gamma variate: the fast guess is the exact test, and the result is gamma."""

import math

import numpy as np
import pytest
from numba import njit
from scipy import stats

from mesokit.method.mpcd.thermostat.maxwell_boltzmann import Canonical
from mesokit.method.mpcd.thermostat.protocol import draw, guess
from mesokit.scalar.gamma import part, propose
from mesokit.scalar.random import CELL, Counter, words

CANONICAL = Canonical(1.0, 1e-9)
UNLIKELY = 1e-4
PARTS = 4096


@njit
def guesses(freedom, count):
    """Guessed value, whether it is sure, the normal number and the part of u, for many cells."""
    out = np.empty((count, 4))
    for cell in range(count):
        counter = Counter(np.uint64(5), np.uint64(9))
        chance = words(counter, CELL, cell, 0)[2:]
        value, sure = guess(CANONICAL, chance, freedom)
        out[cell, 0], out[cell, 1] = value, sure
        out[cell, 2], out[cell, 3] = propose(chance[0], chance[1], freedom)[1], part(chance[1])
    return out


@njit
def draws(freedom, count, attempt):
    out = np.empty((count, 2))
    for cell in range(count):
        counter = Counter(np.uint64(5), np.uint64(9))
        out[cell, 0], out[cell, 1] = draw(CANONICAL, counter, cell, freedom, attempt)
    return out


@pytest.mark.parametrize("freedom", [2.0, 3.0, 5.0, 27.0, 300.0])
def test_what_is_sure_passes_the_exact_test_with_any_u_of_its_part(freedom):
    """log u < x^2/2 + e - e t^3 + 3 e log t (Marsaglia and Tsang 2000) for the largest such u."""
    value, sure, x, parts = guesses(freedom, 200_000).T
    e = freedom / 2 - 1 / 3
    t = 1 + x / math.sqrt(9 * e)
    sure = sure == 1
    bound = (x**2 / 2 + e - e * t**3)[sure] + 3 * e * np.log(t[sure])
    rounding = 1e-13 * (1 + e)  # f is a small difference of numbers of the size of e
    assert (np.log((parts[sure] + 1) / PARTS) <= bound + rounding).all()
    np.testing.assert_allclose(value[sure], (e * t**3)[sure], rtol=1e-12)
    fails = 3 / (108 * e) * 2 + 1 / PARTS  # of x^4 / (108 e), twice for the lower half
    assert 1 - sure.mean() < (3 * fails if e > 1 else 0.2)


@pytest.mark.parametrize("freedom", [1.0, 2.0, 3.0, 5.0, 27.0])
@pytest.mark.parametrize("attempt", [0, 1])
def test_accepted_draws_are_gamma_distributed(freedom, attempt):
    value, accepted = draws(freedom, 100_000, attempt).T
    kept = value[accepted == 1]
    assert stats.kstest(kept, stats.gamma(freedom / 2).cdf).pvalue > UNLIKELY


@pytest.mark.parametrize("freedom", [2.0, 3.0, 27.0])
def test_sure_guesses_and_careful_draws_together_are_gamma_distributed(freedom):
    value, sure, _, _ = guesses(freedom, 100_000).T
    careful, accepted = draws(freedom, 100_000, 0).T
    np.testing.assert_array_equal(accepted[sure == 1], 1)
    kept = np.where(sure == 1, value, careful)[(sure == 1) | (accepted == 1)]
    assert stats.kstest(kept, stats.gamma(freedom / 2).cdf).pvalue > UNLIKELY


def test_no_freedom_draws_nothing():
    assert (guesses(0.0, 100)[:, :2] == [0.0, 1.0]).all()
