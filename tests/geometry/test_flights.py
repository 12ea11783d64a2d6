"""First hits of straight and curved flights, against a march in small steps."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.helpers.shapes import SIZE, anywhere, meets, on_surface

STEPS = 1500  # of the march
TOUCH = 1e-9  # cells: so near is a hit
SLIVER = 2e-7  # cells: so deep a chord may go that is shorter than the march dares without looking
KINDS = ("free", "aimed", "grazing", "tangential", "corner", "long")

flights = given(kind=st.sampled_from(KINDS), seed=st.integers(0, 2**32 - 1))
thorough = settings(max_examples=80)


def clearance(solids, r, v, a, t):
    """Distance from the surface along a flight."""
    t = np.atleast_1d(t)[:, None]
    return solids.distance(r + t * v + 0.5 * t**2 * a)


def march(solids, r, v, a, time):
    """First crossing into the solid that steps of time/STEPS see; infinity if they see none."""
    t = np.linspace(0, time, STEPS + 1)
    inside = clearance(solids, r, v, a, t) < 0
    if not inside.any():
        return np.inf
    k = int(np.argmax(inside))
    low, high = t[max(k - 1, 0)], t[k]
    for _ in range(60):
        middle = 0.5 * (low + high)
        if clearance(solids, r, v, a, middle)[0] < 0:
            high = middle
        else:
            low = middle
    return high


def unit(x):
    return x / np.linalg.norm(x)


def flight(solids, kind, rng):
    """A flight that starts in the fluid: place, velocity, acceleration, time."""
    d = solids.dimension
    time = 10 ** rng.uniform(-2, 0.3)
    a = rng.uniform(-8, 8, d) * rng.integers(0, 2)
    target, normal = surface(solids)
    i = rng.integers(len(target))
    along = rng.standard_normal(d)
    along = unit(along - along @ normal[i] * normal[i] + 1e-300)
    if kind in ("free", "long"):
        r = rng.choice(fluid_places(solids))
        v = rng.standard_normal(d) * (1 if kind == "free" else 20)
        return r, v, a, time
    if kind == "tangential":  # from the surface, and the acceleration pulls back or away
        return target[i] + 1e-9 * normal[i], along * rng.uniform(0, 3), a, time
    place = target[i]
    if kind == "corner":
        place = kinks(solids)[rng.integers(5)]
    if kind == "grazing":
        height = rng.choice([-1, 1]) * 10 ** rng.uniform(-12, -1)  # below: a short chord
        place, a = place + height * normal[i], 0 * a
        direction = along
    else:
        direction = unit(rng.standard_normal(d))
        direction *= -np.sign(direction @ normal[i])
    v = direction * rng.uniform(0.3, 3)
    back = rng.uniform(0, 0.7) * time
    # back in time from the place, on the same parabola
    return place - back * v + 0.5 * back**2 * a, v - back * a, a, time


def surface(solids):
    """Places on the surface and their normals, kept with the solids."""
    if not hasattr(solids, "seen"):
        solids.seen = on_surface(solids, 400)
        r = anywhere(solids.dimension, 100_000)
        solids.fluid = r[solids.distance(r) > 0][:500]
    return solids.seen


def fluid_places(solids):
    surface(solids)
    return solids.fluid


def kinks(solids):
    """The surface places where the normal turns most, kept with the solids."""
    if not hasattr(solids, "kinks"):
        solids.kinks = sharpest(solids)
    return solids.kinks


def sharpest(solids):
    r, normal = surface(solids)
    step = r[:, None] - r
    size = np.array(SIZE[solids.dimension])
    step -= size * np.round(step / size)
    near = np.linalg.norm(step, axis=2) + 1e9 * np.eye(len(r))
    nearest = near.argsort(axis=1)[:, :4]
    turn = np.linalg.norm(normal[nearest] - normal[:, None], axis=2).max(axis=1)
    return r[turn.argsort()[-5:]]


@flights
@thorough
def test_first_hit(every, kind, seed):
    _, _, _, solids = every
    r, v, a, time = flight(solids, kind, np.random.default_rng(seed))
    if solids.distance(r)[0] < 0:
        return
    expected = march(solids, r, v, a, time)
    got = meets(solids, r, v, a, time)
    end = min(got, time)
    seen = clearance(solids, r, v, a, np.linspace(0, end, STEPS + 1)[:-1])
    assert seen.min() > -SLIVER  # never far inside before
    if np.isfinite(got):
        assert 0 <= got <= time
        assert abs(clearance(solids, r, v, a, got)[0]) < TOUCH
    if np.isinf(expected):
        return
    speed = np.linalg.norm(v + expected * a)
    if got > expected + TOUCH / max(speed, 1e-9):  # then what was missed is a sliver
        deep = clearance(solids, r, v, a, np.linspace(expected, end, STEPS + 1)).min()
        assert deep > -SLIVER
    if got < expected - TOUCH / max(speed, 1e-9):  # then it only touches there, and may go on
        assert abs(clearance(solids, r, v, a, got)[0]) < TOUCH


def test_short_chords_are_seen(every):
    """Straight flights that cut only just into a bump, nowhere deeper than 10^-6 to 10^-2."""
    name, d, side, solids = every
    rng, cuts = np.random.default_rng(4), 0
    places, normals = surface(solids)
    for place, n in zip(places[:100], normals, strict=False):
        along = rng.standard_normal(d)
        along = unit(along - along @ n * n)
        start = place - 10 ** rng.uniform(-6, -2) * n - rng.uniform(0.2, 0.6) * along
        path = clearance(solids, start, along, np.zeros(d), np.linspace(0, 1, 400))
        if path[0] > 0 and path.min() < -SLIVER:
            cuts += 1
            got = meets(solids, start, along, np.zeros(d), 1.0)
            assert np.isfinite(got)
            before = np.linspace(0, got, 400)[:-1]
            assert clearance(solids, start, along, np.zeros(d), before).min() > -SLIVER
    flat = name in ("plates", "half-space")
    assert cuts > 0 or flat or side == "inside"


def test_straight_into_a_ball():
    """Times are those of a quadratic equation."""
    from mesokit import Disk
    from tests.helpers.shapes import solids_of

    solids = solids_of((Disk((6, 5), 2),), 2)
    for offset in (0.0, 1.0, 1.9, 1.999999, 2 - 1e-12):
        got = meets(solids, (1.0, 5.0 + offset), (2.0, 0.0), (0.0, 0.0), 4.0)
        exact = (5 - np.sqrt(4 - offset**2)) / 2
        assert abs(got - exact) * np.sqrt(4 - offset**2) < 2e-9
    for offset in (2 + 1e-9, 2.1):
        assert np.isinf(meets(solids, (1.0, 5.0 + offset), (2.0, 0.0), (0.0, 0.0), 4.0))


@pytest.mark.parametrize("boxes", [1, 7.3, 40])
def test_long_flights_go_round_the_box(boxes):
    """In a channel between posts, for many boxes, and then into a post."""
    from mesokit import Disk
    from tests.helpers.shapes import solids_of

    solids = solids_of((Disk((6, 5), 2),), 2)
    time = 12.0 * boxes
    assert np.isinf(meets(solids, (1.0, 8.0), (1.0, 0.0), (0.0, 0.0), time))
    rise = -0.4 / time
    got = meets(solids, (1.0, 7.5), (1.0, rise), (0.0, 0.0), 3 * time)
    path = np.array([1.0, 7.5]) + got * np.array([1.0, rise])
    assert abs(np.linalg.norm(path % np.array([12.0, 10.0]) - (6, 5)) - 2) < 1e-9
