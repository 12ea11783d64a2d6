"""Spectra have the power that went in; frequencies have the right error bars."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit.statistics import TimeSeries, dominant_frequency, spectrum


def test_white_noise_is_flat_with_honest_error_bars():
    rng = np.random.default_rng(1)
    found = [spectrum(rng.normal(size=2000), 0.5) for _ in range(60)]
    power = np.array([s.power for s in found])
    assert power[:, 1:-1].mean() == pytest.approx(2 * 0.5, rel=0.01)  # one-sided, variance 1
    spread = power.std(axis=0, ddof=1)[2:-2].mean()
    assert np.mean([s.error[2:-2].mean() for s in found]) == pytest.approx(spread, rel=0.1)


@pytest.mark.parametrize(("noise", "wander"), [(2.0, 0.0), (0.3, 0.02), (1.0, 0.05)])
def test_error_of_the_frequency_is_that_of_repeated_runs(noise, wander):
    rng = np.random.default_rng(2)
    time, values, errors = 0.5 * np.arange(4000), [], []
    for _ in range(40):
        phase = 2 * np.pi * 0.0317 * time + np.cumsum(wander * rng.normal(size=len(time)))
        found = dominant_frequency(np.sin(phase) + noise * rng.normal(size=len(time)), 0.5)
        values.append(found.value)
        errors.append(found.error)
    assert abs(np.mean(values) - 0.0317) < 4 * np.std(values) / 40**0.5
    # white noise is counted at both ends of each piece: the error bar is an upper bound
    assert 0.7 < np.sqrt(np.mean(np.square(errors))) / np.std(values) < 6


def test_no_frequency_in_noise():
    rng = np.random.default_rng(3)
    walk = np.cumsum(rng.normal(size=3000))
    for series in (rng.normal(size=3000), walk, np.zeros(3000), np.ones(10)):
        assert dominant_frequency(series, 1.0) is None


def test_short_series_have_no_spectrum():
    assert len(spectrum(np.ones(20), 1.0).power) == 0
    with pytest.raises(ValueError, match="interval above 0"):
        spectrum(np.ones(100), 0.0)


def test_time_series_goes_on_from_its_state():
    rng = np.random.default_rng(4)
    samples = rng.normal(size=(500, 2))
    whole, part = TimeSeries(2, rows=16), TimeSeries(2, rows=16)
    for i, sample in enumerate(samples):
        whole.add(i, sample)
        part.add(i, sample)
        if i % 37 == 0:
            part = TimeSeries.from_state(part.state())
    assert np.array_equal(whole.values(), part.values()) and whole.stride == 32
    assert whole.values() == pytest.approx(samples[:480].reshape(15, 32, 2).mean(axis=1))
    assert whole.time() == pytest.approx(32 * np.arange(15) + 15.5)
    with pytest.raises(ValueError, match="even"):
        TimeSeries(1, rows=3)
