"""Correlations of bonds in time, against the matrix of the process and sizes at equal times."""

import numpy as np
import pytest
from scipy.linalg import expm, solve_continuous_lyapunov

from mesokit.theory import bond_correlation, linear_modes, rouse_times_from_slowest, size_in_shear

RATE, TAU, SQUARE = 0.3, 5.0, 6.0


def test_a_dimer_is_an_ornstein_uhlenbeck_process():
    """dR/dt = (flow - 1/2 tau) R + noise: C(t) = expm(A t) C(0), C(0) by Lyapunov's equation."""
    drift = np.array([[-0.5 / TAU, RATE], [0.0, -0.5 / TAU]])
    noise = SQUARE / 3 / TAU * np.eye(2)
    at_once = solve_continuous_lyapunov(drift, -noise)
    for t in (0.0, 2.0, 9.0):
        expected = expm(drift * t) @ at_once
        found = bond_correlation(t, [TAU], SQUARE, RATE)
        measured = [[found.xx, found.xy], [found.yx, found.yy]]
        np.testing.assert_allclose(measured, expected, rtol=1e-10)
        assert found.zz == found.yy


@pytest.mark.parametrize("dimension", [2, 3])
def test_at_equal_times_it_is_the_size_in_shear(dimension):
    modes = linear_modes(5)
    times = rouse_times_from_slowest(modes, stress_time=TAU).stress
    found = bond_correlation(0.0, times, SQUARE, RATE, dimension)
    total = found.xx + found.yy + (found.zz if dimension == 3 else 0.0)
    assert total == pytest.approx(size_in_shear(modes, RATE, TAU, SQUARE, dimension).bond)


def test_only_the_future_is_carried_on():
    """What lies along y turns towards x, more so with time; x never towards y."""
    found = bond_correlation(np.linspace(0, 20, 50), [TAU], SQUARE, RATE)
    assert (found.xy[1:] > found.yx[1:]).all() and found.xy[0] == found.yx[0]
    with pytest.raises(ValueError, match="time = -1"):
        bond_correlation(-1, [TAU], SQUARE)
