"""Plates that move or are pushed into the box, and walls that are taken away."""

import math

import numpy as np
import pytest

from mesokit import Disk, Plates, RandomStart, Rectangle, SphereKind, Surface, SurfaceContact
from tests.helpers.rigid_grains import at_rest, energy, exact, rigid, same
from tests.helpers.soft_spheres import ROUGH, soft

G = 1.0


def plates(lower=None, upper=None, axis="y"):
    """Plates with what contacts are at each of the two."""
    surfaces = [Surface(contact=None if c is None else SurfaceContact(**c)) for c in (lower, upper)]
    return Plates(axis, lower=surfaces[0], upper=surfaces[1])


def column(n=3, walls=None, **given):
    """Grains on one another, between plates 10 apart."""
    return rigid(
        [8, 10], walls=walls, given=at_rest([[4.0, 0.5 + i] for i in range(n)]), timestep=0.01,
        contact={"friction": 0.5}, solver=exact(sweeps=100_000), **given,
    )  # fmt: skip


@pytest.mark.parametrize(("given", "mass"), [({"mass": 2.0}, 2.0), ({}, 3.0)])
def test_a_plate_that_nothing_stops_is_accelerated_by_its_force(given, mass):
    engine = column(3, [plates(upper={"force": 3.0, **given})])  # or the mass of all grains
    engine.advance(100)
    # v grows by F dt/M in a step, and places follow the new velocity
    assert engine.plate_shifts[1] == pytest.approx(3 / mass * 0.01**2 * 100 * 101 / 2, rel=1e-12)
    assert engine.plate_shifts[0] == 0


def test_a_pushed_plate_comes_to_rest_on_grains_which_carry_its_force():
    engine = column(3, [plates(upper={"force": 5.0, "mass": 1.0})], gravity=[0.0, -G])
    engine.advance(600)
    assert engine.plate_shifts[1] == pytest.approx(10 - 3, abs=1e-9)
    before = engine.wall_impulse
    engine.advance(100)
    force = (engine.wall_impulse - before) / (100 * engine.timestep)
    assert force[1] == pytest.approx([0, 5.0], abs=1e-9)
    assert force[0] == pytest.approx([0, -(5.0 + 3 * G)], abs=1e-9)


def test_an_impact_on_a_pushed_plate_keeps_momentum_and_energy():
    bounces = {"force": 1e-9, "mass": 3.0, "restitution": 1.0}
    given = at_rest([[4.0, 5.0]], velocities=[[0.0, 2.0]])
    engine = rigid([8, 10], walls=[plates(upper=bounces)], given=given, timestep=0.01)
    engine.advance(300)
    # an elastic collision of masses 1 and 3, at rest before
    assert engine.velocities()[0] == pytest.approx([0.0, (1 - 3) / 4 * 2.0], abs=1e-6)
    assert engine.system.plates[1, 1] == pytest.approx(-2 * 1 / 4 * 2.0, abs=1e-6)


def test_pressure_is_force_per_area_between_the_other_plates():
    walls = [
        plates(upper={"pressure": 2.0, "mass": 5.0}),
        plates(upper={"speed": 1.0, "travel": 3.0}, axis="x"),
    ]
    given = at_rest([[1.0, 0.5], [2.0, 0.5]])
    engine = rigid([8, 10], walls=walls, given=given, timestep=0.01, solver=exact())
    engine.advance(1000)
    before = engine.wall_impulse
    engine.advance(100)
    force = (engine.wall_impulse - before) / (100 * engine.timestep)
    assert engine.plate_shifts.tolist() == pytest.approx([0, 9, 0, 3], abs=1e-6)
    assert force[1, 1] == pytest.approx(2.0 * (8 - 3), rel=1e-6)


def test_a_plate_moves_at_its_speed_as_far_as_it_is_told():
    walls = [plates(lower={"speed": 0.5, "travel": 2.0})]
    engine = column(1, walls)
    engine.advance(200)
    assert engine.positions()[0, 1] == pytest.approx(0.5 + 0.5 * 2.0, abs=1e-9)
    assert engine.velocities()[0] == pytest.approx([0, 0.5], abs=1e-12)
    engine.advance(600)
    assert engine.plate_shifts[0] == 2.0
    assert engine.velocities()[0] == pytest.approx([0, 0.5], abs=1e-12)  # it flies on


METHODS = {
    "rigid": (rigid, {"timestep": 0.005, "solver": exact()}),
    "soft": (soft, {"number": 1, "start": RandomStart(), "pair": ROUGH}),
}


def one_grain(method, walls, place):
    """A grain at a place under gravity."""
    make, given = METHODS[method]
    return make([8, 10], walls=walls, given=at_rest([place]), gravity=[0.0, -G], **given)


def test_soft_spheres_are_moved_by_plates_as_well():
    engine = one_grain("soft", [plates(lower={"speed": 0.5, "travel": 2.0})], [4.0, 0.5])
    engine.advance(round(12.0 / engine.timestep))
    assert engine.positions()[0, 1] == pytest.approx(2.5, abs=0.02)


@pytest.mark.parametrize("method", ["rigid", "soft"])
@pytest.mark.parametrize(("speed", "travel"), [(0.5, 2.0), (-0.5, 0.4)])
def test_a_plate_that_has_moved_its_way_is_a_plate_at_rest(method, speed, travel):
    heights = []
    for lower in (None, {"speed": speed, "travel": travel}):
        engine = one_grain(method, [plates(lower=lower)], [4.0, 0.5])
        engine.advance(round(12.0 / engine.timestep))
        assert engine.velocities()[0] == pytest.approx([0, 0], abs=1e-9)
        heights.append(engine.positions()[0, 1])
    moved = math.copysign(travel, speed)  # into the box, or out of it
    assert heights[1] - heights[0] == pytest.approx(moved, abs=1e-9)


@pytest.mark.parametrize("method", ["rigid", "soft"])
def test_a_grain_falls_when_the_disk_below_it_is_taken_away(method):
    disk = Disk([4, 3], 1.0, opens=1.0)
    engine = one_grain(method, [disk, Plates("y")], [4.0, 4.5])
    for time, height in ((1.0, 4.5), (2.0, 4.0)):
        engine.advance(round(time / engine.timestep) - engine.step)
        assert engine.positions()[0] == pytest.approx([4.0, height], abs=2e-2)


def on_a_plug(make, opens=1.0, **given):
    """A grain on a plug in a floor, and one on the floor beside it."""
    floor = [Rectangle(centre=[x, 3], size=[3, 2]) for x in (1.5, 6.5)]
    plug = Rectangle(centre=[4, 3], size=[2, 2], opens=opens)
    return make(
        [8, 10], walls=[*floor, plug, Plates("y")], given=at_rest([[4.0, 4.5], [1.5, 4.5]]),
        gravity=[0.0, -G], **given,
    )  # fmt: skip


@pytest.mark.parametrize("method", ["rigid", "soft"])
def test_a_grain_falls_when_the_plug_below_it_is_taken_away(method):
    given = {"timestep": 0.005, "solver": exact()} if method == "rigid" else {
        "number": 2, "start": RandomStart(), "pair": ROUGH,
    }  # fmt: skip
    engine = on_a_plug(rigid if method == "rigid" else soft, **given)
    engine.advance(round(1.0 / engine.timestep))
    assert engine.positions()[:, 1] == pytest.approx([4.5, 4.5], abs=1e-2)
    engine.advance(round(1.0 / engine.timestep))
    assert engine.positions()[0, 1] == pytest.approx(4.5 - 0.5 * G * 1.0**2, abs=2e-2)
    assert engine.positions()[1, 1] == pytest.approx(4.5, abs=1e-2)


def test_a_grain_at_the_edge_of_a_plug_stays_on_the_floor_beside_it():
    floor = [Rectangle(centre=[x, 3], size=[3, 2]) for x in (1.5, 6.5)]
    plug = Rectangle(centre=[4, 3], size=[2, 2], opens=0.5)
    engine = rigid(
        [8, 10], walls=[*floor, plug, Plates("y")], given=at_rest([[2.9, 4.5]]),
        gravity=[0.0, -G], timestep=0.005, solver=exact(),
    )  # fmt: skip
    engine.advance(400)
    assert engine.positions()[0] == pytest.approx([2.9, 4.5], abs=1e-3)


def pressed(threads=1):
    """Grains pressed together by a plate across each axis."""
    walls = [plates(upper={"pressure": 1.0}), plates(upper={"force": 6.0, "mass": 9.0}, axis="x")]
    return rigid(
        [8, 8], walls=walls, number=25, kinds=[SphereKind(1.0, spread=0.2)], start=RandomStart(),
        contact={"friction": 0.3}, timestep=0.02, threads=threads,
    )  # fmt: skip


def test_pushed_plates_go_on_to_the_same_bits_on_any_threads():
    whole, other = pressed(), pressed(2)
    whole.advance(300)
    state = {name: array.copy() for name, array in whole.state().items()}
    whole.advance(200)
    other.restore(state)
    other.advance(200)
    assert same(whole, other)
    assert whole.plate_shifts[1] > 1


def test_pressure_presses_grains_to_a_packing_that_carries_it():
    engine = pressed()
    engine.advance(6000)
    before = engine.wall_impulse
    engine.advance(200)
    force = (engine.wall_impulse - before) / (200 * engine.timestep)
    width, _ = engine.room_between_plates
    assert force[1, 1] == pytest.approx(1.0 * width, rel=1e-3)
    assert force[3, 0] == pytest.approx(6.0, rel=1e-3)
    assert force.sum(axis=0) == pytest.approx([0, 0], abs=1e-3)
    assert math.prod(engine.room_between_plates) < 0.6 * 64
    assert np.isfinite(energy(engine))
