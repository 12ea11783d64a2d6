"""Diffusion and relaxation of chains with hydrodynamics; boxes; bonds of Kremer and Grest."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import erfc

from mesokit.theory import (
    chain_exponents,
    diffusion_in_box,
    kirkwood_diffusion,
    kirkwood_in_cells,
    kremer_grest_bond,
    linear_modes,
    rouse_diffusion,
    rouse_times,
    spring_of_bond,
    trimer_spring_constant,
    zimm_diffusion,
    zimm_times,
)
from mesokit.theory.finite_size import CUBIC

ETA = 8.7
DRAINING = 6 * np.pi * ETA * 1e-6  # friction of beads that drag no fluid along


def test_diffusion_without_hydrodynamics_is_that_of_rouse():
    found = kirkwood_diffusion(20, DRAINING, ETA, 1.0)
    assert found == pytest.approx(rouse_diffusion(20, DRAINING), rel=1e-4)
    assert rouse_diffusion(20, 4.0, kT=2) == 2 / 80


@given(n=st.integers(2, 30), b=st.floats(0.5, 4), zeta=st.floats(1, 100))
def test_kirkwood_is_the_mean_of_the_mobility_over_gaussian_distances(n, b, zeta):
    inverse = 0.0  # sum of <1/r>, sqrt(6/(pi n)) b^-1 of a Gaussian of mean square n b^2
    for i in range(n):
        for j in range(n):
            if i != j:
                inverse += np.sqrt(6 / (np.pi * abs(i - j))) / b
    expected = 1 / (n * zeta) + inverse / (6 * np.pi * ETA * n**2)
    assert kirkwood_diffusion(n, zeta, ETA, b) == pytest.approx(expected)


def test_in_cells_distances_are_smeared():
    """<1/r> of Gaussian distances to which the places of two cells are added, drawn."""
    rng = np.random.default_rng(1)
    n, b, zeta, inverse = 3, 0.8, 50.0, 0.0
    for i in range(n):
        for j in range(n):
            spread = np.sqrt(abs(i - j) * b**2 / 3 + 1 / 3)
            inverse += (1 / np.linalg.norm(rng.normal(0, spread, (100_000, 3)), axis=1)).mean()
    expected = 1 / (n * zeta) + inverse / (6 * np.pi * ETA * n**2)
    assert kirkwood_in_cells(n, zeta, ETA, b) == pytest.approx(expected, rel=5e-3)
    long = kirkwood_in_cells(10**4, zeta, ETA, b) / kirkwood_diffusion(10**4, zeta, ETA, b)
    assert 0.97 < long < 1.0


def test_zimm_is_the_limit_of_long_chains():
    zeta = 6 * np.pi * ETA * 0.1
    gap = [1 - zimm_diffusion(n, ETA, 1.0) / kirkwood_diffusion(n, zeta, ETA, 1.0)
           for n in (60, 10**4, 10**6)]  # fmt: skip
    assert gap[0] == pytest.approx(0.17, abs=0.01)
    assert gap[2] < 2e-3
    assert gap[1] / gap[2] == pytest.approx(10, rel=0.05)  # it falls with 1/sqrt n


def test_zimm_times_of_trimers_are_the_rates_of_their_bonds():
    """a + b and a - b of the trimer law, which has the same mobilities."""
    radius, length = 0.3, 2.0
    zeta = 6 * np.pi * ETA * radius
    K = trimer_spring_constant(length, 0.0, ETA, radius)
    A, B = 1 / zeta, 1 / (ETA * length * np.sqrt(6 * np.pi**3))
    a, b = 4 * K * (B - A), K * (2 * A + (np.sqrt(2) - 4) * B)
    expected = np.sort([-1 / (a + b), -1 / (a - b)])[::-1]
    assert zimm_times(3, zeta, ETA, length).mode == pytest.approx(expected)


def test_zimm_times_without_hydrodynamics_are_those_of_rouse():
    found = zimm_times(15, DRAINING, ETA, 1.3)
    k = spring_of_bond(1.3).k
    assert found.mode == pytest.approx(rouse_times(linear_modes(15), DRAINING, k=k).mode, rel=1e-4)
    assert found.stress == pytest.approx(found.mode / 2)


def test_zimm_times_of_long_chains():
    """Each mode by itself, p large: Doi and Edwards' eta b^3 (n/p)^(3/2)/sqrt(3 pi)."""
    n, p, zeta = 600, 20, 6 * np.pi * ETA * 0.25
    unit = ETA * n**1.5
    modes = linear_modes(n)
    v = modes.vectors[:, p]
    apart = np.abs(np.subtract.outer(np.arange(n), np.arange(n))) + np.eye(n)
    H = 1 / (ETA * np.sqrt(6 * np.pi**3 * apart))
    np.fill_diagonal(H, 1 / zeta)
    alone = 1 / (3 * modes.eigenvalues[p] * (v @ H @ v))
    assert alone * p**1.5 / unit == pytest.approx(1 / np.sqrt(3 * np.pi), rel=0.05)
    mode = zimm_times(n, zeta, ETA, 1.0).mode
    assert mode[p - 1] == pytest.approx(alone, rel=0.05)
    # mode 1 is slower than that: 0.4016, to which shorter chains tend
    assert mode[0] / unit == pytest.approx(0.4016, abs=2e-4)
    assert zimm_times(100, zeta, ETA, 1.0).mode[0] / 1000 / ETA == pytest.approx(0.4016, rel=2e-3)


def test_zimm_times_give_the_intrinsic_viscosity_of_long_chains():
    """Flory's constant, sum of stress times kT/(eta <R^2>^(3/2)) times Avogadro's number, is
    2.87e23 for pre-averaged hydrodynamics (Miyaki et al., Macromolecules 13, 588, 1980)."""
    zeta = 6 * np.pi * ETA * 0.25
    n = np.array([100, 400])
    flory = [zimm_times(i, zeta, ETA, 1.0).stress.sum() / ETA / i**1.5 for i in n]
    limit = 2 * flory[1] - flory[0]  # the next order is n^(-1/2)
    assert 6.022 * limit == pytest.approx(2.87, rel=0.01)


def test_dimers_of_the_thesis_without_a_fit():
    """Mode time 26.8 (published) and 27.2 (simulated again) for beads of D = 0.0587, K = 1/6."""
    assert zimm_times(2, 1 / 0.0587, 8.7, 3.0).mode == pytest.approx([26.8], abs=0.05)
    assert rouse_times(linear_modes(2), 1 / 0.0587, K=1 / 6).mode == pytest.approx(
        [25.55], abs=0.01
    )


def test_exponents_are_those_of_the_laws():
    zeta = 6 * np.pi * ETA * 0.25
    n = np.array([200, 400])
    zimm, rouse = chain_exponents("zimm"), chain_exponents("rouse")

    def slope(values):
        return np.log(values[1] / values[0]) / np.log(2)

    assert slope([zimm_diffusion(i, ETA, 1) for i in n]) == pytest.approx(zimm.diffusion)
    assert slope([kirkwood_diffusion(i, zeta, ETA, 1) for i in n]) == pytest.approx(-0.5, abs=0.01)
    slowest = [zimm_times(i, zeta, ETA, 1).mode[0] for i in n]
    assert slope(slowest) == pytest.approx(zimm.relaxation, abs=0.01)
    slowest = [rouse_times(linear_modes(i), zeta, k=3).mode[0] for i in n]
    assert slope(slowest) == pytest.approx(rouse.relaxation, abs=0.01)
    assert slope([rouse_diffusion(i, zeta) for i in n]) == pytest.approx(rouse.diffusion)


def test_exponents_of_real_chains():
    assert chain_exponents("rouse", "good", 2) == (0.75, -1, 2.5)
    assert chain_exponents("zimm", "theta") == (0.5, -0.5, 1.5)


def test_constant_of_the_box_by_ewald_summation():
    """Potential of a unit charge's images and background at its place, cubic lattice of side 1."""
    width = 2.0  # any: the result does not depend on it
    n = np.array(np.meshgrid(*[np.arange(-6, 7)] * 3)).reshape(3, -1)
    r = np.sqrt((n**2).sum(axis=0))
    r = r[r > 0]
    k2 = (2 * np.pi * r) ** 2
    potential = (erfc(width * r) / r).sum() + (4 * np.pi / k2 * np.exp(-k2 / (4 * width**2))).sum()
    potential -= np.pi / width**2 + 2 * width / np.sqrt(np.pi)
    assert potential == pytest.approx(-CUBIC, abs=1e-6)


def test_diffusion_in_larger_boxes_tends_to_that_without():
    found = [diffusion_in_box(0.0587, side, ETA, kT=2) for side in (10, 20, 1e9)]
    assert found[0] < found[1] < found[2]
    assert 0.0587 - found[0] == pytest.approx(2 * (0.0587 - found[1]))
    assert 0.0587 - found[1] == pytest.approx(2 * 2.837297 / (6 * np.pi * ETA * 20))
    assert found[2] == pytest.approx(0.0587)


@pytest.mark.parametrize(
    ("dimension", "mean", "root_mean_square"), [(3, 0.97012, 0.97069), (2, 0.96898, 0.96955)]
)
def test_kremer_grest_bond(dimension, mean, root_mean_square):
    found = kremer_grest_bond(dimension)
    assert found == pytest.approx((0.96090, mean, root_mean_square), abs=6e-6)


def test_cold_kremer_grest_bonds_are_at_the_minimum():
    found = kremer_grest_bond(kT=1e-5)
    assert found.mean == pytest.approx(found.minimum, abs=1e-5)
    # variance kT over the curvature of the minimum
    variance = found.root_mean_square**2 - found.mean**2
    r, h = found.minimum, 1e-4

    def energy(r):
        return 4 * (r**-12 - r**-6) - 33.75 * np.log(1 - (r / 1.5) ** 2)

    curvature = (energy(r + h) - 2 * energy(r) + energy(r - h)) / h**2
    assert variance == pytest.approx(1e-5 / curvature, rel=1e-3)


def test_kremer_grest_bond_in_other_units():
    found = kremer_grest_bond(k=30 / 4 * 3, longest=3, epsilon=3, sigma=2, kT=3)
    assert found == pytest.approx([2 * x for x in kremer_grest_bond()])


def test_weak_fene_bonds_reach_beyond_the_repulsion():
    """Soft spring: the mean lies beyond 2^(1/6), where only FENE acts."""
    r = np.linspace(1e-3, 10 - 1e-6, 400_001)
    inverse = r**-6.0
    u = np.where(inverse > 0.5, 4 * (inverse**2 - inverse) + 1, 0) - 5 * np.log(1 - (r / 10) ** 2)
    weight = r**2 * np.exp(-u)
    found = kremer_grest_bond(k=0.1, longest=10)
    assert found.mean == pytest.approx((r * weight).sum() / weight.sum(), rel=1e-6)


def test_refuses():
    with pytest.raises(ValueError, match="mobility matrix is not positive"):
        zimm_times(5, 6 * np.pi * ETA, ETA, 1.0)
    with pytest.raises(ValueError, match="dimension = 2"):
        chain_exponents("zimm", dimension=2)
    with pytest.raises(ValueError, match="dynamics = 'reptation'"):
        chain_exponents("reptation")
    with pytest.raises(ValueError, match="box_length = 0"):
        diffusion_in_box(1, 0, 1)
    with pytest.raises(ValueError, match="dimension = 1"):
        kremer_grest_bond(1)
    with pytest.raises(ValueError, match="beads = 0"):
        rouse_diffusion(0, 1)
