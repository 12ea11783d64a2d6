"""Error of the largest deviation of a curve from theory: which one that is, is chance as well."""

import numpy as np
import pytest

from mesokit.method.mpcd.observe.shared.decay import largest_error
from mesokit.seam.estimate import Estimate

SEEDS, BLOCKS, LAGS = 150, 32, 40


def measured(rng, known):
    """A curve (n,) in blocks, whose noise neighbouring lags share."""
    noise = rng.normal(size=(BLOCKS, LAGS + 4))
    blocks = known + sum(noise[:, k : k + LAGS] for k in range(5))
    value = blocks.mean(axis=0)
    return Estimate(value, (blocks - value) / BLOCKS, np.ones(BLOCKS))


def largest(deviations):
    return deviations[np.abs(deviations).argmax()]


@pytest.mark.parametrize("height", [0.0, 0.8, 4.0])
def test_it_is_the_scatter_of_seeds(height):
    """With the error bar of the one that was largest, half of it where theory is right."""
    rng, known = np.random.default_rng(3), height * np.exp(-0.5 * (np.arange(LAGS) / 4 - 5) ** 2)
    curves = [measured(rng, known) for _ in range(SEEDS)]
    value, error = np.array([(largest(c.value), largest_error(c.value, c)) for c in curves]).T
    assert 0.75 < value.std(ddof=1) / np.sqrt(np.mean(error**2)) < 1.3
