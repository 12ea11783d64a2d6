"""Soft spheres at walls of any shape: what they do there is what they do at the same plane."""

import math

import numpy as np
import pytest

from mesokit import (
    CosineChannel,
    Cuboid,
    Ellipse,
    Plates,
    PouredStart,
    RandomStart,
    Rectangle,
    SphereKind,
    SpringDashpot,
    Surface,
    Union,
)
from tests.helpers.shapes import from_ellipse
from tests.helpers.soft_spheres import ROUGH, at_rest, pile, soft

ONE = {"number": 1, "start": RandomStart(), "pair": ROUGH}


def thrown(walls, dimension, size, **arrays):
    """One sphere in gravity that falls on a floor at height 2 and rolls away."""
    place = [3.0, *[3.0] * (dimension - 2), 4.0]
    velocities, spins = np.zeros((1, dimension)), np.full((1, 3), 0.7)
    velocities[0, 0] = 0.8
    if dimension == 2:
        spins = spins[:, 0]
    start = at_rest([place], velocities=velocities, spins=spins)
    gravity = [0.0] * (dimension - 1) + [-2.0]
    return soft(
        size,
        walls=walls,
        given=start,
        number=1,
        start=RandomStart(),
        pair=ROUGH,
        gravity=gravity,
        **arrays,
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_is_as_good_a_floor_as_a_plate(dimension):
    size = [12.0, 10.0] if dimension == 2 else [12.0, 6.0, 10.0]
    if dimension == 2:
        block = Rectangle(centre=[6, 1], size=[12, 2])
    else:
        block = Cuboid(centre=[6, 3, 1], size=[12, 6, 2])
    slab = thrown([block], dimension, size)
    lower = [size[k] for k in range(dimension - 1)] + [8.0]
    plate = thrown([Plates("yz"[dimension - 2])], dimension, lower)
    place = plate.positions()[0].copy()
    place[-1] -= 2.0
    plate.system.fill(place[None], plate.velocities(), plate.spins())
    plate.system.find_forces(0.0)
    for _ in range(40):
        slab.advance(1000)
        plate.advance(1000)
        one, two = slab.positions(unwrapped=True)[0], plate.positions(unwrapped=True)[0]
        assert one[-1] - 2 == pytest.approx(two[-1], abs=1e-9)
        assert one[0] == pytest.approx(two[0], abs=1e-6)  # the seam of the block is no bump
    assert np.abs(slab.spins() - plate.spins()).max() < 1e-6


def test_a_ball_rests_in_a_corner_of_two_blocks():
    corner = Union(
        parts=[Rectangle(centre=[6, 1], size=[12, 2]), Rectangle(centre=[1, 5], size=[2, 10])]
    )
    gravity = [-1.0, -1.0]
    start = at_rest([[4.0, 4.0]])
    engine = soft(
        [12, 10],
        walls=[corner],
        given=start,
        number=1,
        start=RandomStart(),
        pair=ROUGH,
        gravity=gravity,
    )
    engine.advance(60_000)
    k, _ = ROUGH.constants(1.0)
    np.testing.assert_allclose(engine.positions()[0], 2.5 - 1 / k, atol=1e-4)
    np.testing.assert_allclose(engine.velocities()[0], 0.0, atol=1e-3)


def test_a_ball_rests_in_the_trough_of_a_wave_at_its_nearest_place():
    # y = A cos(2 pi x/L): in the trough the nearest place is right below, for a ball less bent
    wave = CosineChannel(width=7.0, amplitude=1.0)
    engine = soft(
        [16, 12], walls=[wave], given=at_rest([[4.0, 6.0]]), gravity=[0.0, -1.0],
        number=1, start=RandomStart(),
        pair=SpringDashpot(0.2, contact_time=0.02, friction=0.5, rolling=0.5),
    )  # fmt: skip
    engine.advance(100_000)
    solids = engine.system.given.others.kept
    place = engine.positions()
    distance = true_distance(solids, place[0])
    k, _ = SpringDashpot(0.2, contact_time=0.02).constants(1.0)
    assert distance == pytest.approx(0.5 - 1 / k, abs=3e-4)


def test_a_ball_rests_at_the_bottom_of_an_ellipse():
    bowl = Ellipse(centre=[8, 6], size=[12, 8], fluid="inside")
    engine = soft(
        [16, 12], walls=[bowl], given=at_rest([[7.0, 4.0]]), gravity=[0.0, -1.0],
        number=1, start=RandomStart(),
        pair=SpringDashpot(0.2, contact_time=0.02, friction=0.5, rolling=0.5),
    )  # fmt: skip
    engine.advance(100_000)
    x, y = np.abs(engine.positions()[0] - bowl.centre)
    k, _ = SpringDashpot(0.2, contact_time=0.02).constants(1.0)
    assert x < 1.0
    assert from_ellipse(6.0, 4.0, x, y) == pytest.approx(1 / k - 0.5, abs=3e-4)


def true_distance(solids, place):
    """From a fine search along the surface."""
    angle = np.linspace(0, 2 * math.pi, 4001)
    best = np.inf
    low, high = np.zeros(len(angle)), np.full(len(angle), 4.0)
    way = np.column_stack([np.cos(angle), np.sin(angle)])
    for _ in range(60):
        middle = 0.5 * (low + high)
        inside = solids.distance((place + middle[:, None] * way) % np.array(solids.size)) < 0
        low, high = np.where(inside, low, middle), np.where(inside, middle, high)
    best = min(best, float(high.min()))
    return best


def test_nothing_comes_into_a_solid():
    engine = pile(seed=3)
    solids = engine.system.given.others.kept
    for _ in range(20):
        engine.advance(1000)
        assert solids.distance(engine.positions() % engine.box).min() > 0.4
    assert engine.positions()[:, 1].min() > 0.45


def test_grains_are_poured_on_a_solid():
    block = Rectangle(centre=[8, 2], size=[9, 3], angle=20)
    engine = soft(
        [16, 14], walls=[Plates("y"), block], number=60, gravity=[0.0, -2.0],
        start=PouredStart(), pair=ROUGH,
    )  # fmt: skip
    before = engine.positions(unwrapped=True)
    engine.advance(5000)
    assert np.abs(engine.positions(unwrapped=True) - before).max() < 0.1
    assert engine.system.given.others.kept.distance(before % engine.box).min() > 0.49


def test_a_block_that_moves_along_itself_drags_what_lies_on_it():
    # from rest friction pulls with mu m g, until the disk rolls: a third of the block's speed
    speed, friction, g = 0.6, 0.3, 10.0
    law = SpringDashpot(0.3, contact_time=0.01, friction=friction)
    k, _ = law.constants(1.0)
    block = Rectangle(centre=[6, 1], size=[12, 2], surface=Surface(velocity=[speed, 0.0]))
    engine = soft(
        [12, 10], walls=[block], given=at_rest([[3.0, 2.5 - g / k]]), number=1,
        start=RandomStart(), pair=law, kinds=[SphereKind(1.0, mass=1.0)], gravity=[0.0, -g],
    )  # fmt: skip
    slides = speed / (3 * friction * g)
    engine.advance(round(0.6 * slides / engine.timestep))
    assert engine.velocities()[0, 0] == pytest.approx(friction * g * engine.time, abs=2e-3)
    engine.advance(round(3 * slides / engine.timestep))
    assert engine.velocities()[0, 0] == pytest.approx(speed / 3, abs=2e-3)
