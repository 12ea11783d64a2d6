"""Transverse velocity modes of fluids of dimers and chains."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.linalg import expm

from mesokit.theory import (
    GaussianMolecule,
    apparent_viscosity,
    dimer_oscillation_range,
    gaussian_stress_kernel,
    linear_modes,
    relaxation_modulus,
    ring_modes,
    rouse_times_from_slowest,
    star_modes,
    transverse_correlation,
    transverse_correlation_chain,
    transverse_correlation_dimer,
    transverse_correlation_finite_k,
    transverse_poles,
)

K30 = 2 * np.pi / 30
NU = 0.8705
TIMES = np.array([5.0, 10, 20, 40, 60])
# time, first with 13.4, then with 26.8 as stress time; decamers with 26.8
DIMER_13 = [0.62230, 0.12758, -0.30899, 0.09119, -0.02546]
DIMER_27 = [0.60954, 0.05950, -0.46270, 0.20704, -0.08927]
DECAMER = [0.63330, 0.26826, -0.09251, -0.05822, 0.00041]


def chain(beads, stress_time):
    return rouse_times_from_slowest(linear_modes(beads), stress_time=stress_time).stress


def by_expm(k, times, nu, elasticity, tau):
    """C(t) = [exp(A t)]_00 of the arrow matrix, without its eigenvalues."""
    c = k * np.sqrt(elasticity)
    a = np.diag(-np.append(nu * k * k, 1 / np.asarray(tau)))
    a[0, 1:], a[1:, 0] = -c, c
    return np.array([expm(a * t)[0, 0] for t in times])


def test_reference_values():
    dimer = transverse_correlation_dimer(K30, TIMES, NU, 0.5, 13.4)
    assert dimer == pytest.approx(DIMER_13, abs=6e-6)
    dimer = transverse_correlation_dimer(K30, TIMES, NU, 0.5, 26.8)
    assert dimer == pytest.approx(DIMER_27, abs=6e-6)
    decamer = transverse_correlation_chain(K30, TIMES, NU, 0.1, chain(10, 26.8))
    assert decamer == pytest.approx(DECAMER, abs=6e-6)


@given(
    k=st.floats(1e-3, 3),
    nu=st.floats(0.05, 5),
    elasticity=st.floats(1e-3, 2),
    tau=st.floats(0.1, 300),
)
def test_dimer_is_the_exponential_of_its_matrix(k, nu, elasticity, tau):
    """In both branches: the ranges of k, nu and tau reach across both ends of the oscillation."""
    times = np.array([0, 0.3, 2, 15, 100])
    expected = by_expm(k, times, nu, elasticity, [tau])
    found = transverse_correlation_dimer(k, times, nu, elasticity, tau)
    assert found == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize("off", [0, 1e-12, -1e-12, 1e-8, -1e-8, 1e-3, -1e-3])
def test_dimer_is_smooth_where_the_oscillation_ends(end, off):
    k = dimer_oscillation_range(NU, 0.5, 13.4)[end] * (1 + off)
    expected = by_expm(k, TIMES, NU, 0.5, [13.4])
    assert transverse_correlation_dimer(k, TIMES, NU, 0.5, 13.4) == pytest.approx(
        expected, abs=1e-12
    )
    found = transverse_correlation_chain(k, TIMES, NU, 0.5, [13.4])
    assert found == pytest.approx(expected, abs=1e-10)


def test_range_of_oscillation():
    low, high = dimer_oscillation_range(NU, 0.5, 13.4)
    assert low == pytest.approx(0.0512, abs=5e-5) and high == pytest.approx(1.676, abs=5e-4)
    assert 2 * np.pi / low == pytest.approx(123, abs=0.5)  # the smallest box of (5.1.63)
    for k, complex_pair in ((0.99 * low, 0), (1.01 * low, 2), (0.99 * high, 2), (1.01 * high, 0)):
        poles, _ = transverse_poles(k, NU, 0.5, [13.4])
        assert np.sum(poles.imag != 0) == complex_pair


@pytest.mark.parametrize("springs", [1, 2, 5, 9, 29, 99])
@pytest.mark.parametrize("k", [0.02, K30, 1.0])
def test_chain_is_the_exponential_of_its_matrix(springs, k):
    tau = chain(springs + 1, 26.8)
    found = transverse_correlation_chain(k, TIMES, NU, 1 / (springs + 1), tau)
    assert found == pytest.approx(by_expm(k, TIMES, NU, 1 / (springs + 1), tau), abs=2e-12)


@given(
    tau=st.lists(st.floats(0.05, 200), min_size=1, max_size=40),
    k=st.floats(0.01, 3),
    elasticity=st.floats(1e-3, 3),
)
def test_at_most_one_pair_of_poles_is_complex(tau, k, elasticity):
    tau = np.sort(tau)
    assume(np.all(np.diff(tau) > 1e-4 * tau[1:]))
    poles, _ = transverse_poles(k, NU, elasticity, tau)
    assert len(poles) == len(tau) + 1
    assert np.sum(np.abs(poles.imag) > 1e-9) in (0, 2)
    assert np.all(poles.real < 0)
    # one real pole between neighbouring rates
    real = np.sort(poles[np.abs(poles.imag) <= 1e-9].real)
    for low, high in zip(-1 / tau[:-1], -1 / tau[1:], strict=True):
        assert np.any((real > low - 1e-9) & (real < high + 1e-9))


def test_poles_of_a_chain_of_five_springs():
    """-0.0960 +- 0.1293i and four real ones; the slowest of all, -0.0828, is real."""
    poles, _ = transverse_poles(K30, NU, 1 / 6, chain(6, 26.8))
    pair = poles[poles.imag > 0]
    assert len(pair) == 1
    assert pair[0] == pytest.approx(-0.0960 + 0.1293j, abs=8e-5)
    assert poles[0] == pytest.approx(-0.0828, abs=5e-5)


@pytest.mark.parametrize("modes", [linear_modes(8), ring_modes(9), star_modes(3, 4)])
def test_residues_are_those_of_the_zeros(modes):
    """f(P) = 0 and residue 1/f'(P), also where relaxation times come in groups."""
    tau = rouse_times_from_slowest(modes, stress_time=26.8).stress
    poles, residues = transverse_poles(K30, NU, 0.3, tau)
    c2 = K30**2 * 0.3
    for pole, residue in zip(poles, residues, strict=True):
        terms = pole + 1 / tau
        assert pole + NU * K30**2 + c2 * (1 / terms).sum() == pytest.approx(0, abs=1e-10)
        assert residue == pytest.approx(1 / (1 - c2 * (1 / terms**2).sum()), rel=1e-9)
    assert residues.sum() == pytest.approx(1)
    expected = by_expm(K30, TIMES, NU, 0.3, tau)
    found = transverse_correlation_chain(K30, TIMES, NU, 0.3, tau)
    assert found == pytest.approx(expected, abs=1e-12)


def test_chain_solves_the_generalised_navier_stokes_equation():
    """C' = -nu k^2 C - k^2/rho int G(t - s) C(s) ds, (5.1.7), by quadrature of the known C."""
    tau, k, t = chain(4, 10.0), 0.4, 6.0
    s = np.linspace(0, t, 20_001)
    c = transverse_correlation_chain(k, s, NU, 0.25, tau)
    memory = relaxation_modulus(t - s, 0.25, tau)
    integrand = memory * c
    integral = s[1] * (integrand.sum() - (integrand[0] + integrand[-1]) / 2)
    slope = (3 * c[-1] - 4 * c[-2] + c[-3]) / (2 * s[1])
    assert slope == pytest.approx(-NU * k * k * c[-1] - k * k * integral, abs=1e-7)


def test_limits():
    t = np.array([0.0, 3, 30])
    for tau in ([13.4], chain(10, 26.8)):
        soft = transverse_correlation_chain(K30, t, NU, 1e-12, tau)
        assert soft == pytest.approx(transverse_correlation(K30, t, NU), abs=1e-9)
        # slow flow: the apparent viscosity, far below the range of oscillation
        k, elasticity = 1e-3, 0.1
        late = np.array([1e5, 3e5])
        found = np.log(transverse_correlation_chain(k, late, NU, elasticity, tau))
        rate = (found[0] - found[1]) / 2e5 / k**2
        assert rate == pytest.approx(apparent_viscosity(NU, elasticity, tau), rel=1e-3)
        # fast molecules: the same viscosity at once
        fast = np.asarray(tau) * 1e-6
        found = transverse_correlation_chain(K30, t, NU, 1e5, fast)
        expected = transverse_correlation(K30, t, apparent_viscosity(NU, 1e5, fast))
        assert found == pytest.approx(expected, abs=1e-4)


def test_a_uniform_velocity_stays():
    assert transverse_correlation_dimer(0, TIMES, NU, 0.5, 13.4).tolist() == [1.0] * 5
    assert transverse_correlation_chain(0, TIMES, NU, 0.5, [13.4]).tolist() == [1.0] * 5


def test_arrays_broadcast():
    k = np.array([[0.1], [0.5]])
    for law, tau in (
        (transverse_correlation_dimer, 13.4), (transverse_correlation_chain, chain(3, 9.0))
    ):  # fmt: skip
        found = law(k, TIMES, NU, 0.5, tau)
        assert found.shape == (2, 5)
        assert found[1, 2] == pytest.approx(float(law(0.5, 20.0, NU, 0.5, tau)))


# finite wave numbers


def test_kernel_of_dimers_in_closed_form():
    k, t, b2, d = 0.6, np.array([0.0, 4, 40]), 9.0, 0.03
    q, e = k * k * b2 / 12, np.exp(-t / 26.8)
    expected = np.exp(-q) * np.sinh(q * e) / q * e * np.exp(-k * k * d * t)
    found = gaussian_stress_kernel(k, t, GaussianMolecule(linear_modes(2), 26.8, b2, d))
    assert found == pytest.approx(expected)


@pytest.mark.parametrize("modes", [linear_modes(10), ring_modes(7), star_modes(3, 2)])
def test_kernel_of_long_waves_is_the_relaxation_modulus(modes):
    t = np.array([0.0, 2, 30])
    tau = rouse_times_from_slowest(modes, mode_time=50).stress
    found = gaussian_stress_kernel(1e-3, t, GaussianMolecule(modes, 50, 1.5, 0.01))
    assert found == pytest.approx(relaxation_modulus(t, 1.0, tau), rel=1e-5)


def test_kernel_is_the_stress_of_moving_chains():
    """Chains drawn from equilibrium and moved by the exact step of their modes: the correlation of
    sum_i f_x exp(i k y_i)/(i k). Standard errors 0.008."""
    modes, k, t, mode_time, b2, diffusion = linear_modes(5), 0.5, 6.0, 20.0, 3.0, 0.02
    rng = np.random.default_rng(5)
    n, s2 = 200_000, b2 / 3
    stiff, v = modes.eigenvalues[1:], modes.vectors[:, 1:]
    decay = np.exp(-t * stiff / stiff[0] / mode_time)
    stresses = []
    start = rng.normal(size=(2, n, len(stiff))) * np.sqrt(s2 / stiff)
    noise = rng.normal(size=start.shape) * np.sqrt(s2 / stiff * (1 - decay**2))
    moved = rng.normal(size=(n, 1)) * np.sqrt(2 * diffusion * t)
    for (x, y), centre in ((start, 0.0), (start * decay + noise, moved)):
        force = -(x * stiff) @ v.T / s2  # kT = 1: the spring constant is 1/s2
        stresses.append((force * np.exp(1j * k * (y @ v.T + centre))).sum(axis=1) / (1j * k))
    product = (stresses[1] * stresses[0].conj()).real
    error = product.std() / np.sqrt(n)
    assert error < 0.01
    expected = float(
        gaussian_stress_kernel(k, t, GaussianMolecule(modes, mode_time, b2, diffusion))
    )
    long_wave = float(relaxation_modulus(t, 1.0, chain(5, 10.0)))
    assert product.mean() == pytest.approx(expected, abs=4 * error)
    assert abs(expected - long_wave) > 8 * error  # so that the test can tell them apart


def test_finite_k_of_dimers():
    """The closed form leaves out q^2/6 of the kernel; without both terms it is the thesis."""
    t = np.linspace(0, 60, 25)
    closed = transverse_correlation_dimer(K30, t, NU, 0.5, 13.4, 9.0, 0.03)
    full = transverse_correlation_finite_k(
        K30, t, NU, 0.5, GaussianMolecule(linear_modes(2), 26.8, 9.0, 0.03)
    )
    thesis = transverse_correlation_dimer(K30, t, NU, 0.5, 13.4)
    assert np.max(np.abs(closed - full)) < 2e-4
    assert 0.01 < np.max(np.abs(closed - thesis)) < 0.03
    c2 = 0.5 * np.exp(-(K30**2) * 9 / 12)
    shifted = 1 / (1 / 13.4 + K30**2 * 0.03)
    flat = transverse_correlation_dimer(K30, t, NU, 0.5, 13.4, 6.0, 0.03, dimension=2)
    assert flat == pytest.approx(closed, abs=1e-12)  # the same <b_y^2>
    assert closed == pytest.approx(by_expm(K30, t, NU, c2, [shifted]), abs=1e-12)


@pytest.mark.parametrize("modes", [linear_modes(10), ring_modes(6)])
def test_finite_k_of_long_waves_is_that_of_poles(modes):
    k, t = 2e-3, np.linspace(0, 3e4, 20)
    tau = rouse_times_from_slowest(modes, mode_time=5000).stress
    poles = transverse_correlation_chain(k, t, NU, 0.1, tau)
    full = transverse_correlation_finite_k(k, t, NU, 0.1, GaussianMolecule(modes, 5000, 1.5))
    assert full == pytest.approx(poles, abs=2e-4)


def test_finite_k_does_not_depend_on_its_steps():
    t = np.linspace(0, 80, 30)
    chain = GaussianMolecule(linear_modes(10), 89.0, 1.5, 0.006)
    arguments = (2 * np.pi / 24, t, NU, 0.1, chain)
    coarse, fine = (transverse_correlation_finite_k(*arguments, steps=n) for n in (250, 1000))
    assert coarse == pytest.approx(fine, abs=1e-5)
    trimer = GaussianMolecule(linear_modes(3), 9.0, 1.0)
    assert transverse_correlation_finite_k(0.2, 0.0, NU, 0.1, trimer) == 1


def test_refuses():
    with pytest.raises(ValueError, match="stress_time = 0"):
        transverse_correlation_dimer(0.1, 1.0, NU, 0.5, 0)
    with pytest.raises(ValueError, match="bond_squared = -1"):
        transverse_correlation_dimer(0.1, 1.0, NU, 0.5, 13.4, -1)
    with pytest.raises(ValueError, match="time = -1"):
        transverse_correlation_chain(0.1, -1, NU, 0.5, [13.4])
    with pytest.raises(ValueError, match="elasticity = 0"):
        transverse_poles(0.1, NU, 0, [13.4])
    with pytest.raises(ValueError, match="mode_time = 0"):
        gaussian_stress_kernel(0.1, 1.0, GaussianMolecule(linear_modes(2), 0, 9))
    with pytest.raises(ValueError, match="steps = 3"):
        transverse_correlation_finite_k(
            0.1, 1.0, NU, 0.5, GaussianMolecule(linear_modes(2), 9, 9), steps=3
        )
