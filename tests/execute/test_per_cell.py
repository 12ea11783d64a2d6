"""Virtual particles of a cell drawn all at once: numbers and energies have their distributions."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit
from scipy import stats

from mesokit.loops.layout import LANES, SCRATCH_ROW
from mesokit.method.mpcd.engine.virtual.per_cell import MEAN, NUMBER, ROWS, count_batch
from mesokit.scalar.elementary import short_exp
from mesokit.scalar.gamma import gamma_number
from mesokit.scalar.poisson import poisson_number
from mesokit.scalar.random import VIRTUAL_NUMBER, Counter

UNLIKELY = 1e-4


@njit
def numbers(mean, count):
    """Poisson numbers of many cells."""
    out = np.empty(count, np.int64)
    for cell in range(count):
        counter = Counter(np.uint64(5), np.uint64(9))
        out[cell] = poisson_number(mean, counter, VIRTUAL_NUMBER, cell)
    return out


@njit
def batch(means, start):
    """The same for a batch of cells."""
    work = np.zeros(ROWS * SCRATCH_ROW)
    for i in range(LANES):
        work[MEAN * SCRATCH_ROW + i] = means[i]
    count_batch(
        np.arange(start, start + LANES), Counter(np.uint64(5), np.uint64(9)), VIRTUAL_NUMBER, work
    )
    return work[NUMBER * SCRATCH_ROW : NUMBER * SCRATCH_ROW + LANES]


@njit
def energies(freedom, count):
    out = np.empty(count)
    for cell in range(count):
        counter = Counter(np.uint64(5), np.uint64(9))
        out[cell] = gamma_number(freedom, counter, VIRTUAL_NUMBER, cell)
    return out


@njit
def exponentials(x):
    out = np.empty(len(x))
    for i in range(len(x)):
        out[i] = short_exp(x[i])
    return out


@pytest.mark.parametrize("mean", [0.05, 3.0, 10.0, 16.0, 45.0, 200.0])
def test_numbers_are_poisson(mean):
    found = numbers(mean, 100_000)
    low, high = stats.poisson.ppf([1e-3, 1.0 - 1e-3], mean).astype(int)
    edges = np.arange(low, high + 1)
    observed = [np.sum(found <= low)] + [np.sum(found == k) for k in edges[1:-1]]
    observed.append(len(found) - sum(observed))
    below = stats.poisson.cdf(edges[:-1], mean)
    expected = len(found) * np.diff(np.concatenate([[0.0], below, [1.0]]))
    assert stats.chisquare(observed, expected).pvalue > UNLIKELY


@pytest.mark.parametrize("most", [5.0, 16.0, 70.0])
def test_a_batch_draws_the_numbers_of_its_cells(most):
    means = np.linspace(0.0, most, LANES)
    one_by_one = [numbers(mean, 600 + LANES)[600 + i] for i, mean in enumerate(means)]
    assert list(batch(means, 600)) == one_by_one


@pytest.mark.parametrize("freedom", [2.0, 3.0, 8.0, 60.0])
def test_energies_are_those_of_their_degrees_of_freedom(freedom):
    found = energies(freedom, 50_000)
    assert stats.kstest(found, stats.gamma(0.5 * freedom).cdf).pvalue > UNLIKELY


def test_no_energy_without_freedom():
    assert (energies(0.0, 100) == 0.0).all()


def test_exponential():
    x = np.linspace(-50.0, 50.0, 20_001)
    assert np.abs(exponentials(x) / np.exp(x) - 1.0).max() < 1e-10
