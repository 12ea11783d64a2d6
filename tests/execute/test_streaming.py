"""Flights between plates: hits where they are, nothing outside, momentum and time accounted for."""

from decimal import Decimal, localcontext
from typing import NamedTuple

import numpy as np
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from numba import njit

from mesokit import Plates, Surface
from mesokit.case.box import Box, fold, peculiar
from mesokit.geometry.protocol import first_hit, touches
from mesokit.method.mpcd.engine.cpu.bounce import bounce
from mesokit.scalar.random import Counter

WIDTH, LENGTH = 3, 5

speed = st.floats(-6, 6)
pull = st.floats(-8, 8)
height = st.floats(0, WIDTH)
timestep = st.floats(1e-3, 2)
walls = st.sampled_from(["no-slip", "slip"])

SCALE = 2.0**44


class Step(NamedTuple):
    solid: tuple
    timestep: float
    kT: float
    momentum_scale: float


@njit
def flown(solid, r, v, a, time, impulse):
    step = Step(solid, time, 1.0, SCALE)
    return bounce(step, time, Counter(1, 1), (0, 1.0), r, v, a, impulse)


def flies(solid, r, v, a, time):
    """Position and velocity after the flight, and what the lower and the upper plate took."""
    impulse = np.zeros(6, np.int64)
    r, v = flown(solid, r, v, a, time, impulse)
    taken = impulse.reshape(2, 3)[:, :2] / SCALE
    return r, v, taken[0], taken[1]


finds = njit(lambda solid, r, v, a, time: first_hit(solid, r, v, a, time, 0))
sees = njit(lambda solid, r, v, a, time: touches(solid, (), r, v, a, time))
folds = njit(lambda box, r, v, shift: fold(box, r, v, shift))
relative = njit(lambda box, r, v: peculiar(box, r, v))


def slit(lower="no-slip", upper="no-slip", u=0.0, axis="y"):
    """Plates that move at -u and u."""
    return Plates(
        axis=axis,
        lower=Surface(lower, velocity=None if lower == "slip" else (-u, 0.0)),
        upper=Surface(upper, velocity=None if upper == "slip" else (u, 0.0)),
    ).kernel((LENGTH, WIDTH))


def exact_hit(h, v, a, time):
    """Earliest time in (0, time] at which a parabola leaves 0 <= h <= WIDTH, and where; or None."""
    found = []
    with localcontext(prec=400):
        h, v, a = (Decimal(x) for x in (h, v, a))
        for plate, level, outward in ((0, Decimal(0), -1), (1, Decimal(WIDTH), 1)):
            c = h - level
            square = v * v - 2 * a * c
            if square <= 0:
                continue
            root = square.sqrt()
            times = [(-v + s * root) / a for s in (1, -1)] if a else ([-c / v] if v else [])
            for t in times:
                if 0 <= t <= time and (v + a * t) * outward > 0:
                    found.append((t, plate))
    return min(found) if found else None


@given(h=height, v=speed, a=pull, time=timestep)
@example(h=1.0, v=2.0, a=-3.0, time=2.0)  # up and back
@example(h=0.0, v=1.0, a=-1.0, time=2.0)  # leaves the plate and falls back on it
@example(h=1.0, v=-1.0, a=1e-12, time=2.0)  # nearly straight: a cancelling formula fails
@example(h=0.5, v=-1.0, a=0.0, time=1.0)
@settings(max_examples=500)
def test_time_of_a_hit_is_the_root(h, v, a, time):
    expected = exact_hit(h, v, a, time)
    got, plate = finds(slit(), (1.0, h), (0.3, v), (0.0, a), time)
    if expected is None:
        # one that grazes the end of the flight may fall on either side of it
        assert got > time * (1 - 1e-9)
        return
    t, where = expected
    t = float(t)
    speed_there = abs(v + a * t)
    assume(speed_there > 1e-4)  # a grazing hit is ill-conditioned in its time, not its place
    assert plate == where
    assert abs(got - t) < 1e-14 / speed_there + 1e-13
    assert sees(slit(), (1.0, h), (0.3, v), (0.0, a), time)


@given(
    h=height, along=speed, v=speed, a=pull, b=pull, time=timestep, lower=walls, upper=walls,
    u=st.floats(-1, 1),
)  # fmt: skip
@settings(max_examples=500)
def test_flights_stay_inside_and_momentum_is_accounted_for(
    h, along, v, a, b, time, lower, upper, u
):
    assume(lower == upper == "no-slip" or u == 0)
    solid = slit(lower, upper, u)
    r1, v1, low, up = flies(solid, (1.0, h), (along, v), (b, a), time)
    assert 0 <= r1[1] <= WIDTH
    scale = 1 + sum(map(abs, (*low, *up, *v1)))
    for k in range(2):
        balance = (along, v)[k] + (b, a)[k] * time - low[k] - up[k] - v1[k]
        assert abs(balance) < 1e-12 * scale
    if a == b == u == 0:
        assert np.hypot(*v1) == np.hypot(along, v)
    if lower == upper == "slip":
        assert v1[0] == along + b * time or abs(v1[0] - along - b * time) < 1e-12 * scale


@given(h=height, along=speed, v=speed, a=pull, b=pull, time=timestep, lower=walls, upper=walls)
@settings(max_examples=500)
def test_a_flight_can_be_reversed(h, along, v, a, b, time, lower, upper):
    solid = slit(lower, upper)
    path = exact_hit(h, v, a, time)
    assume(path is None or 1e-3 < float(path[0]) < time - 1e-3)
    r1, v1, low, up = flies(solid, (1.0, h), (along, v), (b, a), time)
    assume(abs(v1[1]) > 1e-2 and 1e-3 < r1[1] < WIDTH - 1e-3 and 1e-3 < h < WIDTH - 1e-3)
    assume(np.hypot(*low) + np.hypot(*up) < 30)  # not caught in many small hops
    back = tuple(-x for x in v1)
    r0, v0, _, _ = flies(solid, r1, back, (b, a), time)
    np.testing.assert_allclose(r0, (1.0, h), atol=1e-6)
    np.testing.assert_allclose(v0, (-along, -v), atol=1e-5)


def test_bounce_back_and_mirror():
    solid = slit("no-slip", "slip", u=0.0)
    r, v, low, up = flies(solid, (1.0, 0.5), (2.0, -1.0), (0.0, 0.0), 1.0)
    np.testing.assert_allclose((r, v), ((1.0, 0.5), (-2.0, 1.0)), atol=1e-15)
    np.testing.assert_allclose((low, up), ((4.0, -2.0), (0.0, 0.0)), atol=1e-15)
    r, v, low, up = flies(solid, (1.0, 2.5), (2.0, 1.0), (0.0, 0.0), 1.0)
    np.testing.assert_allclose((r, v), ((3.0, 2.5), (2.0, -1.0)), atol=1e-15)
    np.testing.assert_allclose((low, up), ((0.0, 0.0), (0.0, 2.0)), atol=1e-15)


@given(
    x=st.floats(-30, 30), y=st.floats(-7, 7), v=st.tuples(speed, speed), time=st.floats(0, 100),
    shift=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)), rate=st.floats(-1, 1),
)  # fmt: skip
@settings(max_examples=500)
def test_fold_under_shear(x, y, v, time, shift, rate):
    """Each image has the same velocity relative to the flow, and is displaced as the images are."""
    assume(rate != 0)
    size = (5, 3)
    box = Box(size, shear_rate=rate).kernel((False, False), time)
    r1, v1, n = folds(box, (x, y), v, shift)
    for k in range(2):
        assert -1e-12 <= r1[k] + shift[k] <= size[k] + 1e-12
        assert n[k] == np.rint(n[k])
    # where the rounding of r + shift puts it decides the image, so reconstruct from the count
    assert abs(r1[1] + n[1] * 3 - y) < 1e-12
    assert abs(r1[0] + n[0] * 5 + n[1] * box.offset - x) < 1e-11
    assert abs(v1[0] + n[1] * box.speed - v[0]) < 1e-12
    assert v1[1] == v[1]
    assert abs(relative(box, r1, v1)[0] - relative(box, (x, y), v)[0]) < 1e-11
    again = folds(box, r1, v1, shift)
    inside = all(0 <= r1[k] + shift[k] < size[k] for k in range(2))
    assert not inside or again == (r1, v1, (0.0, 0.0))
