"""Multiple-tau correlator: equal to the direct sum, honest errors, same bits across a stop."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesokit.statistics import MultipleTau


def fill(samples, **keywords):
    keywords.setdefault("dtype", samples.dtype)
    correlator = MultipleTau(samples.shape[1:], **keywords)
    for sample in samples:
        correlator.add(sample)
    return correlator


def direct(samples, lag):
    """<Re a(t) conj a(t + lag)> over every pair in the series."""
    return (samples[: len(samples) - lag] * samples[lag:].conj()).real.mean(axis=0)


def coarse(samples, step):
    """Averages of `step` consecutive samples."""
    n = len(samples) // step
    return samples[: n * step].reshape(n, step, *samples.shape[1:]).mean(axis=1)


@pytest.mark.parametrize("kind", [float, complex])
@pytest.mark.parametrize("steps", [1, 5, 16, 17, 31, 32, 33, 64, 500, 1025])
@pytest.mark.parametrize(("points", "averages"), [(16, 2), (8, 4), (9, 3)])
def test_every_lag_is_the_direct_sum_over_the_averaged_series(kind, steps, points, averages):
    rng = np.random.default_rng(steps)
    samples = (rng.normal(size=(steps, 2, 3)) + 1j * rng.normal(size=(steps, 2, 3))).astype(complex)
    samples = samples if kind is complex else samples.real
    lag, value, error = fill(samples, points=points, averages=averages).correlation()
    assert value.shape == error.shape == (len(lag), 2, 3)
    assert np.array_equal(lag[:points], np.arange(min(steps, points)))
    assert (np.diff(lag) > 0).all()
    assert steps < 2 * points or lag[-1] > steps / 3  # nothing sampled is left out
    for tau, measured in zip(lag, value, strict=True):
        step = 1
        while tau >= points * step:
            step *= averages
        expected = direct(coarse(samples, step), tau // step)
        assert measured == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_long_lags_agree_with_the_exact_correlation_within_coarse_graining(ar1):
    phi, steps, replicas = 0.99, 20_000, 40
    correlator = fill(ar1(steps, replicas, phi, seed=11), max_lag=300)
    lag, value, error = correlator.correlation(average_over=0)
    assert lag[-1] == 288  # 18 * 16, the next is 304
    # Averages over M samples smooth phi^k by the factor (sinh(M u / 2) / (M sinh(u / 2)))^2,
    # u = -ln phi; level l holds lags from 8 M with M = 2^l.
    u, step = -np.log(phi), np.where(lag < 16, 1, 2.0 ** (np.log2(lag + 0.5) - 3).astype(int))
    smooth = (np.sinh(step * u / 2) / (step * np.sinh(u / 2))) ** 2
    assert 1.005 < smooth.max() < 1.01
    # Errors at different lags are strongly correlated; 4 of them bound the largest of 43.
    assert (error > 0).all() and (error < 0.05).all()
    assert (abs(value - phi**lag * smooth) < 4 * error).all()
    assert (abs(value - phi**lag) < 4 * error + phi**lag * (smooth - 1)).all()


@pytest.mark.parametrize("normalised", [False, True])
def test_error_bars_cover_the_truth(ar1, normalised):
    phi, replicas = 0.5, 1500
    correlator = fill(ar1(3000, replicas, phi, seed=12), max_lag=24)
    lag, value, error = correlator.correlation(normalised=normalised)
    binomial = np.sqrt(0.683 * 0.317 / replicas)
    for tau in (0, 1, 3, 10, 20):
        row = list(lag).index(tau)
        if tau == 0 and normalised:
            assert (value[row] == 1).all() and (error[row] == 0).all()
            continue
        smooth = 1.0 if tau < 16 else (np.sinh(np.log(2)) / (2 * np.sinh(np.log(2) / 2))) ** 2
        expected = phi**tau * smooth
        # The scatter of the value over the replicas is the true error, known to
        # 1 / sqrt(2 * 1500) = 1.8 %; the walk biases by 2 %.
        assert error[row].mean() == pytest.approx(value[row].std(), rel=3 * 0.018 + 0.02)
        # Three binomial errors, plus 1.5 % for the error bar's own scatter and bias.
        covered = np.mean(abs(value[row] - expected) < error[row])
        assert abs(covered - 0.683) < 3 * binomial + 0.015
    # Bartlett's formula at lag 0 and 1 for a Gaussian AR(1) process of n samples.
    if normalised:
        assert error[1].mean() == pytest.approx(np.sqrt((1 - phi**2) / 3000), rel=0.05)
    else:
        variance = 2 * (1 + phi**2) / (1 - phi**2) / 3000
        assert error[0].mean() == pytest.approx(np.sqrt(variance), rel=0.05)


def test_error_of_an_average_knows_that_signals_are_correlated(ar1):
    independent = ar1(3000, 100, 0.5, seed=13)
    copies = np.repeat(independent[:, :1], 100, axis=1)
    one = fill(independent[:, :1]).correlation(average_over=0)
    same = fill(copies).correlation(average_over=-1)
    assert same.value == pytest.approx(one.value, rel=1e-9, abs=1e-12)
    assert same.error == pytest.approx(one.error, rel=1e-6, abs=1e-12, nan_ok=True)
    # 100 independent signals: sqrt(100) smaller, with one error bar's scatter of 27 % at most,
    # averaged over the 16 correlated lags of the first level.
    many = fill(independent).correlation(average_over=0)
    every = fill(independent).correlation()
    gain = np.sqrt((every.error[:16] ** 2).mean(axis=1)) / many.error[:16]
    assert gain.mean() == pytest.approx(10, rel=0.27)


def test_normalised_value_and_average_over_axes():
    samples = np.random.default_rng(14).normal(size=(300, 2, 3, 4))
    correlator = fill(samples)
    plain = correlator.correlation(average_over=(0, 2))
    assert plain.value.shape == plain.error.shape == (len(plain.lag), 3)
    each = correlator.correlation().value
    assert plain.value == pytest.approx(each.mean(axis=(1, 3)), rel=1e-9, abs=1e-12)
    normalised = correlator.correlation(average_over=(0, 2), normalised=True)
    assert normalised.value == pytest.approx(plain.value / plain.value[0])


def test_long_lags_without_four_blocks_have_no_error():
    correlator = fill(np.random.default_rng(15).normal(size=200))
    lag, _, error = correlator.correlation()
    # Lag 112 is 7 averages of 16: 200 samples hold 12 averages, 5 products; at lag 160, 2.
    assert np.isfinite(error[lag <= 64]).all()
    assert np.isnan(error[lag >= 144]).all()


@settings(max_examples=40)
@given(st.integers(0, 400), st.integers(0, 400), st.sampled_from([float, complex]))
def test_same_bits_across_a_round_trip(before, after, kind):
    samples = np.random.default_rng(before + 1000 * after).normal(size=(before + after, 3))
    samples = samples * (1 + 0.5j) if kind is complex else samples
    keywords = {"points": 6, "averages": 3, "blocks": 16, "max_lag": 100, "dtype": kind}
    straight = fill(samples, **keywords)
    stopped = fill(samples[:before], **keywords)
    state = stopped.state()
    taken = {key: array.tobytes() for key, array in state.items()}
    resumed = MultipleTau.from_state(state)
    for sample in samples[before:]:
        stopped.add(sample)  # must not reach into the state already taken
        resumed.add(sample)
    assert straight.state().keys() == resumed.state().keys()
    for key, array in straight.state().items():
        assert array.tobytes() == resumed.state()[key].tobytes()
    for one, other in zip(straight.correlation(), resumed.correlation(), strict=True):
        assert one.tobytes() == other.tobytes()
    assert {key: array.tobytes() for key, array in state.items()} == taken


def test_memory_is_bounded():
    correlator = MultipleTau(3, max_lag=1000)
    value = np.ones(3)
    sizes = []
    for _ in range(2):
        for _ in range(50_000):
            correlator.add(value)
        sizes.append(sum(array.nbytes for array in correlator.state().values()))
    # 7 levels reach lag 1000: 16 points and at most 32 blocks of 16 lags each, 3 signals.
    assert sizes[0] == sizes[1] < 7 * (16 + 32 * 16) * 3 * 8 + 100
    lag, measured, error = correlator.correlation()
    assert lag[-1] == 960
    assert measured == pytest.approx(np.ones((len(lag), 3)), rel=1e-12)
    assert (error < 1e-12).all()
    assert correlator.block_length == 4096  # 100000 / 32, rounded up to a power of two


def test_nothing_sampled_gives_no_lags():
    lag, value, error = MultipleTau((2, 3)).correlation(average_over=0)
    assert lag.shape == (0,) and value.shape == error.shape == (0, 3)


def test_wrong_input_is_refused():
    with pytest.raises(ValueError, match="multiple of averages"):
        MultipleTau(points=15, averages=2)
    with pytest.raises(ValueError, match="at least 2"):
        MultipleTau(averages=1)
    with pytest.raises(ValueError, match="max_lag"):
        MultipleTau(max_lag=-1)
    with pytest.raises(ValueError, match="float or complex"):
        MultipleTau(dtype=int)
    with pytest.raises(ValueError, match="even"):
        MultipleTau(blocks=31)
    with pytest.raises(ValueError, match=r"shape \(2,\), got \(3,\)"):
        MultipleTau(2).add(np.ones(3))
    with pytest.raises(TypeError, match="dtype=complex"):
        MultipleTau(2).add(np.ones(2, complex))
    with pytest.raises(np.exceptions.AxisError):
        MultipleTau(2).correlation(average_over=1)
    with pytest.raises(KeyError, match="numbers"):
        MultipleTau.from_state({})


def test_products_add_up_to_the_correlation():
    correlator = MultipleTau(shape=(2,), points=4, max_lag=12)
    for sample in np.random.default_rng(3).normal(size=(100, 2)):
        correlator.add(sample)
    whole = correlator.correlation()
    parts = list(correlator.products())
    assert np.concatenate([p.lag for p in parts]).tolist() == whole.lag.tolist()
    means = [p.sums.sum(axis=0) / p.counts.sum(axis=0)[:, None] for p in parts]
    assert np.allclose(np.concatenate(means), whole.value)
    assert correlator.block_length == 4
    short = list(correlator.products(within_blocks=True))
    assert [p.lag[0] for p in short] == [0, 4, 8]  # averages over 1, 2 and 4 samples


@pytest.mark.parametrize("kind", [float, complex])
def test_pooled_axes_are_averaged_over(kind):
    """Their mean correlation, and what a resume needs, are those of all signals kept apart."""
    rng = np.random.default_rng(4)
    apart = MultipleTau((2, 5, 3), dtype=kind)
    pooled = MultipleTau((2, 5, 3), dtype=kind, pooled=2)
    for _ in range(500):
        sample = rng.normal(size=(2, 5, 3)).astype(kind)
        apart.add(sample)
        pooled.add(sample)
        pooled = MultipleTau.from_state(pooled.state())
    expected, found = apart.correlation(average_over=(1, 2)), pooled.correlation()
    np.testing.assert_array_equal(found.lag, expected.lag)
    np.testing.assert_allclose(found.value, expected.value, atol=1e-12)
    np.testing.assert_allclose(found.error, expected.error, rtol=1e-9)
    with pytest.raises(ValueError, match="pooled"):
        MultipleTau((2,), pooled=2)
