"""Ratios of fluctuating sums: value, error, empty bins."""

import numpy as np
import pytest

from mesokit.statistics import Blocks, ratio


def fill(samples):
    blocks = Blocks(samples.shape[1:])
    for sample in samples:
        blocks.add(sample)
    return blocks


def test_error_is_the_delta_method_and_covers_the_truth():
    # Momentum of N ~ Poisson(4) particles of mean velocity 1 and spread 0.5, 1000 samples.
    # N - R W = sum of (v - 1): variance 0.25 * 4, so the error is 0.5 / sqrt(4 * 1000), and the
    # fluctuation of N (the error of sum N v / 1000 alone would be 2.2 times larger) drops out.
    replicas, steps = 2000, 1000
    rng = np.random.default_rng(7)
    mass = rng.poisson(4, size=(steps, replicas)).astype(float)
    momentum = mass + 0.5 * np.sqrt(mass) * rng.normal(size=mass.shape)
    value, error = ratio(fill(momentum), fill(mass))
    truth = 0.5 / np.sqrt(4 * steps)
    # Scatter over 2000 replicas 0.6 %, bias of the plateau walk +2 %.
    assert error.mean() == pytest.approx(truth, rel=0.04)
    assert np.std(value) == pytest.approx(truth, rel=3 / np.sqrt(2 * replicas))
    binomial = np.sqrt(0.683 * 0.317 / replicas)
    assert abs(np.mean(abs(value - 1) < error) - 0.683) < 3 * binomial + 0.015


def test_correlated_series_get_the_longer_error(ar1):
    # Constant weight: the error must be that of the AR(1) mean, sqrt((1 + phi)/(1 - phi) / n).
    series = ar1(4000, 500, 0.8, seed=8)
    _, error = ratio(fill(2 * series), fill(np.full_like(series, 2.0)))
    assert error.mean() == pytest.approx(np.sqrt(9 / 4000), rel=0.04)


def test_value_is_the_ratio_of_the_sums_and_components_share_the_weight():
    rng = np.random.default_rng(9)
    mass = rng.integers(1, 9, size=(200, 4)).astype(float)
    momentum = rng.normal(size=(200, 4, 3))
    value, error = ratio(fill(momentum), fill(mass))
    assert value == pytest.approx(momentum.sum(axis=0) / mass.sum(axis=0)[:, None], rel=1e-12)
    assert error.shape == (4, 3)
    for axis in range(3):
        assert ratio(fill(momentum[..., axis]), fill(mass))[1] == pytest.approx(error[:, axis])


def test_empty_bins_are_nan_and_rare_ones_claim_no_precision():
    mass = np.ones((100, 3))
    mass[:, 1] = 0
    mass[:, 2] = np.arange(100) == 50  # visited once: no way to know the error
    value, error = ratio(fill(3 * mass), fill(mass))
    assert value[0] == 3 and np.isnan(value[1]) and value[2] == 3
    assert error[0] == 0 and np.isnan(error[1:]).all()
    assert np.isnan(ratio(Blocks(2), Blocks(2))[0]).all()


def test_series_out_of_step_are_refused():
    one, two = fill(np.ones((5, 2))), fill(np.ones((6, 2)))
    with pytest.raises(ValueError, match="in step"):
        ratio(one, two)
    with pytest.raises(ValueError, match="leading shape"):
        ratio(one, fill(np.ones((5, 3))))
    with pytest.raises(ValueError, match="capacity 32"):
        ratio(Blocks(capacity=32), Blocks())
