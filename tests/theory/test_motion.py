"""Diffusion and velocity correlations of a fluid particle."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesokit import theory
from mesokit.theory import (
    decorrelation_from_diffusion,
    msd_molecular_chaos,
    transport,
    vacf_modes,
    vacf_molecular_chaos,
    vacf_tail,
)


@given(g=st.floats(0.05, 1.9), dt=st.floats(0.01, 2), d=st.sampled_from([1, 2, 3]))
def test_msd_is_the_double_sum_of_the_velocity_correlation(g, dt, d):
    steps = np.arange(30)
    c = vacf_molecular_chaos(steps, g, kT=2, mass=3)
    expected = [d * dt**2 * sum(c[abs(i - j)] for i in range(n) for j in range(n)) for n in steps]
    assert msd_molecular_chaos(steps, dt, g, d, kT=2, mass=3) == pytest.approx(expected, abs=1e-9)


@given(g=st.floats(0.05, 1.9), dt=st.floats(0.01, 2))
def test_msd_limits(g, dt):
    first, late, later = msd_molecular_chaos([1, 2000, 2001], dt, g, 3)
    assert first == pytest.approx(3 * dt**2, rel=1e-9)
    diffusion = dt * (1 / g - 0.5)
    assert later - late == pytest.approx(6 * diffusion * dt, rel=1e-6, abs=1e-9)
    assert decorrelation_from_diffusion(diffusion, dt) == pytest.approx(g)


def test_msd_slope_is_that_of_transport():
    t = transport("srd", 3, 5, 1.0, 90)
    g = decorrelation_from_diffusion(t.diffusion, 1.0)
    assert g == pytest.approx(2 / 3 * (1 - (1 - np.exp(-5)) / 5))  # 1 - r1 = 2/3
    slope = np.diff(msd_molecular_chaos([500, 501], 1.0, g, 3))[0]
    assert slope == pytest.approx(6 * 1.3718, rel=1e-4)


def test_motion_refuses():
    with pytest.raises(ValueError, match="decorrelation = 0"):
        msd_molecular_chaos(1, 0.1, 0, 3)
    with pytest.raises(ValueError, match="steps = -1"):
        msd_molecular_chaos(-1, 0.1, 0.5, 3)
    with pytest.raises(ValueError, match="decorrelation = 2"):
        vacf_molecular_chaos(1, 2)
    with pytest.raises(ValueError, match="time = 0"):
        vacf_tail(0, 1, 1, 5, 2)
    with pytest.raises(ValueError, match="box"):
        vacf_modes(1.0, 1, 1, 5, box=10)


@pytest.mark.parametrize("box", [(6.0, 9.0), (5.0, 6.0, 8.0)])
def test_vacf_modes_is_the_sum_over_wave_vectors(box):
    d, time, nu, diffusion, rho = len(box), np.array([0.5, 2.0]), 0.6, 0.1, 5 * 1.5
    grid = np.meshgrid(*(2 * np.pi / side * np.arange(-30, 31) for side in box))
    k2 = sum(k**2 for k in grid).ravel()
    k2 = k2[k2 > 0]
    modes = np.exp(-(nu + diffusion) * k2 * time[:, None]).sum(axis=1)
    expected = (d - 1) / d * 2 / (rho * np.prod(box)) * modes
    assert vacf_modes(time, nu, diffusion, 5, box, kT=2, mass=1.5) == pytest.approx(expected)


@pytest.mark.parametrize("d", [2, 3])
def test_vacf_modes_tends_to_the_tail_in_a_large_box(d):
    tail = vacf_tail([2.0, 5.0], 0.6, 0.1, 5, d)
    side = 1000.0
    # a missing mode at k = 0 is all that is left
    rest = (d - 1) / d / (5 * side**d)
    modes = vacf_modes([2.0, 5.0], 0.6, 0.1, 5, box=(side,) * d)
    assert modes + rest == pytest.approx(tail, rel=1e-9)


@given(nu=st.floats(0.1, 3), rho=st.floats(1, 20))
def test_vacf_tail_integrates_to_a_mode_coupling_diffusion(nu, rho):
    """In 3D the tail from time t on adds 2 t C(t) to D: (2/3) kT/rho 2 t (4 pi nu t)^(-3/2)."""
    t = np.geomspace(1, 1e6, 20001)
    c = vacf_tail(t, nu, 0.1, rho, 3)
    integral = np.sum((c[1:] + c[:-1]) / 2 * np.diff(t))
    assert integral == pytest.approx(2 * c[0], rel=2e-3)


def test_beads_of_molecules_between_two_limits():
    """Without springs a bead is alone, with stiff ones as heavy as its molecule."""
    n, modes = np.arange(0, 60, 7), theory.linear_modes(4).eigenvalues
    alone = theory.msd_molecular_chaos(n, 0.5, 0.3, 3)
    heavy = theory.msd_molecular_chaos(n, 0.5, 0.3, 3, 1.0, 4.0)
    soft = theory.msd_rouse_beads(n, 0.5, 0.3, modes, 1e-8, 3)
    stiff = theory.msd_rouse_beads(n, 0.5, 0.3, modes, 1e8, 3)
    np.testing.assert_allclose(soft, alone, rtol=1e-4)
    np.testing.assert_allclose(stiff, heavy, rtol=1e-4, atol=1e-4)


def test_beads_with_much_friction_are_those_of_rouse():
    """2 d D t/N and the sum over exp(-t/tau_p), where inertia and timestep are short."""
    dt, g, k, n = 0.01, 0.5, 1.0, np.array([3000, 200, 9000])
    friction = 1 / (dt * (1 / g - 0.5))
    modes = theory.linear_modes(5)
    times = theory.rouse_times(modes, friction, K=k / 2).mode
    t = n * dt
    inner = (2 / 5 * 3 / (k * modes.eigenvalues[1:])) @ (1 - np.exp(-t / times[:, None]))
    expected = 6 * t / (5 * friction) + inner
    found = theory.msd_rouse_beads(n, dt, g, modes.eigenvalues, k, 3)
    np.testing.assert_allclose(found, expected, rtol=0.01)
