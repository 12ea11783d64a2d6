"""Block averages: exact sums, honest errors, same bits across a stop, bounded memory."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesokit.statistics import (
    FEWEST_PIECES,
    Blocks,
    blocking_error,
    correlated,
    correlated_error,
    falling_error,
)


def fill(samples, **keywords):
    blocks = Blocks(np.shape(samples[0]), **keywords)
    for sample in samples:
        blocks.add(sample)
    return blocks


def true_error(steps, phi):
    """Standard error of the mean of an AR(1) series of unit variance, exactly."""
    sum_of_c = (1 + phi) / (1 - phi) - 2 * phi * (1 - phi**steps) / (steps * (1 - phi) ** 2)
    return np.sqrt(sum_of_c / steps)


@pytest.mark.parametrize("count", [1, 7, 15, 16, 17, 31, 32, 33, 1000, 4095, 4096, 4097])
def test_merged_blocks_are_the_means_of_consecutive_samples(count):
    # Integers, so that sums are exact in any order.
    samples = np.random.default_rng(count).integers(-99, 99, size=(count, 3)).astype(float)
    blocks = fill(samples, capacity=16)
    length = blocks.block_length
    complete = count // length
    assert (complete < 16) and (length == 1 or complete >= 8)
    expected = samples[: complete * length].reshape(complete, length, 3).mean(axis=1)
    assert np.array_equal(blocks.blocks(), expected)
    assert np.array_equal(blocks.mean(), samples.sum(axis=0) / count)
    assert blocks.count == count
    assert blocks.sums()[1].sum() == count


@given(st.integers(0, 300), st.integers(0, 300), st.sampled_from([(), (2,), (2, 3)]))
def test_same_bits_across_a_round_trip(before, after, shape):
    samples = np.random.default_rng(before + 1000 * after).normal(size=(before + after, *shape))
    straight, stopped = Blocks(shape, capacity=16), Blocks(shape, capacity=16)
    for sample in samples:
        straight.add(sample)
    for sample in samples[:before]:
        stopped.add(sample)
    state = stopped.state()
    taken = {key: array.tobytes() for key, array in state.items()}
    resumed = Blocks.from_state(state)
    for sample in samples[before:]:
        stopped.add(sample)  # must not reach into the state already taken
        resumed.add(sample)
    for key, array in straight.state().items():
        assert np.array_equal(array, resumed.state()[key])
    assert resumed.mean().tobytes() == straight.mean().tobytes()
    assert resumed.error().tobytes() == straight.error().tobytes()
    assert {key: array.tobytes() for key, array in state.items()} == taken


@pytest.mark.parametrize(
    ("phi", "steps"), [(0.0, 40), (0.0, 2000), (0.5, 2000), (0.9, 8000), (-0.5, 8000)]
)
def test_error_bar_is_the_analytic_one_and_covers_the_truth(ar1, phi, steps):
    replicas = 2000
    blocks = fill(ar1(steps, replicas, phi, seed=3))
    error, truth = blocks.error(), true_error(steps, phi)
    # One replica's error scatters by 1/sqrt(2 (n - 1)) with n >= 32 blocks, 13 %, so the mean over
    # the replicas by 0.3 %. A first correlation is beyond its noise by chance in 16 % of the
    # series, which biases it up by 3 %; correlations within their noise, by the same amount down.
    # 4 % holds both.
    assert error.mean() == pytest.approx(truth, rel=0.04)
    # Binomial error of the coverage sqrt(0.68 * 0.32 / 2000) = 1.0 %: three of it, plus 1.5 % for
    # the error bar's own scatter and bias (d coverage / d ln error = 0.48).
    covered = np.mean(abs(blocks.mean()) < error)
    binomial = np.sqrt(0.683 * 0.317 / replicas)
    assert abs(covered - 0.683) < 3 * binomial + 0.015


def test_correlations_longer_than_a_block_are_found(ar1):
    # 8000 steps, 62 blocks of 128; the correlation time of phi = 0.98 is 50: the blocks are
    # correlated, and their plain error is too small.
    blocks = fill(ar1(8000, 500, 0.98, seed=4))
    stored = blocks.blocks()
    plain = stored.std(axis=0, ddof=1) / np.sqrt(len(stored))
    truth = true_error(8000, 0.98)
    assert plain.mean() < 0.87 * truth
    # One replica's error scatters by 19 %, the mean over 500 by 0.9 %.
    assert 0.96 * truth < blocks.error().mean() < 1.04 * truth


@pytest.mark.parametrize(("times", "least"), [(4, 0.74), (6, 0.81), (10, 0.91), (30, 0.98)])
def test_runs_of_few_correlation_times_have_error_bars_of_nearly_full_size(ar1, times, least):
    steps = times * 19  # of phi = 0.9 the integrated correlation time is 19
    blocks = fill(ar1(steps, 2000, 0.9, seed=6))
    share = blocks.error().mean() / true_error(steps, 0.9)  # scatters by 1 %
    assert least < share < 1.05
    _, pieces = correlated(*deviations(blocks))
    assert (np.median(pieces) < FEWEST_PIECES) == (times < 10)


def deviations(blocks):
    sums, samples = blocks.sums()
    return (sums - np.multiply.outer(samples, blocks.mean())) / blocks.count, samples


@pytest.mark.parametrize(("correlation", "counts"), [(0.23, False), (0.25, True)])
def test_a_first_correlation_counts_beyond_its_noise(correlation, counts):
    # 32 pairs s (x, y) with 2 x y = c (x^2 + y^2) = c and signs ++--++--...: neighbours multiply to
    # 33 x y, as 31 products between pairs leave one; that is 33 / 32 x 64 / 63 x c / 2 of the
    # variance, and 1 / sqrt(63) is its noise: c = 0.2405.
    angle = np.arcsin(correlation) / 2
    signs = np.tile([1.0, 1.0, -1.0, -1.0], 8)
    residuals = np.multiply.outer(signs, [np.cos(angle), np.sin(angle)]).ravel()
    share = correlated_error(residuals, np.ones(64)) / np.sqrt(32 * 64 / 63)
    assert (share > 1.01) == counts
    assert counts or share == pytest.approx(1.0, rel=1e-12)


def test_merging_leaves_eight_blocks():
    # Still rising when 8 blocks are left, each +-4: sqrt(8 * 16 * 8 / 7).
    residuals = np.repeat([1.0, -1.0], 16)
    assert falling_error(residuals, np.ones(32)) == pytest.approx(np.sqrt(1024 / 7), rel=1e-12)


def test_the_unfinished_block_counts_by_its_length():
    # 16 samples +-1 merged to 8 blocks of 2, then one half block. By hand:
    # residuals are block sum - mean * samples, and sum w^2 = 8 * 4 + 1.
    samples = np.array([1, 1, -1, -1] * 4 + [3], float)
    blocks = fill(samples, capacity=16)
    mean = 3 / 17
    residuals = np.array([2, -2] * 4 + [3]) - mean * np.array([2] * 8 + [1])
    number = 17**2 / 33
    expected = np.sqrt((residuals**2).sum() * number / (number - 1)) / 17
    assert blocks.error() == pytest.approx(expected, rel=1e-12)
    assert blocks.mean() == mean


def test_few_samples_have_no_error_and_none_have_no_mean():
    blocks = Blocks(2)
    assert np.isnan(blocks.mean()).all()
    for _ in range(3):
        assert np.isnan(blocks.error()).all()
        blocks.add([1.0, 2.0])
    assert np.isnan(blocks.error()).all()
    blocks.add([5.0, 2.0])
    # Independent samples: s / sqrt(n), s^2 = 12 / 3 for 1, 1, 1, 5.
    assert blocks.error() == pytest.approx([1.0, 0.0], abs=1e-15)


def test_memory_is_bounded():
    blocks = Blocks(5)
    size = sum(array.nbytes for array in blocks.state().values())
    value = np.ones(5)
    for _ in range(100_000):
        blocks.add(value)
    assert sum(array.nbytes for array in blocks.state().values()) == size
    assert len(blocks.blocks()) < 64
    assert np.array_equal(blocks.mean(), value)


def test_wrong_shapes_and_capacities_are_refused():
    with pytest.raises(ValueError, match=r"shape \(3,\), got \(\)"):
        Blocks(3).add(1.0)
    with pytest.raises(ValueError, match="even"):
        Blocks(capacity=17)
    with pytest.raises(ValueError, match="at least 16"):
        Blocks(capacity=8)
    with pytest.raises(ValueError, match="same number of blocks"):
        correlated_error(np.zeros(4), np.ones(5))
    with pytest.raises(KeyError, match="counts"):
        Blocks.from_state({"sums": np.zeros(16)})


def test_blocking_error_of_a_plain_series(ar1):
    series = ar1(4000, 200, 0.8, seed=5)
    errors = [blocking_error(column) for column in series.T]
    # At phi = 0.8 the plateau begins near blocks of 32, n = 125: scatter 6 %, of 200 0.5 %; the
    # walk stops on average a little early, 3 %.
    assert np.mean(errors) == pytest.approx(true_error(4000, 0.8), rel=0.05)
    assert blocking_error([1, 1, 1, 5]) == pytest.approx(1.0)
    assert np.isnan(blocking_error([1, 2, 3])) and np.isnan(blocking_error([]))
    with pytest.raises(ValueError, match="one-dimensional"):
        blocking_error(series)
