"""Spheres that were poured lie still, on one another, and stay."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from mesokit import (
    Box,
    Case,
    HardCollision,
    HardSpheres,
    Plates,
    PouredStart,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
)
from mesokit.errors import CaseError

KINDS = [SphereKind(1.0, spread=0.1)]


def poured(dimension, seed=1, method="soft-spheres", friction=0.5, **spheres):
    size = [12.0, 20.0] if dimension == 2 else [5.0, 5.0, 12.0]
    axis = "y" if dimension == 2 else "z"
    gravity = [0.0] * (dimension - 1) + [-1.0]
    section = SoftSpheres if method == "soft-spheres" else HardSpheres
    given = {"number": 100, "kinds": KINDS, "gravity": gravity, **spheres}
    case = Case(
        run=Run(0, seed=seed, method=method),
        box=Box(size),
        walls=[Plates(axis)],
        spheres=section(start=PouredStart(friction), **given),
    )
    return Simulation(case).engine


def contacts(engine, gap):
    """How many of the others, and of the floor, each touches, up to a gap."""
    places, radii, size = engine.positions(), engine.diameters() / 2, engine.box.copy()
    size[-1] *= 3
    pairs = cKDTree(places, boxsize=size).query_pairs(1.3, output_type="ndarray")
    way = places[pairs[:, 0]] - places[pairs[:, 1]]
    way -= size * np.rint(way / size)
    gaps = np.linalg.norm(way, axis=1) - radii[pairs].sum(axis=1)
    found = np.bincount(pairs[gaps < gap].ravel(), minlength=engine.n)
    return found + (places[:, -1] - radii < gap), gaps.min()


@pytest.mark.parametrize("dimension", [2, 3])
def test_each_lies_on_others_or_the_floor_and_on_none_by_more_than_a_hair(dimension):
    engine = poured(dimension)
    touching, nearest = contacts(engine, 0.006)
    assert -1e-3 < nearest < 0.006
    assert np.median(touching) >= 3
    assert (touching >= dimension - 1).mean() > 0.95  # rattlers apart
    assert np.abs(engine.velocities()).max() == 0.0
    top = np.sort(engine.positions()[:, -1])[-engine.n // 20 :].mean()
    volume = np.sum(engine.diameters() ** dimension) * (np.pi / (4 if dimension == 2 else 6))
    fraction = volume / (np.prod(engine.box[:-1]) * top)
    loose, ordered = (0.70, 0.91) if dimension == 2 else (0.50, 0.74)
    assert loose < fraction < ordered


def test_they_stay_where_they_lie():
    law = SpringDashpot(0.3, contact_time=0.005, friction=0.5)
    engine = poured(2, pair=law)
    before = engine.positions(unwrapped=True)
    engine.advance(20_000)
    assert np.abs(engine.positions(unwrapped=True) - before).max() < 0.01
    assert np.abs(engine.velocities()).max() < 1e-3


def test_a_seed_is_a_heap():
    one, two, other = poured(2).positions(), poured(2).positions(), poured(2, seed=2).positions()
    np.testing.assert_array_equal(one, two)
    assert np.abs(one - other).max() > 1


def test_hard_spheres_begin_from_it():
    engine = poured(2, method="event-driven", collision=HardCollision(0.9, contact_time=1e-3))
    assert contacts(engine, 0.006)[1] > 0
    engine.advance(2)
    assert engine.positions()[:, 1].max() < 14


def test_without_gravity_or_a_floor_nothing_is_poured():
    with pytest.raises(CaseError, match=r"'poured': expected gravity"):
        poured(2, gravity=[])
    with pytest.raises(CaseError, match=r"expected a wall"):
        poured(2, gravity=[-1.0, 0.0])
