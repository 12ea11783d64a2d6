"""Friction of ellipsoids and rods: published closed forms, limits, and the other way to sum."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from mesokit.theory import capsule_friction, cylinder_friction, depolarisation, ellipsoid_friction

half_axis = st.floats(0.2, 5)


def test_a_sphere_is_one_of_stokes():
    found = ellipsoid_friction([1.7] * 3, 0.6)
    assert found.translation == pytest.approx([6 * math.pi * 0.6 * 1.7] * 3)
    assert found.rotation == pytest.approx([8 * math.pi * 0.6 * 1.7**3] * 3)


@pytest.mark.parametrize(
    ("aspect", "along", "across", "end_over_end"),
    [(2.0, 1.204, 1.379, 3.010), (3.0, 1.404, 1.728, 7.022)],
)
def test_prolate_spheroids(aspect, along, across, end_over_end):
    found = ellipsoid_friction([aspect, 1.0, 1.0], 1.0)
    assert found.translation / (6 * math.pi) == pytest.approx([along, across, across], abs=5e-4)
    assert found.rotation[1:] / (8 * math.pi) == pytest.approx([end_over_end] * 2, abs=5e-4)


@pytest.mark.parametrize("aspect", [0.1, 0.5, 1.5, 4.0])
def test_mean_friction_of_spheroids_is_perrin_s_factor(aspect):
    """3/(the sum of mobilities) over that of the sphere of the same volume."""
    p = 1 / aspect
    root = math.sqrt(abs(1 - p**2))
    log = math.log((1 + root) / p) if p < 1 else math.atan(root)
    published = root / (p ** (2 / 3) * log)
    found = ellipsoid_friction([aspect, 1.0, 1.0], 1.0).translation
    sphere = 6 * math.pi * aspect ** (1 / 3)
    assert 3 / (1 / found).sum() == pytest.approx(published * sphere)


def test_a_thin_disk():
    found = ellipsoid_friction([1e-7, 1.0, 1.0], 1.0)
    assert found.translation == pytest.approx([16, 32 / 3, 32 / 3], rel=1e-5)
    assert found.rotation == pytest.approx([32 / 3] * 3, rel=1e-5)


@given(a=half_axis, b=half_axis, c=half_axis)
def test_integrals_of_ellipsoids(a, b, c):
    axes = np.array([a, b, c])
    assert sum(depolarisation(axes, i) for i in range(3)) == pytest.approx(1)
    found = ellipsoid_friction(axes, 1.3)

    def integral(power):
        """Over s = x/(1 - x) of 1/((a^2 + s)^power D)."""
        return quad(
            lambda x: (
                (a**2 + x / (1 - x)) ** -power
                / math.sqrt(np.prod(axes**2 + x / (1 - x)))
                / (1 - x) ** 2
            ),
            0,
            1,
        )[0]

    expected = 16 * math.pi * 1.3 / (integral(0) + a**2 * integral(1))
    assert found.translation[0] == pytest.approx(expected, rel=1e-5)


def test_long_spheroids_and_cylinders_are_slender_bodies():
    found = ellipsoid_friction([1e4, 1.0, 1.0], 1.0)
    unit = 4 * math.pi * 1e4
    log = math.log(2e4)
    assert found.translation[:2] == pytest.approx([unit / (log - 0.5), 2 * unit / (log + 0.5)])
    assert found.rotation[1] == pytest.approx(8 / 3 * math.pi * 1e12 / (log - 0.5))


def test_rods_of_five_diameters():
    assert cylinder_friction(10, 2, 1.0) == pytest.approx((39.4, 50.4, 928), rel=2e-3)
    assert cylinder_friction(30, 6, 0.5) == pytest.approx(
        np.array(cylinder_friction(10, 2, 1.0)) * [1.5, 1.5, 13.5]
    )
    # between the spheroid in it and the cylinder about it
    inner = ellipsoid_friction([5.0, 1.0, 1.0], 1.0)
    least = (*inner.translation[:2], inner.rotation[1])
    for low, capsule, high in zip(
        least, capsule_friction(10, 2, 1.0), cylinder_friction(10, 2, 1.0), strict=True
    ):
        assert low < capsule < high


def capsule_points(aspect, radius, spacing):
    """About x, on a capsule around the axis of one of radius 1."""
    straight = aspect - 1
    reach = straight + 0.5 * math.pi * radius  # along the meridian
    rings = round(2 * reach / spacing)
    points = []
    for ring in range(rings):
        s = reach * (2 * (ring + 0.5) / rings - 1)
        turn = max(abs(s) - straight, 0) / radius
        x = min(abs(s), straight) + radius * math.sin(turn)
        n = max(3, round(2 * math.pi * radius * math.cos(turn) / spacing))
        angle = 2 * np.pi * (np.arange(n) / n + 0.618 * ring)
        across = radius * math.cos(turn)
        points.append(
            [np.full(n, math.copysign(x, s)), across * np.cos(angle), across * np.sin(angle)]
        )
    return np.concatenate(points, axis=1).T


def by_point_forces(aspect, spacing):
    """Friction of a capsule of radius 1, from forces inside that move its surface as one."""
    inside = capsule_points(aspect, 0.55, 0.74 * spacing)
    surface = capsule_points(aspect, 1.0, spacing / 1.4)
    away = surface[:, None] - inside
    r = np.linalg.norm(away, axis=-1)[..., None, None]
    oseen = (np.eye(3) / r + away[..., None] * away[..., None, :] / r**3) / (8 * math.pi)
    matrix = oseen.transpose(0, 2, 1, 3).reshape(surface.size, inside.size)
    motions = [np.tile(axis, (len(surface), 1)) for axis in np.eye(3)[:2]]
    motions.append(np.cross([0.0, 0.0, 1.0], surface))
    wanted = np.stack([motion.ravel() for motion in motions], 1)
    force = np.linalg.lstsq(matrix, wanted, rcond=1e-12)[0].reshape(-1, 3, 3)
    torque = np.cross(inside, force[..., 2])[:, 2].sum()
    return force[:, 0, 0].sum(), force[:, 1, 1].sum(), torque


@pytest.mark.parametrize(("aspect", "spacing"), [(1.5, 0.35), (5.0, 0.45), (8.0, 0.5)])
def test_capsules(aspect, spacing):
    found = capsule_friction(3 * 2 * aspect, 3 * 2, 0.7) / (0.7 * np.array([3, 3, 27]))
    assert found == pytest.approx(by_point_forces(aspect, spacing), rel=2e-3)


def test_a_capsule_of_no_cylinder_is_a_sphere():
    found = np.array(capsule_friction(2, 2, 1.0))
    assert found == pytest.approx(math.pi * np.array([6, 6, 8]), rel=2e-4)


def test_shapes_refuse():
    with pytest.raises(ValueError, match="expected 3"):
        ellipsoid_friction([1.0, 2.0], 1.0)
    with pytest.raises(ValueError, match="half_axes = 0"):
        ellipsoid_friction([1.0, 2.0, 0.0], 1.0)
    with pytest.raises(ValueError, match="from 2 to 30"):
        cylinder_friction(3.0, 2.0, 1.0)
    with pytest.raises(ValueError, match="from 1 to 20"):
        capsule_friction(1.0, 2.0, 1.0)
