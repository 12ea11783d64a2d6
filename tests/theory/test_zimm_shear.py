"""Short chains in shear with hydrodynamic interaction."""

import math

import numpy as np
import pytest

from mesokit import theory

ETA = 8.7


@pytest.mark.parametrize("rate", [0.0, 0.03, -0.3, 10.0])
@pytest.mark.parametrize("K", [0.2, 1.0])
def test_three_beads_are_the_trimer_of_the_closed_form(rate, K):
    radius = 0.12
    chain = theory.zimm_shear(3, rate, K, 6 * math.pi * ETA * radius, ETA)
    wanted = theory.trimer_bond_length(K, abs(rate), ETA, radius)
    assert math.sqrt(chain.bond_squared) == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("beads", [2, 3, 6])
def test_at_rest_it_has_the_times_of_zimm(beads):
    chain = theory.zimm_shear(beads, 0.0, 0.5, 18.0, ETA)
    assert chain.bond_squared == pytest.approx(3.0)
    wanted = theory.zimm_times(beads, 18.0, ETA, math.sqrt(3.0))
    assert chain.times.mode == pytest.approx(wanted.mode)
    assert chain.times.stress == pytest.approx(wanted.stress)


@pytest.mark.parametrize("beads", [2, 3, 6])
def test_in_a_fluid_that_carries_nothing_on_it_is_rouse(beads):
    modes = theory.linear_modes(beads)
    rouse = theory.rouse_times(modes, 18.0, K=0.5)
    chain = theory.zimm_shear(beads, 0.1, 0.5, 18.0, viscosity=1e9)
    assert chain.times.stress == pytest.approx(rouse.stress, rel=1e-6)
    wanted = theory.size_in_shear(modes, 0.1, rouse.stress[0], 3.0).bond
    assert chain.bond_squared == pytest.approx(wanted, rel=1e-6)


def test_bonds_by_their_equation_of_motion():
    """Steady covariance of dR/dt = G R - 2 K M R + noise, from Lyapunov's equation."""
    from scipy.linalg import solve_continuous_lyapunov

    K, rate, friction = 0.5, 0.1, 18.0
    chain = theory.zimm_shear(4, rate, K, friction, ETA)
    length = math.sqrt(chain.bond_squared)
    apart = np.abs(np.subtract.outer(np.arange(4), np.arange(4)))
    other = 1 / (ETA * length * np.sqrt(6 * math.pi**3 * np.maximum(apart, 1)))
    bonds = np.diff(np.eye(4), axis=0)
    M = bonds @ np.where(apart == 0, 1 / friction, other) @ bonds.T
    G = np.zeros((3, 3))
    G[0, 1] = rate
    drift = np.kron(np.eye(3), G) - 2 * K * np.kron(M, np.eye(3))
    covariance = solve_continuous_lyapunov(drift, -2 * np.kron(M, np.eye(3)))
    assert np.trace(covariance) / 3 == pytest.approx(chain.bond_squared, rel=1e-9)
    # the stress of the bonds, 2 K <R_x R_y> of each molecule, against that of the times
    carried = 2 * K * sum(covariance[3 * i, 3 * i + 1] for i in range(3))
    stress = theory.maxwell_shear(rate, 1.0, chain.times.stress)
    assert carried == pytest.approx(rate * stress.viscosity, rel=1e-9)


def test_springs_too_stiff_for_their_beads_are_refused():
    with pytest.raises(ValueError, match="the mobility matrix is not positive"):
        theory.zimm_shear(3, 0.1, 100.0, 6 * math.pi * ETA * 0.3, ETA)
