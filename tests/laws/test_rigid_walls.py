"""Rigid grains at walls that move, and at walls of any shape."""

import math

import numpy as np
import pytest

from mesokit import (
    Cuboid,
    Disk,
    Plates,
    PouredStart,
    RandomStart,
    Rectangle,
    SphereKind,
    Surface,
    SurfaceContact,
    Union,
)
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel
from tests.helpers.rigid_grains import at_rest, energy, exact, from_walls, rigid

G = 1.0


# --- walls that are shaken ----------------------------------------------------------------------


def shaken(amplitude, frequency, speed=0.0, height=0.5, timestep=1e-3, restitution=None):
    contact = SurfaceContact(restitution=restitution, amplitude=amplitude, frequency=frequency)
    return rigid(
        [10, 10], walls=[Plates("y", lower=Surface(contact=contact))],
        given=at_rest([[5.0, height]], velocities=[[0.0, speed]]), gravity=[0.0, -G],
        contact={"restitution": 0.0}, timestep=timestep, solver=exact(),
    )  # fmt: skip


def test_a_grain_follows_a_floor_that_is_shaken_gently():
    amplitude, frequency = 0.2, 2.0  # 0.8 g at most
    engine = shaken(amplitude, frequency, speed=amplitude * frequency)
    engine.advance(200)
    for _ in range(20):
        engine.advance(173)
        height = 0.5 + amplitude * math.sin(frequency * engine.time)
        assert engine.positions()[0, 1] == pytest.approx(height, abs=1e-9)
        force = from_walls(engine)[0, 0, 1] / engine.timestep
        middle = engine.time - engine.timestep
        pushed = G - amplitude * frequency**2 * math.sin(frequency * middle)
        assert force == pytest.approx(pushed, abs=1e-5)


def test_a_grain_leaves_a_floor_that_falls_faster_than_it():
    amplitude, frequency = 0.2, 3.0  # 1.8 g: it flies where A w^2 sin > g
    engine = shaken(amplitude, frequency, speed=amplitude * frequency)
    leaves = math.asin(G / (amplitude * frequency**2)) / frequency
    engine.advance(math.ceil((leaves + 0.25) / engine.timestep))
    t = engine.time - leaves
    height = amplitude * math.sin(frequency * leaves)
    speed = amplitude * frequency * math.cos(frequency * leaves)
    flown = 0.5 + height + speed * t - 0.5 * G * t * t
    assert engine.positions()[0, 1] == pytest.approx(flown, abs=2e-3)
    assert flown > 0.505 + amplitude * math.sin(frequency * engine.time)
    assert not from_walls(engine).any()


@pytest.mark.parametrize("restitution", [0.0, 0.9])
def test_a_floor_pushes_as_it_moves(restitution):
    # one that goes up at the speed u: v' = u + e (v + u)
    up, fall = 0.1, 1.0
    contact = SurfaceContact(restitution=restitution, amplitude=0.5, frequency=up / 0.5)
    engine = rigid(
        [10, 10], walls=[Plates("y", lower=Surface(contact=contact))],
        given=at_rest([[5.0, 0.5023]], velocities=[[0.0, -fall]]), timestep=1e-3,
        contact={"restitution": 0.3},
    )  # fmt: skip
    engine.advance(20)
    expected = up + restitution * (fall + up)
    assert engine.velocities()[0, 1] == pytest.approx(expected, abs=1e-5)


# --- walls of any shape -------------------------------------------------------------------------


def thrown(walls, dimension, size, floor):
    """Some grains that fall on a floor at a height, and bounce and roll away."""
    places = np.array([[3.0, 3.0, 1.5], [4.2, 3.1, 2.0], [3.4, 3.5, 3.2]])
    velocities = np.array([[0.8, 0.1, 0.0], [-0.3, 0.2, -0.1], [0.0, 0.4, 0.1]])
    kept = [0, 2] if dimension == 2 else [0, 1, 2]
    spins = [0.7, -2.0, 1.0] if dimension == 2 else [[0.7, -2.0, 1.0]] * 3
    up = np.eye(dimension)[-1]
    return rigid(
        size, walls=walls, gravity=[0.0] * (dimension - 1) + [-2.0],
        given=at_rest(places[:, kept] + floor * up, velocities=velocities[:, kept], spins=spins),
        contact={"friction": 0.4, "restitution": 0.5, "rolling": 0.01}, timestep=0.002,
        solver=exact(),
    )  # fmt: skip


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.long)])
def test_a_block_is_as_good_a_floor_as_a_plate(dimension):
    if dimension == 2:
        block, size = Rectangle(centre=[6, 1], size=[12, 2]), [12, 10]
    else:
        block, size = Cuboid(centre=[6, 3, 1], size=[12, 6, 2]), [12, 6, 10]
    slab = thrown([block], dimension, size, 2.0)
    plate = thrown([Plates("yz"[dimension - 2])], dimension, [*size[:-1], 8], 0.0)
    below = 2.0 * np.eye(dimension)[-1]
    for _ in range(6):
        slab.advance(500)
        plate.advance(500)
        one, two = (each.positions(unwrapped=True) for each in (slab, plate))
        assert one - below == pytest.approx(two, abs=1e-6)
        assert slab.spins() == pytest.approx(plate.spins(), abs=1e-6)
    assert sum(slab.lost.values()) > 1.0
    assert slab.wall_impulse[0] == pytest.approx(plate.wall_impulse[0], abs=1e-6)


@pytest.mark.parametrize("angle", [20.0, 45.0, 60.0])
def test_a_grain_in_a_groove_presses_on_both_sides(angle):
    # two walls at an angle to the vertical: m g/(2 sin) on each, along its normal
    away, wide = 3.0, math.radians(angle)
    up = np.array([[-math.sin(wide), math.cos(wide)], [math.sin(wide), math.cos(wide)]])
    walls = []
    for side, along in zip((-1, 1), up, strict=True):
        normal = np.array([-side * along[1], side * along[0]])  # into the groove
        centre = np.array([16.0, 8.0]) + away * along - normal
        turned = math.degrees(math.atan2(along[1], along[0]))
        walls.append(Rectangle(centre=centre.tolist(), size=[8, 2], angle=turned))
    bottom = 0.5 / math.sin(wide)  # height of the centre above the edge
    engine = rigid(
        [32, 20], walls=walls, given=at_rest([[16.0, 8.0 + bottom]]), gravity=[0.0, -G],
        contact={"friction": 0.0}, timestep=0.01, solver=exact(),
    )  # fmt: skip
    engine.advance(20)
    engine.end_warmup()
    engine.advance(100)
    force = engine.wall_impulse / (100 * engine.timestep)
    size = G / (2 * math.sin(wide))
    assert np.linalg.norm(force, axis=1) == pytest.approx(size, rel=1e-9)
    assert force.sum(axis=0) == pytest.approx([0.0, -G], abs=1e-9)
    assert np.abs(engine.velocities()).max() < 1e-9


def test_a_block_that_moves_along_itself_drags_what_lies_on_it():
    # from rest friction pulls with mu m g, until the disk rolls: a third of the block's speed
    speed, friction = 0.6, 0.3
    block = Rectangle(centre=[6, 1], size=[12, 2], surface=Surface(velocity=[speed, 0.0]))
    engine = rigid(
        [12, 10], walls=[block], given=at_rest([[3.0, 2.5]]), gravity=[0.0, -G],
        contact={"friction": friction}, timestep=0.005, solver=exact(),
    )  # fmt: skip
    slides = speed / (3 * friction * G)
    engine.advance(round(0.6 * slides / engine.timestep))
    assert engine.velocities()[0, 0] == pytest.approx(friction * G * engine.time, abs=1e-8)
    engine.advance(round(3 * slides / engine.timestep))
    assert engine.velocities()[0, 0] == pytest.approx(speed / 3, abs=1e-8)


def test_a_drum_that_turns_drags_what_lies_in_it():
    rate, friction, radius = 0.5, 0.2, 4.5
    drum = Disk([5, 5], radius, fluid="inside", surface=Surface(rotation=rate))
    engine = rigid(
        [10, 10], walls=[drum], given=at_rest([[5.0, 1.0]]), gravity=[0.0, -G],
        contact={"friction": friction}, timestep=1e-3, solver=exact(),
    )  # fmt: skip
    engine.advance(100)
    t = engine.time
    assert engine.velocities()[0, 0] == pytest.approx(friction * G * t, rel=2e-3)
    assert engine.spins()[0] == pytest.approx(friction * G * t / 0.25, rel=2e-3)
    # m R'^2 angle'' = - m g R' sin + R' F; rolling: it swings about the bottom
    heights = []
    for _ in range(400):
        engine.advance(50)
        heights.append(engine.positions()[0, 1])
        out = engine.positions()[0] - 5
        assert np.linalg.norm(out) == pytest.approx(4.0, abs=1e-3)
    x, y = engine.positions()[0] - 5
    v = engine.velocities()[0]
    along = (-y * v[0] + x * v[1]) / 4.0
    assert along + 0.5 * engine.spins()[0] == pytest.approx(radius * rate, abs=1e-2)


def test_a_disk_rolls_in_a_pipe_by_its_fall():
    # v^2 = 4/3 g h, to first order in the step
    start, off = 1.2, []
    for timestep in (2e-3, 5e-4):
        place = [5 + 4 * math.sin(start), 5 - 4 * math.cos(start)]
        engine = rigid(
            [10, 10], walls=[Disk([5, 5], 4.5, fluid="inside")], given=at_rest([place]),
            gravity=[0.0, -G], contact={"friction": 2.0}, timestep=timestep, solver=exact(),
        )  # fmt: skip
        engine.advance(round(2.0 / timestep))
        fallen = place[1] - engine.positions()[0, 1]
        off.append((engine.velocities()[0] ** 2).sum() / (4 / 3 * G * fallen) - 1)
        assert engine.spins()[0] ** 2 == pytest.approx(
            (engine.velocities()[0] ** 2).sum() / 0.25, rel=0.01
        )
    assert abs(off[0]) < 0.01
    assert abs(off[1]) < 0.4 * abs(off[0])


def corner():
    return Union(
        parts=[Rectangle(centre=[6, 1], size=[12, 2]), Rectangle(centre=[1, 5], size=[2, 10])]
    )


def test_a_grain_rests_in_a_corner():
    engine = rigid(
        [12, 10], walls=[corner()], given=at_rest([[4.0, 4.0]]), gravity=[-1.0, -1.0],
        contact={"friction": 0.3}, timestep=0.01, solver=exact(),
    )  # fmt: skip
    engine.advance(1500)
    assert engine.positions()[0] == pytest.approx([2.5, 2.5], abs=1e-9)
    assert engine.velocities()[0] == pytest.approx([0.0, 0.0], abs=1e-9)
    force = engine.wall_impulse.sum(axis=0)
    assert force == pytest.approx([-engine.time] * 2, rel=1e-9)


def test_nothing_comes_into_a_solid_and_energy_is_accounted_for():
    block = Rectangle(centre=[8, 2], size=[9, 3], angle=20)
    engine = rigid(
        [16, 14], walls=[Plates("y"), block], number=60, kT=0.5, gravity=[0.0, -2.0],
        start=RandomStart(), contact={"friction": 0.5, "restitution": 0.3}, timestep=0.004,
        solver=GaussSeidel(sweeps=50),
    )  # fmt: skip
    solids = engine.system.given.listed.others.kept

    def books():
        return energy(engine) - engine.timestep * engine.totals()[1][1]

    first = books()
    for _ in range(8):
        engine.advance(250)
        assert solids.distance(engine.positions() % engine.box).min() > 0.499
        assert engine.positions()[:, 1].min() > 0.499
        assert books() == pytest.approx(first, abs=1e-8 * first)


def test_grains_are_poured_on_a_solid():
    block = Rectangle(centre=[8, 2], size=[9, 3], angle=20)
    engine = rigid(
        [16, 14], walls=[Plates("y"), block], number=60, gravity=[0.0, -2.0], start=PouredStart(),
        contact={"friction": 0.5}, timestep=0.004, solver=GaussSeidel(sweeps=50),
    )  # fmt: skip
    before = engine.positions(unwrapped=True)
    engine.advance(500)
    assert np.abs(engine.positions(unwrapped=True) - before).max() < 0.5


def silo(opens):
    """Spheres in a bin; a plug of 3 by 3 in its floor, at a height of 3, is taken away."""
    around = [([2.5, y, 2.5], [7, 2, 1]) for y in (0, 5)]
    around += [([x, 2.5, 2.5], [2, 3, 1]) for x in (0, 5)]
    floor = [Cuboid(centre=centre, size=size) for centre, size in around]
    plug = Cuboid(centre=[2.5, 2.5, 2.5], size=[3, 3, 1], opens=opens)
    places = np.array([0.65, 0.65, 3.65]) + 1.23 * np.indices((4, 4, 3)).reshape(3, -1).T
    velocities = np.random.default_rng(4).normal(size=places.shape)
    return rigid(
        [5, 5, 12], walls=[*floor, plug, *map(Plates, "xyz")], gravity=[0.0, 0.0, -G],
        kinds=[SphereKind(1.0, spread=0.1)], given=at_rest(places, velocities=velocities),
        contact={"friction": 0.4, "rolling": 0.2}, timestep=0.01,
        solver=GaussSeidel(sweeps=100, tolerance=1e-8),
    )  # fmt: skip


@pytest.mark.long
def test_a_silo_in_space_bears_its_filling_until_its_floor_is_opened():
    engine = silo(opens=14.5)
    weight = G * engine.masses().sum()
    engine.advance(1350)
    before = engine.wall_impulse
    engine.advance(50)
    force = (engine.wall_impulse - before) / (50 * engine.timestep) / weight
    # floor, plug and sides bear the weight; all push the filling together
    assert force.sum(axis=0) == pytest.approx([0.0, 0.0, -1.0], abs=1e-6)
    assert force[:5, 2].max() < -0.01
    assert (force[[5, 6, 7, 8], [0, 0, 1, 1]] * [-1, 1, -1, 1]).min() > 0.05
    found = engine.contacts()
    assert found.forces[found.at_walls].sum(axis=0) == pytest.approx([0, 0, weight], abs=1e-6)
    drags = found.tangential_forces / found.normal_forces
    assert found.normal_forces.min() > 0
    assert drags.max() == pytest.approx(0.4, rel=1e-6)  # some slid until they came to rest
    assert engine.positions()[:, 2].min() > 3.4
    # then grains leave by the hole, and only there; the plug is nothing to them
    engine.advance(50)
    taken, at_rest_before, passing = engine.wall_impulse, engine.totals()[1], []
    for _ in range(50):
        engine.advance(10)
        places = engine.positions()
        within = (places[:, 2] > 2) & (places[:, 2] < 3)
        beside = np.abs(places[:, :2] - 2.5).max(axis=1) + 0.5 * engine.diameters()
        passing += list(beside[within])
    assert len(passing) > 20
    assert max(passing) < 1.5 + 1e-3
    assert 8 < (places[:, 2] < 2).sum() < 40
    after = engine.wall_impulse - taken
    assert not after[4].any()
    left = after.sum(axis=0) + engine.totals()[1] - at_rest_before
    assert left == pytest.approx([0, 0, -weight * 5.0], abs=1e-10 * weight * 5.0)
