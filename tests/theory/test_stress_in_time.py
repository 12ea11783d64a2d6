"""Stress while the shear changes, against closed forms of the textbooks and against quadrature."""

import numpy as np
import pytest
from scipy.integrate import quad

from mesokit.theory import (
    loss_modulus,
    maxwell_shear,
    relaxation_modulus,
    storage_modulus,
    stress_in_time,
)

TAU = np.array([20.0, 6.0, 1.5])
G, ETA, RATE = 5.0, 8.0, 0.1
TIME = np.linspace(0.0, 60.0, 6001)
MIDDLE = 0.5 * (TIME[1:] + TIME[:-1])


def of_strain(strain, **parts):
    return stress_in_time(TIME, strain(TIME), G, TAU, **({"viscosity": ETA} | parts))


def test_start_up():
    """Bird et al., eqs 5.3-10 and 5.3-11 for a Maxwell mode that moves with the flow."""
    found, x = of_strain(lambda t: RATE * t), MIDDLE[:, None] / TAU
    shear = ETA * RATE + G * RATE * (TAU * (1 - np.exp(-x))).sum(axis=1)
    first = 2 * G * RATE**2 * (TAU**2 * (1 - (1 + x) * np.exp(-x))).sum(axis=1)
    np.testing.assert_allclose(found.shear, shear, rtol=1e-5)
    np.testing.assert_allclose(found.first, first, rtol=1e-4, atol=1e-5)


def test_cessation():
    stop = 30.0
    found = of_strain(lambda t: RATE * np.minimum(t, stop))
    late, since = stop < MIDDLE, (MIDDLE - stop)[:, None] / TAU
    reached = 1 - np.exp(-stop / TAU)
    shear = G * RATE * (TAU * reached * np.exp(-since)).sum(axis=1)
    np.testing.assert_allclose(found.shear[late], shear[late], rtol=1e-5)
    np.testing.assert_array_equal(found.shear[late], found.molecules[late])


def test_step_strain_shows_the_relaxation_modulus():
    """And N1 = gamma sigma_xy, the rule of Lodge and Meissner."""
    gamma, after = 0.5, MIDDLE > 0.02
    found = of_strain(lambda t: gamma * np.minimum(t / 0.01, 1.0))
    modulus = relaxation_modulus(MIDDLE - 0.005, G, TAU)
    np.testing.assert_allclose(found.molecules[after], gamma * modulus[after], rtol=1e-4)
    np.testing.assert_allclose(found.first[after], gamma * found.molecules[after], rtol=1e-2)


def test_any_rate_is_convolved_with_the_relaxation_modulus():
    def rate(t):
        return 0.02 * t * np.exp(-t / 15.0)

    strain = -0.3 * (TIME + 15.0) * np.exp(-TIME / 15.0) + 4.5
    found = stress_in_time(TIME, strain, G, TAU)
    for i in (500, 2500, 5999):
        t = MIDDLE[i]
        expected = quad(lambda s, t=t: rate(s) * float(relaxation_modulus(t - s, G, TAU)), 0, t)[0]
        assert found.shear[i] == pytest.approx(expected, rel=1e-5)


def test_oscillation_is_stored_and_lost():
    w, amplitude = 2 * np.pi / 4.0, 0.2
    time = np.linspace(0.0, 400.0, 80_001)
    found = stress_in_time(time, amplitude * np.sin(w * time), G, [3.0, 1.0], ETA).shear
    t, last = 0.5 * (time[1:] + time[:-1]), slice(-800, None)  # a period
    stored, lost = (2 * (found * wave(w * t))[last].mean() / amplitude for wave in (np.sin, np.cos))
    assert stored == pytest.approx(float(storage_modulus(w, G, [3.0, 1.0])), rel=1e-4)
    assert lost == pytest.approx(float(loss_modulus(w, G, [3.0, 1.0], ETA)), rel=1e-4)


def test_long_intervals_are_exact_too():
    """Steady shear after one interval of many relaxation times."""
    found = stress_in_time([0.0, 1e4, 2e4], [0.0, 1e3, 2e3], G, TAU, ETA)
    steady = maxwell_shear(RATE, G, TAU, ETA)
    assert found.shear[1] == pytest.approx(steady.viscosity * RATE)
    assert found.first[1] == pytest.approx(steady.first)


def test_a_simple_fluid_has_no_memory():
    found = stress_in_time(TIME, RATE * TIME, G, [], ETA)
    np.testing.assert_allclose(found.shear, ETA * RATE)
    assert not found.molecules.any() and not found.first.any()


@pytest.mark.parametrize("time", [[0.0, 1.0, 1.0], [0.0, 1.0]])
def test_times_must_grow(time):
    with pytest.raises(ValueError, match="expected growing times"):
        stress_in_time(time, [0.0, 1.0, 2.0], G, TAU)
