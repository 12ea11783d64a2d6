"""The speed of the fastest bins of a map is not that of the noise in them."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit.method.mpcd.observe.velocity_field import fastest
from mesokit.seam.estimate import of_ratio


def sums_of(velocity, noise, blocks=12, seed=1):
    """Mass and momentum (blocks, 3, nx, ny) of a flow (2, nx, ny) in noise."""
    kicks = noise * np.random.default_rng(seed).normal(size=(blocks, *velocity.shape))
    mass = np.full((blocks, 1, *velocity.shape[1:]), 50.0)
    return np.concatenate([mass, mass * (velocity + kicks)], axis=1)


def found(sums):
    return fastest(sums, of_ratio(sums[:, 1:], np.broadcast_to(sums[:, :1], sums[:, 1:].shape)))


def parabola(nx, ny, most):
    y = (np.arange(ny) + 0.5) / ny
    return np.stack([np.broadcast_to(4 * most * y * (1 - y), (nx, ny)), np.zeros((nx, ny))])


@pytest.mark.parametrize("noise", [0.0, 0.02, 0.1])
def test_noise_does_not_raise_it(noise):
    """The largest of 2400 noisy speeds would be above by 0.1 where noise is largest."""
    truth = parabola(80, 30, 0.13)
    speeds, errors = zip(*(found(sums_of(truth, noise, seed=s)) for s in range(8)), strict=True)
    mean, error = np.mean(speeds), np.sqrt(np.mean(np.square(errors)) / 8)
    assert 0.8 * 0.13 < mean < 0.13 + 3 * error
    if noise:
        scatter = np.std(speeds, ddof=1)
        assert 0.4 < scatter / np.mean(errors) < 2.5
        naive = np.hypot(*(s := sums_of(truth, noise).sum(axis=0))[1:] / s[0]).max()
        assert naive > mean


def test_a_jet_of_few_bins_is_found():
    truth = np.zeros((2, 60, 40))
    truth[1, 7:9, 5:13] = 0.4  # 16 of 2400 bins
    speed, error = found(sums_of(truth, 0.02))
    assert abs(speed - 0.4) < max(3 * error, 0.01)


def test_bins_without_fluid_and_short_runs():
    sums = sums_of(parabola(20, 10, 0.1), 0.01)
    sums[:, :, :3] = 0
    assert 0.07 < found(sums)[0] < 0.11
    assert np.isnan(found(sums[:1])[0]) and np.isnan(found(0 * sums)[0])
