"""Relaxation times, moduli and steady shear of Rouse molecules."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.linalg import expm, solve_continuous_lyapunov
from scipy.optimize import brentq

from mesokit.theory import (
    apparent_viscosity,
    complex_viscosity,
    dumbbell_thinning,
    dumbbell_viscosity,
    fene_p_thinning,
    linear_modes,
    loss_modulus,
    maxwell_shear,
    mean_square_bond,
    mean_square_end_to_end,
    mean_square_gyration,
    pair_friction,
    relaxation_modulus,
    ring_modes,
    rouse_times,
    rouse_times_from_slowest,
    shear_heating,
    size_in_shear,
    star_modes,
    storage_modulus,
    zimm_times,
)

TAU = [20.0, 6.0, 1.5]


@given(bonds=st.integers(1, 99), zeta=st.floats(0.5, 50), K=st.floats(0.1, 10))
def test_stress_times_are_those_of_the_thesis(bonds, zeta, K):
    times = rouse_times(linear_modes(bonds + 1), zeta, K=K)
    p = np.arange(1, bonds + 1)
    sigma_squared = mean_square_bond(K=K)  # (5.1.47)
    printed = sigma_squared * zeta / (24 * np.sin(p * np.pi / (2 * (bonds + 1))) ** 2)  # (5.1.16)
    assert times.stress == pytest.approx(printed)
    assert times.mode == pytest.approx(2 * printed)


def test_bonds_decay_with_mode_times():
    """The correlation of a chain's bonds, by the exponential of its equation of motion."""
    n, zeta, k, t = 5, 7.0, 2.0, 3.0
    bonds = np.diff(np.eye(n), axis=0)
    motion = expm(-k / zeta * bonds @ bonds.T * t)
    rates = -np.log(np.linalg.eigvalsh(motion)[::-1]) / t
    assert rouse_times(linear_modes(n), zeta, k=k).mode == pytest.approx(1 / rates)


def test_dimer_of_the_thesis():
    """Simulation: <R^2> = 9.01, <R(t) R(0)> decays in 27.2; 13.4 and 26.8 were published."""
    times = rouse_times_from_slowest(linear_modes(2), mode_time=26.8)
    assert times.stress.tolist() == [13.4]
    assert rouse_times_from_slowest(linear_modes(2), stress_time=13.4).mode.tolist() == [26.8]
    zeta = 26.8 * 4 / 6
    assert rouse_times(linear_modes(2), zeta, K=1 / 6).mode == pytest.approx([26.8])


@pytest.mark.parametrize("modes", [ring_modes(6), star_modes(3, 2), linear_modes(7)])
def test_slowest_time_sets_the_others(modes):
    times = rouse_times(modes, 3.0, k=2.0)
    again = rouse_times_from_slowest(modes, stress_time=times.stress[0])
    assert again.mode == pytest.approx(times.mode)
    assert np.all(np.diff(times.mode) <= 1e-12)


def test_long_chains_go_as_one_over_p_squared():
    mode = rouse_times_from_slowest(linear_modes(1000), mode_time=1.0).mode
    p = np.arange(1, 11)
    assert mode[:10] == pytest.approx(1 / p**2, rel=1e-3)


@pytest.mark.parametrize("w", [0.01, 0.1, 1.0])
def test_moduli_are_the_transform_of_the_relaxation_modulus(w):
    def of(t):
        return float(relaxation_modulus(t, 3.0, TAU))

    storage = w * quad(of, 0, np.inf, weight="sin", wvar=w, epsabs=1e-9)[0]
    loss = w * quad(of, 0, np.inf, weight="cos", wvar=w, epsabs=1e-9)[0]
    assert storage_modulus(w, 3.0, TAU) == pytest.approx(storage, rel=1e-6)
    assert loss_modulus(w, 3.0, TAU) == pytest.approx(loss, rel=1e-6)
    assert loss_modulus(w, 3.0, TAU, 8.0) == pytest.approx(loss + 8 * w, rel=1e-6)


@given(w=st.floats(1e-3, 1e3))
def test_complex_viscosity_is_the_complex_modulus_over_iw(w):
    g = storage_modulus(w, 3.0, TAU) + 1j * loss_modulus(w, 3.0, TAU, 8.0)
    assert complex_viscosity(w, 3.0, TAU, 8.0) == pytest.approx(complex(g / (1j * w)))


def test_kramers_kronig():
    """G'(w) = (2 w^2/pi) P int G''(x)/x /(w^2 - x^2) dx with the solvent taken out."""
    w = 0.3
    own = float(loss_modulus(w, 3.0, TAU)) / w

    def smooth(x):  # the singularity taken out: the principal value of 1/(w^2 - x^2) is 0
        x = x if abs(x - w) > 1e-6 else w + 1e-6
        return (float(loss_modulus(x, 3.0, TAU)) / x - own) / (w * w - x * x)

    integral = quad(smooth, 0, w)[0] + quad(smooth, w, np.inf, limit=200)[0]
    storage = float(storage_modulus(w, 3.0, TAU))
    assert 2 * w * w / np.pi * integral == pytest.approx(storage, rel=1e-5)


def test_moduli_in_their_limits():
    eta = apparent_viscosity(8.0, 3.0, TAU)
    assert complex_viscosity(1e-7, 3.0, TAU, 8.0) == pytest.approx(eta, rel=1e-5)
    assert complex_viscosity(1e7, 3.0, TAU, 8.0) == pytest.approx(8.0, rel=1e-5)
    assert storage_modulus(1e7, 3.0, TAU) == pytest.approx(9.0)
    assert relaxation_modulus(0, 3.0, TAU) == pytest.approx(9.0)
    assert relaxation_modulus([0, 1], 3.0, TAU).shape == (2,)


def test_steady_shear_follows_from_the_relaxation_modulus():
    """eta = int G dt and N1 = 2 rate^2 int t G dt, Lodge's rubber-like liquid."""
    rate = 0.2
    eta = quad(lambda t: float(relaxation_modulus(t, 3.0, TAU)), 0, np.inf)[0]
    first = 2 * rate**2 * quad(lambda t: t * float(relaxation_modulus(t, 3.0, TAU)), 0, np.inf)[0]
    found = maxwell_shear(rate, 3.0, TAU, 8.0)
    assert found == pytest.approx((8 + eta, first, 0.0))
    assert maxwell_shear(-rate, 3.0, TAU, 8.0) == pytest.approx(found)
    assert maxwell_shear(50 * rate, 3.0, TAU, 8.0).viscosity == pytest.approx(8 + eta)


@pytest.mark.parametrize("beads", [2, 3, 8])
@pytest.mark.parametrize("rate", [0.0, 0.05, 0.6])
def test_molecules_in_shear_by_the_covariance_of_their_bonds(beads, rate):
    """The steady covariance of the bonds' equation of motion, by a Lyapunov equation."""
    zeta, k, kT = 5.0, 0.8, 1.3
    bonds = np.diff(np.eye(beads), axis=0)
    b = beads - 1
    shear = np.zeros((3, 3))
    shear[0, 1] = rate
    drift = np.kron(np.eye(b), shear) - k / zeta * np.kron(bonds @ bonds.T, np.eye(3))
    noise = 2 * kT / zeta * np.kron(bonds @ bonds.T, np.eye(3))
    c = solve_continuous_lyapunov(drift, -noise).reshape(b, 3, b, 3)

    times = rouse_times(linear_modes(beads), zeta, k=k).stress
    size = size_in_shear(linear_modes(beads), rate, times[0], mean_square_bond(k=k, kT=kT))
    assert size.end_to_end == pytest.approx(np.einsum("iaja->", c))
    assert size.bond == pytest.approx(np.einsum("iaia->", c) / b)
    bead = np.vstack([np.zeros(b), np.tril(np.ones((b, b)))])  # places from bonds
    bead -= bead.mean(axis=0)
    assert size.gyration == pytest.approx(np.einsum("ni,iaja,nj->", bead, c, bead) / beads)

    chains = 0.7
    stress = chains * k * np.einsum("iaib->ab", c)
    found = maxwell_shear(rate, chains * kT, times)
    assert stress[0, 1] == pytest.approx(found.viscosity * rate, abs=1e-12)
    assert stress[0, 0] - stress[1, 1] == pytest.approx(found.first, abs=1e-9)
    assert stress[1, 1] - stress[2, 2] == pytest.approx(found.second, abs=1e-9)


def test_size_at_rest_is_that_of_equilibrium():
    for modes in (linear_modes(9), star_modes(3, 4), ring_modes(8)):
        size = size_in_shear(modes, 0.0, 5.0, 1.5)
        assert size.gyration == pytest.approx(mean_square_gyration(modes, 1.5))
    assert size_in_shear(linear_modes(9), 0, 5, 1.5).end_to_end == pytest.approx(
        mean_square_end_to_end(9, 1.5)
    )
    assert size_in_shear(ring_modes(8), 0, 5, 1.5).bond == pytest.approx(1.5 * 7 / 8)


@given(rate=st.floats(0, 1e4), tau=st.floats(0.1, 100), d=st.sampled_from([2, 3]))
def test_stiffened_dumbbells_keep_their_length(rate, tau, d):
    share = dumbbell_thinning(rate, tau, d)
    assert 0 < share <= 1
    stiffer = size_in_shear(linear_modes(2), rate, share * tau, share * 9, d)
    assert stiffer.bond == pytest.approx(9, rel=1e-9)


def test_thinning_goes_as_the_rate_to_minus_two_thirds():
    assert dumbbell_thinning(1e5, 10) / dumbbell_thinning(1e6, 10) == pytest.approx(
        10 ** (2 / 3), rel=1e-3
    )
    root = brentq(lambda x: x * x * (x - 1) - 2 / 3 * 0.7**2, 1, 2)
    assert dumbbell_thinning(0.07, 10) == pytest.approx(1 / root)


@pytest.mark.parametrize("rate", [0.0, 0.3])
def test_hookean_dumbbells_by_their_size_across_the_flow(rate):
    zeta, k, kT = 17.0, 0.4, 1.2
    times = rouse_times(linear_modes(2), zeta, k=k).stress
    expected = maxwell_shear(rate, 5 * kT, times, 8.7).viscosity
    assert dumbbell_viscosity(5, zeta, kT / k, 8.7) == pytest.approx(expected)


def test_fene_dumbbells_at_rest():
    """phi kT tau b/(b + 5), Bird et al. (1987), by quadrature of Boltzmann's distribution."""
    zeta, k, R0 = 17.0, 1 / 3, 6.0
    b = k * R0**2
    radial = [quad(lambda r, n=n: r**n * (1 - (r / R0) ** 2) ** (b / 2), 0, R0)[0] for n in (2, 4)]
    across = radial[1] / radial[0] / 3
    assert dumbbell_viscosity(5, zeta, across) == pytest.approx(5 * zeta / (4 * k) * b / (b + 5))


@given(rate=st.floats(0, 1e3), b=st.floats(1, 1e3), d=st.sampled_from([2, 3]))
def test_fene_p_springs_are_as_stiff_as_their_mean_square_makes_them(rate, b, d):
    tau, k = 10.0, 0.5
    factor = (1 + d / b) / fene_p_thinning(rate, tau, b, d)
    size = size_in_shear(linear_modes(2), rate, tau / factor, d / (k * factor), d).bond
    assert 1 - size / (b / k) == pytest.approx(1 / factor, rel=1e-8)


def test_pairs_relax_as_with_zimm():
    zeta, k, radius = 17.0, 1 / 3, 0.104
    friction = pair_friction(zeta, radius, np.sqrt(6 / np.pi) / 3)
    viscosity = zeta / (6 * np.pi * radius)
    expected = zimm_times(2, zeta, viscosity, bond_length=3.0).mode[0]
    assert friction / (2 * k) == pytest.approx(expected)
    with pytest.raises(ValueError, match="hydrodynamic_radius = 2"):
        pair_friction(1, 2, 1)


def test_heating_is_the_work_over_the_heat_capacity():
    assert shear_heating(0.1, 6.0, 5, dimension=2) == pytest.approx(6 * 0.01 / (5 * 2 / 2))
    assert shear_heating(0.1, 6.0, 5, 0.5) == pytest.approx(6 * 0.01 / (5 * 1.5 * 3 / 2))


def test_refuses():
    with pytest.raises(ValueError, match="friction = 0"):
        rouse_times(linear_modes(2), 0, K=1)
    with pytest.raises(ValueError, match="expected one"):
        rouse_times_from_slowest(linear_modes(2))
    with pytest.raises(ValueError, match=r"stress_times = \[1, 0\]"):
        relaxation_modulus(1.0, 1.0, [1, 0])
    with pytest.raises(ValueError, match="time = -1"):
        relaxation_modulus(-1, 1.0, [1])
    with pytest.raises(ValueError, match="viscosity = -1"):
        loss_modulus(1, 1.0, [1], viscosity=-1)
    with pytest.raises(ValueError, match="bonds_per_particle = -1"):
        shear_heating(0.1, 1, 1, -1)
