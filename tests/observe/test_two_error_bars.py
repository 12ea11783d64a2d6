"""Error bars of averages over particles: what all do together, and what is conserved, counts."""

import numpy as np
import pytest

from mesokit.observe.mean_square_displacement import late_slope
from mesokit.observe.shared.origins import BLOCKS, Origins

SEEDS = 40


def product(old, new):
    return np.einsum("ij,ij->i", old, new)


def runs(make, samples, longest=4):
    """Values and errors (seeds, lags) of an autocorrelation."""
    found = []
    for seed in range(SEEDS):
        rng, origins = np.random.default_rng(seed), Origins(64, 2, longest)
        for sample in make(rng, samples):
            origins.add(sample, product)
        estimate = origins.estimate()
        found.append((estimate.value, estimate.error))
    values, errors = np.swapaxes(found, 0, 1)
    return values, errors


def in_one_bath(rng, samples):
    """Velocities whose temperature all share; it changes slowly."""
    common = 0.0
    for _ in range(samples):
        common = 0.9 * common + np.sqrt(1 - 0.81) * rng.normal()
        yield np.exp(0.2 * common) * rng.normal(size=(64, 2))


def of_one_energy(rng, samples):
    """Velocities whose squares add up to the same in all samples but for a little noise."""
    for _ in range(samples):
        v = rng.normal(size=(64, 2))
        yield v * np.sqrt(128 * (1 + 0.001 * rng.normal()) / (v**2).sum())


@pytest.mark.parametrize("make", [in_one_bath, of_one_energy])
def test_they_are_the_scatter_of_seeds(make):
    values, errors = runs(make, 1000)
    root = values.std(axis=0, ddof=1) / np.sqrt((errors**2).mean(axis=0))
    # the scatter of 40 is known to 11 %, and blocks of time to some 10 %
    assert (root > 0.65).all() and (root < 1.35).all()


def square_distance(old, new):
    return ((new - old) ** 2).sum(axis=1)


def walks(seed, samples=300, longest=250):
    """Square displacements of independent walks; the longest lag is most of the run."""
    rng, origins = np.random.default_rng(seed), Origins(96, 2, longest)
    for place in rng.normal(size=(samples, 96, 2)).cumsum(axis=0):
        origins.add(place, square_distance)
    return origins.sampled(), origins.estimate()


def test_blocks_of_time_count_for_no_lag_that_they_do_not_see():
    """At lags of most of the run all products are of the same time, so that blocks hardly differ:
    slopes had errors down to a tenth of their scatter."""
    slopes = [late_slope(*walks(seed), 1.0) for seed in range(SEEDS)]
    value, error = np.array([(slope.value, slope.error) for slope in slopes]).T
    assert abs(value.mean() - 2) < 4 * value.std() / np.sqrt(SEEDS)
    assert 0.65 < np.std((value - 2) / error) < 1.35


def test_the_slope_of_a_single_walk_has_the_error_of_walks():
    """A run of six times the longest lag has few independent parts: errors from their scatter were
    too small by a half, and one of 12 slopes was more than three of them off."""
    longest, samples, pulls = 16, 96, []
    for seed in range(150):
        rng, origins = np.random.default_rng(seed), Origins(1, 3, longest)
        for place in rng.normal(size=(samples, 1, 3)).cumsum(axis=0):
            origins.add(place, square_distance)
        time = origins.sampled().astype(float)
        slope = late_slope(time, origins.estimate(), longest / 4)
        error = slope.error_of_walks(time, samples, 3)
        pulls.append(((slope.value - 3) / slope.error, (slope.value - 3) / error))
    scatter, of_walks = np.abs(np.array(pulls)).T
    assert 0.5 < np.sqrt((of_walks**2).mean()) < 1.1 < np.sqrt((scatter**2).mean())
    assert (of_walks > 3).mean() < 0.025 < (scatter > 3).mean()


def test_blocks_of_time_are_bounded_and_hold_every_product():
    origins = Origins(8, 1, 5)
    for step in range(1, 300):
        origins.add(np.full((8, 1), float(step)), product)
        sums, counts = origins.in_time
        assert sums.shape == (BLOCKS, len(origins.lags))
        np.testing.assert_array_equal(counts.sum(axis=0), origins.counts)
        np.testing.assert_array_equal(sums.sum(axis=0), origins.sums.mean(axis=1))
