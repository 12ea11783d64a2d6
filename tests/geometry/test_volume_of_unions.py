"""Volumes of unions as bodies: exact where parts touch, sampled where they overlap."""

import math

import numpy as np
import pytest

from mesokit import Disk, Rectangle, Sphere, UnionBody


def volume_of_two(d, r, s, apart):
    """Of two balls with these radii, less what they share."""
    near = (apart**2 + r**2 - s**2) / (2 * apart)  # from the first centre to the shared plane
    if d == 3:
        caps = [math.pi * (b - h) ** 2 * (2 * b + h) / 3 for b, h in ((r, near), (s, apart - near))]
        return 4 / 3 * math.pi * (r**3 + s**3) - sum(caps)
    caps = [
        b**2 * math.acos(h / b) - h * math.sqrt(b**2 - h**2)
        for b, h in ((r, near), (s, apart - near))
    ]
    return math.pi * (r**2 + s**2) - sum(caps)


@pytest.mark.parametrize(("d", "mean", "most"), [(2, 0.0001, 0.0003), (3, 0.0004, 0.0007)])
def test_two_balls_that_overlap(d, mean, most):
    """The guide has these figures of more pairs."""
    rng, shape, off = np.random.default_rng(2), Disk if d == 2 else Sphere, []
    for _ in range(60 if d == 2 else 20):
        r = rng.uniform(1, 5)
        s = r * rng.uniform(0.4, 1)
        apart = rng.uniform(r - 0.9 * s, r + 0.9 * s)
        away = rng.normal(size=d)
        away *= apart / np.linalg.norm(away)
        body = UnionBody(parts=[shape([0] * d, r), shape(away, s)]).solid(d)
        assert body.overlaps
        off.append(abs(body.volume / volume_of_two(d, r, s, apart) - 1))
    assert np.mean(off) < mean and max(off) < most


def test_parts_that_touch_are_exact():
    """The same shape of parts that overlap is off by less than a thousandth."""
    one, beside = Rectangle((0, 0), (10, 2.5)), Rectangle((3.75, 3.25), (2.5, 4))
    body = UnionBody(parts=[one, beside]).solid(2)
    assert not body.overlaps and body.volume == pytest.approx(35, rel=1e-14)
    over = UnionBody(parts=[one, Rectangle((3.75, 2), (2.5, 6.5))]).solid(2)
    assert over.overlaps and over.volume == pytest.approx(35, rel=1e-3)
    assert over.moments[2, 2] == pytest.approx(body.moments[2, 2], rel=2e-3)


@pytest.mark.parametrize(("long", "wide"), [(20, 2), (24, 2), (10, 2), (9, 3)])
def test_crosses_at_an_angle(long, wide):
    """At 45 degrees the edges pass through the middles of small cubes or between them."""
    parts = [Rectangle((0, 0), (long, wide), angle=angle) for angle in (45, 135)]
    body = UnionBody(parts=parts).solid(2)
    assert body.volume == pytest.approx(2 * long * wide - wide**2, rel=0.001)
    inertia = long * wide * (long**2 + wide**2) / 6 - wide**4 / 6
    assert body.moments[2, 2] == pytest.approx(inertia, rel=0.003)
