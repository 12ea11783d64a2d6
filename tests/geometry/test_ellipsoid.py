"""Ellipses and ellipsoids of revolution: exact distances, also on the axis and at the centre."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesokit import Ellipse, Spheroid, Surface
from mesokit.geometry import primitive, region
from mesokit.scalar.pointer import address
from tests.helpers.shapes import from_ellipse, meets, solids_of

CENTRE = (0.3, -0.2, 0.5)
AXES = {2: (0.6, -0.8), 3: (1.0, 2.0, -2.0)}
RADIUS = 1.5

dimensions = st.sampled_from([2, 3])
ratios = st.floats(-1, 1).map(lambda x: 10.0**x) | st.sampled_from([0.1, 1.0, 1 + 1e-9, 10.0])
angles = st.floats(0, 0.5 * math.pi)


class Body:
    """An ellipsoid, and unit vectors along its axis and across it."""

    def __init__(self, d: int, ratio: float, axis: tuple[float, ...] | None = None) -> None:
        axis = AXES[d] if axis is None else axis
        self.along, self.across = ratio * RADIUS, RADIUS
        ((self.part,),) = region.ellipsoid(CENTRE[:d], axis, self.along, self.across)
        self.centre, self.numbers = np.array(CENTRE[:d]), np.array(self.part.numbers)
        self.axis = np.array(axis) / math.hypot(*axis)
        self.side = np.linalg.svd(self.axis[None])[2][1]

    def at(self, height: float, radius: float) -> np.ndarray:
        """A place so far along the axis and across it."""
        return self.centre + height * self.axis + radius * self.side

    def asked(self, r: np.ndarray) -> tuple[float, np.ndarray]:
        """Distance and normal."""
        given = self.part.code, address(self.numbers), 0, tuple(r.tolist())
        return primitive.distance(*given), np.array(primitive.normal(*given))

    @property
    def halves(self) -> tuple[float, float]:
        """Along the axis and across it."""
        return self.along, self.across


@given(dimensions, ratios, st.floats(0, 2), st.floats(0, 2))
def test_distance_is_that_of_the_nearest_place(d, ratio, height, radius):
    body = Body(d, ratio)
    height, radius = height * body.along, radius * body.across
    r = body.at(height, radius)
    distance, normal = body.asked(r)
    assert abs(distance - from_ellipse(*body.halves, height, radius)) < 1e-13 * max(body.halves)
    angle = np.linspace(0, 0.5 * np.pi, 4001)
    place = body.along * np.cos(angle), body.across * np.sin(angle)
    seen = np.hypot(place[0] - height, place[1] - radius).min()
    assert -1e-4 * max(body.halves) < abs(distance) - seen < 1e-13
    assert abs(np.linalg.norm(normal) - 1) < 1e-14
    foot, _ = body.asked(r - distance * normal)
    assert abs(foot) < 1e-13 * max(body.halves)


@given(dimensions, ratios, st.floats(0, 2), st.floats(0, 2), st.floats(-2, 2))
def test_bounds_tell_what_the_distance_tells(d, ratio, height, radius, reach):
    """Of places at any reach, and of those almost at the distance itself."""
    body = Body(d, ratio)
    r = body.at(height * body.along, radius * body.across)
    given = body.part.code, address(body.numbers), 0, tuple(r.tolist())
    distance, _ = body.asked(r)
    little = 1e-6 * max(body.halves)
    assert primitive.nearer(*given, distance + little)
    assert not primitive.nearer(*given, distance - little)
    assert primitive.nearer(*given, reach) == (distance < reach) or abs(distance - reach) < little


@given(dimensions, ratios, angles, st.floats(-0.99, 3))
def test_places_along_a_normal_have_that_normal(d, ratio, angle, share):
    """Outside, and inside as far as the centre of the sharpest curvature."""
    body = Body(d, ratio)
    short, long = sorted(body.halves)
    cos, sin = math.cos(angle), math.sin(angle)
    place = body.at(body.along * cos, body.across * sin)
    normal = cos / body.along * body.axis + sin / body.across * body.side
    normal /= np.linalg.norm(normal)
    by = share * short * short / long
    distance, found = body.asked(place + by * normal)
    assert abs(distance - by) < 1e-13 * long
    # inside near that centre normals change faster than places do
    assert np.abs(found - normal).max() < 1e-13 * (long / short) ** 2 / min(1 + share, 1)


@given(dimensions, st.floats(-4, 4), st.floats(-4, 4))
def test_equal_halves_are_a_ball(d, height, radius):
    body = Body(d, 1.0)
    r = body.at(height, radius)
    away = r - body.centre
    distance, normal = body.asked(r)
    assert abs(distance - (np.linalg.norm(away) - RADIUS)) < 2e-15
    if np.linalg.norm(away) > 1e-3:
        assert np.abs(normal - away / np.linalg.norm(away)).max() < 1e-12


@given(dimensions, ratios, st.booleans(), st.floats(0, 3) | st.sampled_from([0.0, 1.0, math.inf]))
def test_places_on_an_axis_have_a_formula(d, ratio, on_axis, share):
    """From within, beyond the centre of the sharpest curvature (inf) the end is the nearest."""
    body = Body(d, ratio)
    own, other = body.halves if on_axis else body.halves[::-1]
    y = share * own if share < math.inf else own - other * other / own
    if y < 0:
        return
    distance, normal = body.asked(body.at(y, 0.0) if on_axis else body.at(0.0, y))
    expected = y - own
    if own * y < own * own - other * other:
        expected = -other * math.sqrt(1 - y * y / (own * own - other * other))
    assert abs(distance - expected) < 1e-13 * max(body.halves)
    assert abs(np.linalg.norm(normal) - 1) < 1e-14


@pytest.mark.parametrize("axis", [(1, 2, 3), (0, 0, 1), (1, 1, 1), (1e-8, 0, -1)])
@pytest.mark.parametrize("off", [0.0, 1e-300, 1e-17, 1e-16, 1e-15, 1e-12])
def test_normals_beside_the_axis_are_unit_vectors(axis, off):
    """Where the nearest place is on the equator: the direction to it is across the axis."""
    body = Body(3, 10.0, axis)
    for height in (0.0, 1.0, -3.0, 7.0):
        distance, normal = body.asked(body.at(height, off))
        assert abs(np.linalg.norm(normal) - 1) < 1e-14
        foot, _ = body.asked(body.at(height, off) - distance * normal)
        assert abs(foot) < 1e-13 * body.along


def test_turning_moves_a_surface_along_itself_about_its_axis_alone():
    turning = Surface(rotation=0.7)
    spheroid = Spheroid((6, 5, 4.5), 2.0, 3.0, axis=(1, 0, 2), surface=turning)
    fastest, across = solids_of((spheroid,), 3).motion[0]
    assert 1.0 < fastest < 1.5
    assert across < 1e-12
    ellipse = Ellipse((6, 5), (6, 4), surface=turning)
    assert solids_of((ellipse,), 2).motion[0][1] > 0.5


def test_straight_into_a_spheroid():
    """Times are those of a quadratic equation: stretched along the axis it is a ball."""
    rng = np.random.default_rng(3)
    for ratio in (0.3, 1.0, 2.0):
        wall = Spheroid((6, 5, 4.5), RADIUS, ratio * RADIUS, axis=(1, 2, -2))
        axis, hits = np.array([1.0, 2.0, -2.0]) / 3, 0
        solids = solids_of((wall,), 3)
        for _ in range(200):
            aside, r = np.array(wall.centre) + rng.uniform(-4, 4, (2, 3))
            if solids.distance(r)[0] < 0:
                continue
            v = 0.5 * (aside + wall.centre) - r
            x, u = (a + (1 / ratio - 1) * (a @ axis) * axis for a in (r - wall.centre, v))
            root = (x @ u) ** 2 - (u @ u) * (x @ x - RADIUS**2)
            time = -(x @ u + math.sqrt(max(root, 0))) / (u @ u)
            hit = root > 0 and 0 < time < 1.0
            hits += hit
            assert meets(solids, r, v, np.zeros(3), 1.0) == pytest.approx(
                time if hit else np.inf, abs=1e-9
            )
        assert hits > 20
