"""Steps that hit solids: nobody inside, momentum and energy accounted for, surfaces that move."""

from __future__ import annotations

from contextlib import contextmanager

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from mesokit import Cylinder, Disk, Plates, Rectangle, Spheroid, Surface
from mesokit.geometry.solids.bodies import COLUMNS, SURFACES
from mesokit.geometry.solids.tables import RULES
from tests.geometry.test_flights import KINDS, flight
from tests.helpers.shapes import ROUND, bounced, meets, on_surface, solids_of, with_surface

flights = given(kind=st.sampled_from(KINDS), seed=st.integers(0, 2**32 - 1))
thorough = settings(max_examples=50)
REST = {2: (0.0, 0.0), 3: (0.0, 0.0, 0.0)}


@contextmanager
def ruled(solids, rule):
    """Solids with this rule: the same tables, but for the numbers of their surfaces."""
    table = next(t for t in solids._tables if t.ctypes.data == solids._places[SURFACES])
    before = table.copy()
    table.reshape(-1, COLUMNS)[:, 0] = RULES[rule]
    try:
        yield
    finally:
        table[...] = before


@flights
@thorough
def test_nobody_is_inside_and_momentum_is_accounted_for(every, kind, seed):
    """The same flights with every rule."""
    solids = every[3]
    r, v, a, time = flight(solids, kind, np.random.default_rng(seed))
    if solids.distance(r)[0] < 0:
        return
    for rule in RULES:
        with ruled(solids, rule):
            end, after, taken = bounced(solids, r, v, a, time)
        assert solids.distance(end)[0] >= 0, rule
        scale = 1 + np.abs(taken).sum() + np.abs(after).max() + np.linalg.norm(v)
        np.testing.assert_allclose(after, v + time * a - taken.sum(axis=0), atol=1e-10 * scale)
        if rule != "diffuse" and not a.any():
            np.testing.assert_allclose(np.linalg.norm(after), np.linalg.norm(v), rtol=1e-12)


def test_few_are_left_where_they_were(every):
    """Only who is caught in a corner, or between the rounding of two surfaces."""
    solids, rng, left = every[3], np.random.default_rng(3), 0
    for _ in range(1000):
        r, v, a, time = flight(solids, "aimed", rng)
        if solids.distance(r)[0] >= 0:
            left += (bounced(solids, r, v, a, time)[0] == r).all()
    assert left < 5


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("rule", ["no-slip", "slip"])
def test_rules_of_reflection(rule, d):
    wall = ROUND[d]((6.0, 5.0, 4.5)[:d], 2.0)
    solids = solids_of((with_surface(wall, Surface(rule)),), d)
    r, normal = on_surface(solids, 50)
    rng = np.random.default_rng(5)
    for place, n in zip(r, normal, strict=True):
        v = rng.standard_normal(d)
        v -= (v @ n + 1) * n  # downwards
        end, after, taken = bounced(solids, place - 0.1 * v, v, REST[d], 0.2)
        expected = -v if rule == "no-slip" else v - 2 * (v @ n) * n
        np.testing.assert_allclose(after, expected, atol=1e-8)
        np.testing.assert_allclose(end, (place + 0.1 * expected) % solids.size, atol=1e-7)
        np.testing.assert_allclose(taken[0], v - after, atol=1e-10)


MOVING = {
    "turning disk": (Disk((6, 5), 2, surface=Surface(rotation=0.7)), 2),
    "turning cylinder": (Cylinder((6, 5, 4.5), 2, axis="x", surface=Surface(rotation=0.7)), 3),
    "turning sphere": (ROUND[3]((6, 5, 4.5), 2, surface=Surface(rotation=(0.2, -0.5, 0.3))), 3),
    "turning spheroid": (
        Spheroid((6, 5, 4.5), 2, 3, axis=(1, 0, 2), surface=Surface(rotation=0.7)), 3,
    ),
    "sliding block": (Rectangle((6, 1), (12, 2), surface=Surface(velocity=(0.4, 0))), 2),
    "turning pipe": (
        Cylinder((6, 5, 4.5), 3, fluid="inside", surface=Surface(rotation=-0.4)), 3,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MOVING)
def test_moving_surfaces_reflect_in_their_frame(name):
    wall, d = MOVING[name]
    solids = solids_of((wall,), d)
    body = solids.bodies[0]
    pivot = np.array(wall.centre)
    rng = np.random.default_rng(6)
    hits = 0
    for place, n in zip(*on_surface(solids, 60), strict=True):
        if name == "sliding block" and abs(n[1]) < 0.5:
            continue
        v = rng.standard_normal(d)
        v -= (v @ n + 1) * n
        start = place - 0.05 * v
        if solids.distance(start)[0] < 0:
            continue
        t = meets(solids, start, v, REST[d], 0.1)
        arm = np.zeros(3)
        arm[:d] = start + t * v - pivot
        u = np.cross(body.rotation, arm)[:d] + np.array(body.surface.velocity or REST[d])
        assert np.linalg.norm(u) > 0 or name == "turning sphere"
        _, after, _ = bounced(solids, start, v, REST[d], 1.01 * t)
        np.testing.assert_allclose(after - u, -(v - u), atol=1e-8)
        hits += 1
    assert hits > 20


@pytest.mark.parametrize("case", ["disk", "sphere", "plates", "turning disk"])
def test_diffuse_reflections_have_the_flux_of_a_gas(case):
    """Normal speeds u exp(-u^2/2), tangential ones Maxwellian, angles after Knudsen's law."""
    d = 3 if case == "sphere" else 2
    walls = {
        "disk": Disk((6, 5), 2, surface=Surface("diffuse")),
        "sphere": ROUND[3]((6, 5, 4.5), 2, surface=Surface("diffuse")),
        "plates": Plates("y", upper=Surface("diffuse"), lower=Surface("diffuse")),
        "turning disk": Disk((6, 5), 2, surface=Surface("diffuse", rotation=0.5)),
    }
    solids = solids_of((walls[case],), d)
    if case == "plates":
        place, n = np.array([6.0, 10.0]), np.array([0.0, -1.0])
    else:
        place, n = np.array([6.0, 7.0, 4.5][:d]), np.array([0.0, 1.0, 0.0][:d])
    u = np.array([-0.5 * 2, 0.0]) if case == "turning disk" else np.zeros(d)
    v = -n + 0.3 * np.eye(d)[0]
    drawn = np.array(
        [bounced(solids, place - 0.1 * v, v, REST[d], 0.1001, i)[1] - u for i in range(20_000)]
    )
    away, along = drawn @ n, drawn[:, 0]
    assert (away > 0).all()
    assert stats.kstest(away, lambda x: 1 - np.exp(-(x**2) / 2)).pvalue > 1e-3
    assert stats.kstest(along, "norm").pvalue > 1e-3
    cosine = away / np.linalg.norm(drawn, axis=1)
    law = (lambda c: c**2) if d == 3 else (lambda c: 1 - np.sqrt(1 - c**2))
    assert stats.kstest(cosine, law).pvalue > 1e-3
    assert abs(np.corrcoef(away, along)[0, 1]) < 4 / np.sqrt(len(away))


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("rule", ["no-slip", "slip"])
def test_who_is_pressed_onto_a_solid_hops_on_it(rule, d):
    """Dropped onto the top of a ball by a force, from 0.02: seven hops and a half in a timestep."""
    wall = ROUND[d]((6.0, 5.0, 4.5)[:d], 2.0)
    solids = solids_of((with_surface(wall, Surface(rule)),), d)
    height, g = 0.02, 4.0
    fall_time = (2 * height / g) ** 0.5
    top, down = np.array((6.0, 7.0, 4.5)[:d]), np.eye(d)[1] * -g
    start = top - height * down / g
    end, after, taken = bounced(solids, start, np.zeros(d), down, 15.5 * fall_time)
    # 15 times of fall end at the surface, the half one on the way up
    up = (g * fall_time) - g * 0.5 * fall_time
    np.testing.assert_allclose(after, up * np.eye(d)[1], atol=1e-6)
    np.testing.assert_allclose(end, top + np.eye(d)[1] * 0.75 * height, atol=1e-6)
    np.testing.assert_allclose(taken.sum(axis=0), down * 15.5 * fall_time - after, atol=1e-6)


def test_who_is_caught_between_surfaces_is_not_driven_on():
    """In the crevice between a turning disk and a plate that slips, where hits follow one another
    without end: the particle leaves no faster than it came."""
    disk = with_surface(Disk((6.0, 2.5), 3.0), Surface("no-slip", rotation=0.3))
    solids = solids_of((Plates("y", lower=Surface("slip")), disk), 2)
    rng, caught = np.random.default_rng(6), 0
    corner = np.array((6.0 - (9.0 - 6.25) ** 0.5, 0.0))
    for _ in range(500):
        start = corner + rng.random(2) * (-0.1, 0.02)
        v = np.array((1.0, -0.3)) * rng.random()
        if solids.distance(start)[0] <= 0:
            continue
        end, after, taken = bounced(solids, start, v, REST[2], 0.5)
        assert solids.distance(end)[0] >= 0
        np.testing.assert_allclose(after, v - taken.sum(axis=0), atol=1e-9)
        if (end == start).all():
            caught += 1
            assert np.hypot(*after) <= np.hypot(*v) * (1 + 1e-8)
    assert caught > 10
