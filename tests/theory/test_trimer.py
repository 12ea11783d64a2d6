"""Bond length of trimers in shear flow, and the spring constant that gives it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import solve_continuous_lyapunov

from mesokit.theory import trimer_bond_length, trimer_spring_constant
from mesokit.theory.trimer import SHORTEST

FLUID = {"viscosity": 8.7, "hydrodynamic_radius": 0.3}
root2 = np.sqrt(2)


def mobilities(length, eta, radius):
    return 1 / (6 * np.pi * eta * radius), 1 / (eta * length * np.sqrt(6 * np.pi**3))


@pytest.mark.parametrize(
    ("rate", "printed"),
    [
        (0, 0.375000), (0.001, 0.375209), (0.01, 0.393993), (0.03, 0.486920), (0.1, 0.816861),
        (0.3, 1.521401), (1, 3.219497), (10, 14.465371), (100, 66.682254),
    ],
)  # fmt: skip
def test_spring_constants_of_figure_6_1(rate, printed):
    assert trimer_spring_constant(2, rate, **FLUID) == pytest.approx(printed, abs=6e-7)


@pytest.mark.parametrize(
    ("rate", "printed", "digits"),
    [
        (0, 1.224745, 6), (0.001, 1.224807, 6), (0.01, 1.230913, 6), (0.03, 1.277844, 6),
        (0.1, 1.665299, 6), (0.3, 3.275869, 6), (1, 9.553401, 6), (10, 91.991, 3),
    ],
)  # fmt: skip
def test_bond_lengths_of_figure_6_2(rate, printed, digits):
    assert trimer_bond_length(1, rate, **FLUID) == pytest.approx(printed, abs=0.6 * 10**-digits)


@pytest.mark.parametrize("rate", [0.0, 0.05, 2.0])
@pytest.mark.parametrize("radius", [0.1, 0.5, 1.1])
def test_against_the_covariance_of_the_equations_of_motion(rate, radius):
    """Bonds R' = G R - B H B^T 2 K R + noise: their covariance, by a Lyapunov equation."""
    length, eta, kT = 2.0, 8.7, 1.4
    K = trimer_spring_constant(length, rate, eta, radius, kT)
    a, b = mobilities(length, eta, radius)
    H = np.array([[a, b, b / root2], [b, a, b], [b / root2, b, a]])
    bonds = np.array([[-1.0, 1, 0], [0, -1, 1]])
    mobility = np.kron(bonds @ H @ bonds.T, np.eye(3))
    shear = np.zeros((3, 3))
    shear[0, 1] = rate
    drift = np.kron(np.eye(2), shear) - 2 * K * mobility
    covariance = solve_continuous_lyapunov(drift, -2 * kT * mobility)
    assert np.trace(covariance[:3, :3]) == pytest.approx(length**2, rel=1e-9)
    assert np.trace(covariance[3:, 3:]) == pytest.approx(length**2, rel=1e-9)


@pytest.mark.parametrize("rate", [0.0, 0.1, 5.0])
def test_against_the_thesis(rate):
    """(6.41) with the determinant (6.34), the noise (6.36), a and b (6.9), (6.10)."""
    length = 2.0
    K = trimer_spring_constant(length, rate, **FLUID)
    A, B = mobilities(length, 8.7, 0.3)
    a, b = 4 * K * (B - A), K * (2 * A + (root2 - 4) * B)
    det = A**3 + root2 * B**3 - 2.5 * A * B**2
    own = 2 * A**4 - 2 * A**3 * B - 5 * A**2 * B**2 + (5 + 2 * root2) * A * B**3 - 2 * root2 * B**4
    cross = -(A**4) + (2 - 1 / root2) * A**3 * B + 2.5 * A**2 * B**2
    cross += (root2 - 20) / 4 * A * B**3 + (2 * root2 - 1) * B**4
    rest = 3 * (a * own - b * cross) / (b**2 - a**2)
    flow = own * (a**3 + 3 * a * b**2) - cross * (3 * a**2 * b + b**3)
    squared = (rest + rate**2 * flow / (2 * (b**2 - a**2) ** 3)) / det
    assert squared == pytest.approx(length**2, rel=1e-9)


@given(
    K=st.floats(0.05, 5),
    rate=st.floats(-20, 20),
    radius=st.floats(0.02, 0.35),
    eta=st.floats(0.5, 30),
)
def test_one_is_the_inverse_of_the_other(K, rate, radius, eta):
    length = trimer_bond_length(K, rate, eta, radius, kT=1.5)
    assert trimer_spring_constant(length, rate, eta, radius, kT=1.5) == pytest.approx(K, rel=1e-8)


def test_limits():
    assert trimer_bond_length(0.7, 0, 8.7, 0.1) == pytest.approx(np.sqrt(3 / (2 * 0.7)))
    rate = 1e5
    expected = 6 * np.pi * 8.7 * 0.3 * rate * np.sqrt(5 / 144)
    assert trimer_bond_length(1, rate, **FLUID) == pytest.approx(expected, rel=1e-4)
    ratio = trimer_spring_constant(2, 1e6, **FLUID) / 1e6 ** (2 / 3)
    assert ratio == pytest.approx(3.0893, rel=1e-4)


def test_shortest_bond_is_where_the_mobility_ceases_to_be_positive():
    a, b = mobilities(SHORTEST, 1.0, 1.0)
    assert a / b == pytest.approx(1.1042, abs=5e-5)
    H = np.array([[a, b, b / root2], [b, a, b], [b / root2, b, a]])
    assert np.linalg.eigvalsh(H)[0] == pytest.approx(0, abs=1e-12)
    assert pytest.approx(1.526, abs=5e-4) == SHORTEST


def test_refuses_bonds_too_short_for_their_beads():
    with pytest.raises(ValueError, match=r"bond_length = 0\.45: expected more than 1\.526"):
        trimer_spring_constant(0.45, 0.1, **FLUID)
    with pytest.raises(ValueError, match=r"spring_constant = 10: bonds would be shorter"):
        trimer_bond_length(10, 0.0, **FLUID)
    with pytest.raises(ValueError, match="shear_rate = nan"):
        trimer_bond_length(1, np.nan, **FLUID)
    with pytest.raises(ValueError, match="viscosity = 0"):
        trimer_spring_constant(2, 0.1, 0, 0.3)
