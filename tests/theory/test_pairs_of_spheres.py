"""Two spheres: the exact solution in line, and the sum over waves that defines the periodic one."""

import math

import numpy as np
import pytest

from mesokit.theory import pair_speeds, pair_speeds_in_cube, rotne_prager_in_cube


def stimson_jeffery(distance):
    """Speed in line of two spheres of radius 1, exactly (Proc. R. Soc. A 111, 110, 1926)."""
    a = math.acosh(distance / 2)
    n = np.arange(1, 60)
    m = 2 * n + 1
    above = 4 * np.sinh((n + 0.5) * a) ** 2 - m**2 * np.sinh(a) ** 2
    bracket = 1 - above / (2 * np.sinh(m * a) + m * np.sinh(2 * a))
    return 1 / (4 / 3 * math.sinh(a) * (n * (n + 1) / ((2 * n - 1) * (2 * n + 3)) * bracket).sum())


@pytest.mark.parametrize(
    ("distance", "within"), [(2.5, 5e-3), (3.0, 6e-4), (4.0, 3e-5), (6.0, 5e-6)]
)
def test_in_line(distance, within):
    found = pair_speeds(1.7, 1.7 * distance).in_line
    assert found == pytest.approx(stimson_jeffery(distance), rel=within)


def test_side_by_side():
    """The point force and its dipole: (1 + R^2/6 Laplacian)^2 of Oseen's tensor; then 17/16."""
    assert pair_speeds(1.0, 5.0).side_by_side == pytest.approx(1.154 - 17 / 16 / 5**6)
    assert pair_speeds(2.0, 8.0).side_by_side == pytest.approx(pair_speeds(1.0, 4.0).side_by_side)


@pytest.mark.parametrize("radius", [0.01, 0.1, 0.2])
def test_one_sphere_in_a_cube_is_hasimoto_s(radius):
    own = rotne_prager_in_cube(np.zeros(3), 3 * radius, 3.0)
    three_terms = 1 - 2.8372974795 * radius + 4 / 3 * math.pi * radius**3
    assert own == pytest.approx(three_terms * np.eye(3), abs=1e-10)


@pytest.mark.parametrize("separation", [(0.0, 0.0, 0.0), (0.3, 0.1, 0.2), (0.5, 0.0, 0.0)])
def test_it_is_the_sum_over_waves(separation):
    """Waves damped by exp(-w k^2) shift it by a term in w: two w give none of it."""
    radius, n = 0.12, 22
    axis = np.arange(-n, n + 1)
    k = 2 * np.pi * np.stack(np.meshgrid(axis, axis, axis), -1).reshape(-1, 3)
    k = k[k.any(axis=1)]
    square = (k**2).sum(1)
    factor = 6 * math.pi * radius * np.sinc(np.sqrt(square) * radius / np.pi) ** 2
    factor *= np.cos(k @ separation) / square
    sums = []
    for w in (0.0004, 0.0008):
        size = factor * np.exp(-w * square)
        sums.append(np.eye(3) * size.sum() - np.einsum("n,ni,nj->ij", size / square, k, k))
    found = rotne_prager_in_cube(separation, radius, 1.0)
    if any(separation):
        assert found == pytest.approx(2 * sums[0] - sums[1], abs=1e-5)
    else:  # shells that lie on each other: a term in the root of w
        root = math.sqrt(2)
        assert found == pytest.approx((root * sums[0] - sums[1]) / (root - 1), abs=2e-3)


def test_images_are_the_same():
    r = np.array([0.3, 0.1, 0.45]) * 7
    near = rotne_prager_in_cube(r, 0.5, 7.0)
    assert rotne_prager_in_cube(r + [7, -14, 0], 0.5, 7.0) == pytest.approx(near)
    assert rotne_prager_in_cube(-r, 0.5, 7.0) == pytest.approx(near)


def test_a_large_cube_is_none():
    free, box = pair_speeds(1.0, 3.0), pair_speeds_in_cube(1.0, 3.0, 3000.0)
    assert box == pytest.approx([speed - 2 * 2.837297 / 3000 for speed in free], abs=1e-7)
    for speed, larger in zip(pair_speeds_in_cube(1.0, 3.0, 12.0), free, strict=True):
        assert speed < larger - 0.2


def test_pairs_refuse():
    with pytest.raises(ValueError, match="distance = 1"):
        pair_speeds(1.0, 1.0)
    with pytest.raises(ValueError, match="box_length = 7"):
        pair_speeds_in_cube(1.0, 4.0, 7.0)
    with pytest.raises(ValueError, match="expected 3 numbers"):
        rotne_prager_in_cube([1.0, 2.0], 1.0, 10.0)
    with pytest.raises(ValueError, match="two radii"):
        rotne_prager_in_cube([1.0, 0.0, 0.0], 1.0, 10.0)
