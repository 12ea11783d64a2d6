"""Order of birds with vectorial noise that all see one another."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from mesokit.theory import vectorial_order


def along(phi, strength, cosine):
    """The part along m of the unit vector along m + eta xi."""
    return (phi + strength * cosine) / np.sqrt(phi**2 + strength**2 + 2 * phi * strength * cosine)


@pytest.mark.parametrize("strength", [0.1, 0.3, 0.5, 0.65])
def test_in_space_it_is_the_root_of_a_cubic(strength):
    phi = vectorial_order(strength, 1000, 3).many
    roots = np.roots([1, -1, 0, strength**2 / 3])
    assert phi == pytest.approx(max(roots.real), rel=1e-9)
    assert phi > 2 / 3 > strength > sorted(roots.real)[1]  # no other branch: g differs below eta


@pytest.mark.parametrize("strength", [0.1, 0.3, 0.5])
def test_in_the_plane_it_is_a_fixed_point(strength):
    phi = vectorial_order(strength, 1000, 2).many
    mean = quad(lambda a: along(phi, strength, math.cos(a)), 0, math.pi)[0] / math.pi
    assert phi == pytest.approx(mean, rel=1e-9)


def test_where_it_ends():
    assert vectorial_order(0.66, 10**9, 3).many > 2 / 3
    assert vectorial_order(0.67, 10**9, 3).many == 0
    assert math.isnan(vectorial_order(0.671, 10**9, 2).many)
    assert vectorial_order(0.672, 10**9, 2).many == 0
    assert math.isnan(vectorial_order(0.501, 10**9, 2).many)
    assert vectorial_order(0.0, 7, 2) == (1, 1, 1)


def test_few_birds_near_the_threshold_are_not_known():
    many, mean, square = vectorial_order(0.66, 20, 3)
    assert many == pytest.approx(0.7203, abs=1e-3)
    assert math.isnan(mean)
    assert math.isnan(square)
    assert math.isnan(vectorial_order(0.7, 400, 3).mean)


@pytest.mark.parametrize(("strength", "dimension"), [(0.4, 2), (0.5, 3), (0.9, 2), (0.95, 3)])
def test_fifty_birds(strength, dimension):
    """Another program: the recursion itself."""
    number, steps, runs = 50, 400, 40
    rng = np.random.default_rng(4)
    m, squares = np.zeros((runs, dimension)), []
    m[:, 0] = 1.0
    for step in range(steps):
        xi = rng.normal(size=(runs, number, dimension))
        u = m[:, None] + strength * xi / np.linalg.norm(xi, axis=2, keepdims=True)
        m = (u / np.linalg.norm(u, axis=2, keepdims=True)).mean(axis=1)
        if step >= 50:
            squares.append((m**2).sum(axis=1))
    orders = np.sqrt(squares)
    known = vectorial_order(strength, number, dimension)
    for found, expected in ((orders, known.mean), (orders**2, known.mean_square)):
        each = found.mean(axis=0)
        error = each.std(ddof=1) / math.sqrt(runs)
        assert abs(each.mean() - expected) < 4 * error + 3e-4 * expected
        assert error < 0.03 * expected


@pytest.mark.parametrize("wrong", [(1.5, 10, 2), (-0.1, 10, 2), (0.5, 0, 2), (0.5, 10, 4)])
def test_what_is_refused(wrong):
    with pytest.raises(ValueError, match=r"must be|expected"):
        vectorial_order(*wrong)
