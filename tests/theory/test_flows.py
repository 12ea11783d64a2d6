"""Steady and decaying flows: boundary conditions, equations of motion, fits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesokit.theory import (
    couette_velocity,
    kolmogorov_onset_time,
    kolmogorov_velocity,
    kolmogorov_viscosity,
    lees_edwards_relaxation_time,
    lees_edwards_velocity,
    oscillating_slit_response,
    oscillating_slit_velocity,
    poiseuille_fit,
    poiseuille_velocity,
    transverse_correlation,
    transverse_viscosity_fit,
    viscosity_renormalised,
)

positive = st.floats(0.05, 50)


@given(height=positive, g=positive, nu=positive)
def test_poiseuille_solves_navier_stokes(height, g, nu):
    y = np.linspace(0, height, 5)
    u = poiseuille_velocity(y, height, g, nu)
    assert u[[0, -1]] == pytest.approx(0, abs=1e-9 * u[2])
    curvature = (u[1] - 2 * u[2] + u[3]) / (y[1] - y[0]) ** 2
    assert nu * curvature == pytest.approx(-g, rel=1e-6)
    assert u[2] == pytest.approx(g * height**2 / (8 * nu))


@given(nu=positive, slip=st.floats(-1, 1), g=st.sampled_from([-0.3, 0.002]))
def test_poiseuille_fit_recovers(nu, slip, g):
    y = np.arange(0.5, 24)
    u = slip + poiseuille_velocity(y, 24, g, nu)
    for error in (None, np.linspace(1, 2, 24) * 1e-3):
        fit = poiseuille_fit(y, u, 24, g, error)
        assert fit.viscosity == pytest.approx(nu, rel=1e-6)
        assert fit.slip == pytest.approx(slip, abs=1e-8)


@pytest.mark.parametrize("known", [True, False])
def test_poiseuille_fit_error_bars(known):
    rng = np.random.default_rng(7)
    y, sigma = np.arange(0.5, 24), 0.01
    pulls = []
    for _ in range(400):
        u = 0.1 + poiseuille_velocity(y, 24, 0.01, 0.8) + sigma * rng.normal(size=24)
        fit = poiseuille_fit(y, u, 24, 0.01, np.full(24, sigma) if known else None)
        pulls.append(
            ((fit.viscosity - 0.8) / fit.viscosity_error, (fit.slip - 0.1) / fit.slip_error)
        )
    # the standard error of a standard deviation of 400 is 3.5 %, and t-distributed without sigma
    assert np.std(pulls, axis=0) == pytest.approx([1, 1], abs=0.15)
    assert np.mean(pulls, axis=0) == pytest.approx([0, 0], abs=0.2)


def test_poiseuille_refuses():
    y = np.arange(4.0)
    with pytest.raises(ValueError, match="height = 0"):
        poiseuille_velocity(y, 0, 1, 1)
    with pytest.raises(ValueError, match="acceleration = 0"):
        poiseuille_fit(y, y, 4, 0)
    with pytest.raises(ValueError, match="shape"):
        poiseuille_fit(y, y[1:], 4, 1)
    with pytest.raises(ValueError, match="2 points"):
        poiseuille_fit(y[:2], y[:2], 4, 1)
    with pytest.raises(ValueError, match="error"):
        poiseuille_fit(y, y, 4, 1, error=np.zeros(4))


@given(height=st.floats(2, 50), nu=st.floats(0.1, 5), frequency=st.floats(1e-3, 2))
def test_oscillating_slit_solves_navier_stokes(height, nu, frequency):
    """i w chi = 1 + nu chi'', no slip; slow as Poiseuille."""
    step = 1e-3 * min(height, (2 * nu / frequency) ** 0.5)
    y = 0.3 * height + step * np.arange(-1, 2)
    chi = oscillating_slit_response(y, height, nu, frequency)
    curvature = (chi[0] - 2 * chi[1] + chi[2]) / step**2
    assert abs(1j * frequency * chi[1] - 1 - nu * curvature) < 1e-4
    ends = oscillating_slit_response([0, height], height, nu, frequency)
    assert abs(ends).max() < 1e-12 / frequency
    slow = oscillating_slit_velocity(y, 0.0, height, 0.3, nu, 1e-5 * nu / height**2)
    assert slow == pytest.approx(poiseuille_velocity(y, height, 0.3, nu), rel=1e-5)
    with pytest.raises(ValueError, match="frequency = 0"):
        oscillating_slit_response(y, height, nu, 0)


@given(height=positive, upper=st.floats(-5, 5), lower=st.floats(-5, 5))
def test_couette_is_linear_between_the_plates(height, upper, lower):
    u = couette_velocity([0, height / 2, height], height, upper, lower)
    assert u == pytest.approx([lower, (lower + upper) / 2, upper], abs=1e-12)
    assert couette_velocity(height / 2, height, upper) == pytest.approx(0, abs=1e-12)


@given(length=positive, g=positive, nu=positive, waves=st.integers(1, 3))
def test_kolmogorov(length, g, nu, waves):
    top = length / (4 * waves)
    amplitude = float(kolmogorov_velocity(top, length, g, nu, waves=waves))
    k = 2 * np.pi * waves / length
    assert nu * k**2 * amplitude == pytest.approx(g)
    assert kolmogorov_viscosity(amplitude, length, g, waves) == pytest.approx(nu)
    onset = kolmogorov_onset_time(length, nu, waves)
    early = kolmogorov_velocity(top, length, g, nu, time=1e-4 * onset, waves=waves)
    assert early == pytest.approx(g * 1e-4 * onset, rel=1e-3)
    later = kolmogorov_velocity(top, length, g, nu, time=onset, waves=waves)
    assert later / amplitude == pytest.approx(1 - np.exp(-1))


def test_kolmogorov_refuses():
    with pytest.raises(ValueError, match=r"amplitude = -1\.0"):
        kolmogorov_viscosity(-1.0, 10, 1.0)
    with pytest.raises(ValueError, match="time = -1"):
        kolmogorov_velocity(0, 10, 1, 1, time=-1)


@given(length=positive, rate=st.floats(-2, 2))
def test_lees_edwards_images_move_past_each_other(length, rate):
    low, mid, high = lees_edwards_velocity([0, length / 2, length], length, rate)
    assert mid == 0
    assert high - low == pytest.approx(rate * length, abs=1e-12)


def test_lees_edwards_relaxation():
    assert lees_edwards_relaxation_time(20, 0.8) == pytest.approx(400 / (np.pi**2 * 0.8))
    # the slowest mode that the images allow dies within a quarter of it
    k = 2 * np.pi / 20
    assert transverse_correlation(k, lees_edwards_relaxation_time(20, 0.8) / 4, 0.8) == (
        pytest.approx(np.exp(-1))
    )


@given(nu=positive, k=st.floats(0.1, 1))
def test_transverse_fit_recovers(nu, k):
    time = np.linspace(0, 3, 20) / (nu * k * k)
    c = transverse_correlation(k, time, nu)
    assert c[0] == 1
    fit = transverse_viscosity_fit(k, time, c, 0.02)
    assert fit.viscosity == pytest.approx(nu, rel=1e-8)


def test_transverse_fit_error_bar():
    rng = np.random.default_rng(11)
    time, pulls = np.linspace(1, 60, 30), []
    for _ in range(400):
        c = transverse_correlation(0.3, time, 0.8) + 0.03 * rng.normal(size=30)
        fit = transverse_viscosity_fit(0.3, time, c, 0.03)
        pulls.append((fit.viscosity - 0.8) / fit.error)
    assert np.std(pulls) == pytest.approx(1, abs=0.15)
    assert np.mean(pulls) == pytest.approx(0, abs=0.2)


def test_transverse_fit_refuses():
    with pytest.raises(ValueError, match="error"):
        transverse_viscosity_fit(0.3, [1, 2], [0.5, 0.2], 0)
    with pytest.raises(ValueError, match="3 errors above 0"):
        transverse_viscosity_fit(0.3, [1, 2], [0.01, -0.02], 0.1)


def test_viscosity_renormalised_follows_the_simulated_growth():
    """2D SRD, M = 5, 90 degrees, timestep 1: nu at L = 16, 32, 64, molecular chaos 0.1907."""
    simulated = {16: 0.2068, 32: 0.2188, 64: 0.2321}
    for length, value in simulated.items():
        nu = viscosity_renormalised(2, 0.1907, 0.9509, 5, length, cutoff=8)
        assert nu == pytest.approx(value, rel=0.06)
    double = [viscosity_renormalised(2, 0.2, 0.4, 5, length) for length in (16, 32, 64)]
    assert np.diff(double) == pytest.approx(np.log(2) * (5 + 2.5) / (16 * np.pi * 5))


@pytest.mark.parametrize(("density", "low", "high"), [(5, 0.03, 0.07), (10, 0.01, 0.02)])
def test_viscosity_renormalised_in_three_dimensions(density, low, high):
    """3 to 7 % at M = 5 and 1 to 2 % at M = 10, for SRD at 90 degrees and timestep 0.1."""
    from mesokit.theory import transport

    t = transport("srd", 3, density, 0.1, 90)
    raised = viscosity_renormalised(3, t.viscosity, t.sound_attenuation, density)
    assert low < raised / t.viscosity - 1 < high
    in_a_box = viscosity_renormalised(3, t.viscosity, t.sound_attenuation, density, 20.0)
    assert in_a_box - t.viscosity == pytest.approx((raised - t.viscosity) * (1 - 2 / 20))
    direct = (
        np.pi / (np.pi**2 * density) * (7 / (60 * t.viscosity) + 1 / (30 * t.sound_attenuation))
    )
    assert raised - t.viscosity == pytest.approx(direct)


def test_viscosity_renormalised_refuses():
    with pytest.raises(ValueError, match="finite in 2D"):
        viscosity_renormalised(2, 1, 1, 5)
    with pytest.raises(ValueError, match="box_length = 1"):
        viscosity_renormalised(3, 1, 1, 5, 1)
