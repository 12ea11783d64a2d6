"""Normal modes of chains, rings and stars, and the sizes and bonds that follow from them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from mesokit.theory import (
    linear_modes,
    mean_square_bond,
    mean_square_end_to_end,
    mean_square_gyration,
    pulled_shape,
    ring_modes,
    spring,
    spring_of_bond,
    star_modes,
)


def connectivity(bonds, beads):
    matrix = np.zeros((beads, beads))
    for a, b in bonds:
        matrix[[a, b], [a, b]] += 1
        matrix[[a, b], [b, a]] -= 1
    return matrix


def line(n):
    return [(i, i + 1) for i in range(n - 1)]


def star(arms, n):
    return [(0 if i == 0 else a * n + i, a * n + i + 1) for a in range(arms) for i in range(n)]


MOLECULES = [
    *((linear_modes(n), line(n)) for n in (2, 3, 10, 101)),
    *((ring_modes(n), [*line(n), (n - 1, 0)]) for n in (3, 4, 9, 100)),
    *((star_modes(f, n), star(f, n)) for f, n in ((1, 4), (2, 3), (3, 1), (4, 7), (6, 20))),
]


@pytest.mark.parametrize(("modes", "bonds"), MOLECULES)
def test_modes_diagonalise_the_connectivity(modes, bonds):
    n = len(modes.eigenvalues)
    v = modes.vectors
    assert v.T @ v == pytest.approx(np.eye(n), abs=1e-12)
    rebuilt = (v * modes.eigenvalues) @ v.T
    assert rebuilt == pytest.approx(connectivity(bonds, n), abs=1e-12)
    assert modes.eigenvalues[0] == 0
    assert np.all(np.diff(modes.eigenvalues) > -1e-12)
    assert v[:, 0] == pytest.approx(np.full(n, v[0, 0]))  # the centre of mass


@pytest.mark.parametrize(("arms", "n"), [(3, 2), (4, 7), (5, 10)])
def test_star_has_the_eigenvalues_of_zimm_and_kilb(arms, n):
    found = star_modes(arms, n).eigenvalues
    odd = 4 * np.sin((2 * np.arange(1, n + 1) - 1) * np.pi / (4 * n + 2)) ** 2
    for value in odd:
        assert np.sum(np.abs(found - value) < 1e-10) == arms - 1
    even = [x for x in found[1:] if np.min(np.abs(odd - x)) > 1e-10]
    assert len(even) == n
    for value in even:
        x = 2 * np.arcsin(np.sqrt(complex(value)) / 2)  # complex above 4: the mode of the middle
        assert np.sin((n + 1) * x) == pytest.approx(-(arms - 1) * np.sin(n * x), rel=1e-8)


@given(n=st.integers(3, 60))
def test_gyration_in_closed_form(n):
    assert mean_square_gyration(linear_modes(n), 2.0) == pytest.approx((n**2 - 1) / (3 * n))
    assert mean_square_gyration(ring_modes(n), 2.0) == pytest.approx((n**2 - 1) / (6 * n))


@given(arms=st.integers(1, 8), n=st.integers(1, 10))
@settings(max_examples=30)
def test_gyration_of_stars_is_the_theorem_of_kramers(arms, n):
    beads = 1 + arms * n
    cut = arms * sum(i * (beads - i) for i in range(1, n + 1))
    assert mean_square_gyration(star_modes(arms, n), 1.0) == pytest.approx(cut / beads**2)


def test_gyration_of_a_large_star_is_that_of_zimm_and_stockmayer():
    """(3 f - 2)/f^2 of that of the linear chain with as many bonds."""
    ratio = mean_square_gyration(star_modes(4, 75), 1.0)
    ratio /= mean_square_gyration(linear_modes(301), 1.0)
    assert ratio == pytest.approx(10 / 16, rel=7e-3)  # next order 1/n


def test_end_to_end_from_the_modes():
    m = linear_modes(12)
    ends = m.vectors[-1, 1:] - m.vectors[0, 1:]
    assert mean_square_end_to_end(12, 1.5) == pytest.approx(
        1.5 * (ends**2 / m.eigenvalues[1:]).sum()
    )


@given(
    k=st.floats(0.1, 200),
    rest=st.floats(0, 3),
    d=st.sampled_from([1, 2, 3]),
    kT=st.floats(0.2, 3),
)
@settings(max_examples=50)
def test_bond_is_the_mean_of_the_boltzmann_weight(k, rest, d, kT):
    def moment(n):
        width = np.sqrt(kT / k)
        ends = [max(rest - 10 * width, 0), rest, rest + 12 * width]
        return quad(
            lambda r: r ** (n + d - 1) * np.exp(-k * (r - rest) ** 2 / (2 * kT)),
            ends[0],
            ends[2],
            points=ends[1:2],
            epsabs=0,
            limit=200,
        )[0]

    expected = moment(2) / moment(0)
    assert mean_square_bond(k=k, rest_length=rest, dimension=d, kT=kT) == pytest.approx(expected)


def test_both_conventions_of_the_spring():
    assert mean_square_bond(K=1.0) == pytest.approx(1.5)  # simulated decamers: 1.499
    assert mean_square_bond(K=1 / 6) == pytest.approx(9)  # simulated dimers: 9.01
    assert mean_square_bond(k=1 / 3, dimension=2) == pytest.approx(6)
    assert spring(K=1 / 6) == pytest.approx(spring(k=1 / 3))
    assert spring_of_bond(3) == pytest.approx((1 / 6, 1 / 3))


def test_refuses():
    for arguments in ({}, {"K": 1, "k": 2}):
        with pytest.raises(ValueError, match=r"expected one, of U = K r\^2"):
            spring(**arguments)
    with pytest.raises(ValueError, match="k = 0"):
        spring(k=0)
    with pytest.raises(ValueError, match="rest_length = 1"):
        mean_square_bond(K=1, rest_length=1)
    with pytest.raises(ValueError, match="beads = 2"):
        ring_modes(2)
    with pytest.raises(ValueError, match="arm_beads = 0"):
        star_modes(3, 0)
    with pytest.raises(ValueError, match=r"beads = 2\.5"):
        linear_modes(2.5)


@pytest.mark.parametrize(("modes", "bonds"), MOLECULES)
def test_forces_pull_beads_to_where_the_springs_balance_them(modes, bonds):
    n = len(modes.eigenvalues)
    forces = np.random.default_rng(n).standard_normal((n, 3))
    forces -= forces.mean(axis=0)
    r = pulled_shape(modes, forces, K=0.7)
    np.testing.assert_allclose(1.4 * connectivity(bonds, n) @ r, forces, atol=1e-9)
    np.testing.assert_allclose(r.sum(axis=0), 0, atol=1e-7)
    with pytest.raises(ValueError, match="sum of 0"):
        pulled_shape(modes, forces + 0.1, K=0.7)
    with pytest.raises(ValueError, match="expected shape"):
        pulled_shape(modes, forces[1:], K=0.7)
