"""Walkers between states, and escape over a barrier, against sums and integrals."""

import numpy as np
import pytest

from mesokit.theory import kramers_rate, occupation, slowest_relaxation, steady_occupation


def test_the_steady_state_lasts():
    rates = np.random.default_rng(1).random((7, 7)) ** 8  # of very different sizes
    steady = steady_occupation(rates)
    later = occupation(rates, steady, [3.0, 100.0])
    np.testing.assert_allclose(later, [steady, steady], rtol=1e-9)
    long = occupation(rates, np.eye(7)[3], [1e3 * slowest_relaxation(rates)])
    np.testing.assert_allclose(long[0], steady, rtol=1e-9)


def test_wells_far_apart_in_energy_have_the_weights_of_boltzmann():
    energy, top = np.array([0.0, 40.0, 3.0, -60.0]), np.array([45.0, 50.0, 10.0])
    rates = np.zeros((4, 4))
    for k in range(3):
        rates[k, k + 1], rates[k + 1, k] = np.exp(energy[[k, k + 1]] - top[k])
    weight = np.exp(-energy)
    np.testing.assert_allclose(steady_occupation(rates), weight / weight.sum(), rtol=1e-12)


def test_states_that_are_left_for_good_are_empty():
    assert steady_occupation([[0, 1, 0], [0, 0, 1], [0, 2, 0]]).tolist() == [0, 2 / 3, 1 / 3]
    assert steady_occupation([[0, 1], [0, 0]]).tolist() == [0, 1]


def test_what_depends_on_the_start_has_no_steady_state():
    apart = np.array([[0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1], [0, 0, 1, 0]])
    assert np.isnan(steady_occupation(apart)).all()
    assert np.isnan(steady_occupation([[0, 0], [0, 0]])).all()
    assert slowest_relaxation(apart) == np.inf


def test_negative_rates_and_times_are_refused():
    with pytest.raises(ValueError, match=r"rate = -1\.0"):
        steady_occupation([[0, -1], [1, 0]])
    with pytest.raises(ValueError, match=r"step = -1\.0"):
        occupation([[0, 1], [1, 0]], [1, 0], [1.0, 0.0])


def test_kramers_rate_is_that_of_the_mean_time_over_a_high_barrier():
    """The mean time from one well to the other, U = E (x^2 - 1)^2, is (1/D) int exp(U) int exp(-U)
    (Pontryagin, Andronov, Vitt 1933); the rate over the top is one over it."""
    barrier, x = 40.0, np.linspace(-1.6, 1.0, 200_001)
    dx, energy = x[1] - x[0], barrier * (x**2 - 1) ** 2
    inner = np.cumsum(np.exp(-energy)) * dx
    passed = x > -1
    time = (np.exp(energy[passed]) * inner[passed]).sum() * dx
    rate = kramers_rate(8 * barrier, 4 * barrier, 1.0, barrier, 1.0)
    assert rate * time == pytest.approx(1.0, rel=0.02)
    with pytest.raises(ValueError, match="kT = 0"):
        kramers_rate(1.0, 1.0, 1.0, 1.0, 0)
