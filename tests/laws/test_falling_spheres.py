"""Event-driven dynamics with gravity and walls: bounces, weights, containers, moving floors."""

import math
import subprocess
import sys

import numpy as np
import pytest

from mesokit import (
    Cylinder,
    Disk,
    HardCollision,
    Plates,
    RandomStart,
    Rectangle,
    Sphere,
    SphereKind,
    Surface,
    SurfaceContact,
)
from tests.helpers.hard_spheres import gas


def ball(e, contact_time=0.0, timestep=0.5, floor=None):
    """One disk that falls from a height of 1 above a floor, with an acceleration of 1."""
    contact = floor or SurfaceContact(restitution=e)
    return gas(
        [4, 8],
        walls=[Plates("y", lower=Surface(contact=contact))],
        number=1,
        gravity=[0, -1],
        timestep=timestep,
        collision=HardCollision(contact_time=contact_time),
        given={"positions": [[1, 1.5]], "velocities": [[0, 0]]},
    ).engine


def test_a_thousand_elastic_bounces_are_exact():
    engine = ball(1.0)
    engine.advance(5657)
    bounces = engine.collisions[1]
    since = engine.time - math.sqrt(2) * (2 * bounces - 1)
    assert bounces == 1000
    height = math.sqrt(2) * since - since**2 / 2
    assert engine.positions()[0, 1] - 0.5 == pytest.approx(height, abs=1e-10)


def test_bounces_lose_as_much_as_they_should():
    e, first = 0.9, math.sqrt(2)
    time = first * (1 + 2 * sum(e**n for n in range(1, 40)))
    engine = ball(e, timestep=time)
    engine.advance(1)
    assert engine.positions()[0, 1] - 0.5 == pytest.approx(0, abs=1e-12)
    assert abs(engine.velocities()[0, 1]) == pytest.approx(first * e**39, rel=1e-9)


@pytest.mark.parametrize("e", [0.5, 0.8, 0.9])
@pytest.mark.parametrize("contact_time", [1e-2, 1e-4])
def test_ping_pong_with_a_contact_time(e, contact_time):
    stops = math.sqrt(2) * (1 + e) / (1 - e)
    engine = ball(e, contact_time)
    engine.advance(math.ceil(2 * stops) + 1)
    _, bounces, elastic = engine.collisions
    assert bounces - elastic == math.ceil(math.log(contact_time / math.sqrt(8)) / math.log(e))
    assert abs(engine.velocities()[0, 1]) < contact_time / 2


def test_the_floor_carries_the_weight():
    n, g, time = 60, 0.2, 200.0
    engine = gas(
        [10, 40], walls=[Plates("y")], number=n, gravity=[0, -g], timestep=time, start=RandomStart()
    ).engine
    before = engine.totals()[1][1]
    energy = sum(engine.energies().values())
    engine.advance(1)
    lower, upper = -engine.system.tally.impulse[:, 1]
    change = engine.totals()[1][1] - before
    assert lower + upper == pytest.approx(n * g * time + change, rel=1e-12)
    assert sum(engine.energies().values()) == pytest.approx(energy, rel=1e-12)


@pytest.mark.parametrize(
    "wall",
    [
        Disk(centre=[8, 8], radius=7, fluid="inside"),
        Rectangle(centre=[8, 8], size=[12, 10], angle=20, fluid="inside"),
        Sphere(centre=[8, 8, 8], radius=7, fluid="inside"),
        Cylinder(centre=[8, 8, 8], radius=7, fluid="inside"),
        Disk(centre=[8, 8], radius=3),
    ],
    ids=["disk", "rectangle", "sphere", "cylinder", "obstacle"],
)
def test_nothing_leaves_a_container_and_energy_is_kept(wall):
    d = 3 if 3 in wall.dimensions and 2 not in wall.dimensions else 2
    falls = wall.fluid == "inside"
    engine = gas(
        [16] * d,
        walls=[wall],
        number=40,
        gravity=[0, -0.3, 0][:d] if falls else [],
        timestep=1.0,
        start=RandomStart(),
    ).engine
    energy = sum(engine.energies().values())
    for _ in range(30):
        engine.advance(1)
        r = engine.positions() - 8
        r -= 16 * np.rint(r / 16)
        if isinstance(wall, Rectangle):
            turn = math.radians(20)
            x = r[:, 0] * math.cos(turn) + r[:, 1] * math.sin(turn)
            y = r[:, 1] * math.cos(turn) - r[:, 0] * math.sin(turn)
            assert np.abs(x).max() < 5.5 + 1e-12
            assert np.abs(y).max() < 4.5 + 1e-12
        else:
            away = np.linalg.norm(r[:, :2] if isinstance(wall, Cylinder) else r, axis=1)
            assert (away.max() < 6.5 + 1e-12) if falls else (away.min() > 3.5 - 1e-12)
    assert sum(engine.energies().values()) == pytest.approx(energy, rel=1e-11)
    assert engine.collisions[1] > 40


def test_a_vibrating_floor_is_never_crossed():
    amplitude, frequency = 0.1, 20.0
    floor = SurfaceContact(restitution=0.8, amplitude=amplitude, frequency=frequency)
    engine = ball(0.8, timestep=0.005, floor=floor)
    gaps, heights = [], []
    for _ in range(4000):
        engine.advance(1)
        height = engine.positions()[0, 1] - 0.5
        heights.append(height)
        gaps.append(height - amplitude * math.sin(frequency * engine.time))
    assert min(gaps) > -1e-10
    assert engine.collisions[1] > 4
    assert max(heights[2000:]) > 0.2  # it does not come to rest


@pytest.mark.parametrize("draw", range(60))
def test_no_floor_is_crossed_whatever_the_scales(draw):
    """Amplitudes, frequencies, speeds and sizes of six decades; flights of up to a thousand
    diameters."""
    amplitude, frequency, speed, radius = scales = 10 ** np.random.default_rng(draw).uniform(
        -3, 3, 4
    )
    radius, (far, fall) = max(radius, 1e-3), np.random.default_rng(scales.view(np.uint64)).random(2)
    height = max(3.0, 2 * (radius + amplitude) * 10 ** (0.5 + 2.5 * far))
    fastest = max(speed, amplitude * frequency)
    floor = SurfaceContact(restitution=1.0, amplitude=amplitude, frequency=frequency)
    engine = gas(
        [max(8 * radius, 3), height],
        walls=[Plates("y", lower=Surface(contact=floor))],
        number=1,
        kinds=[SphereKind(diameter=2 * radius)],
        gravity=[0, -(speed**2) / height * 10 ** (2 * fall - 1)],
        timestep=height / fastest / 20,
        given={"positions": [[4 * radius, height / 2]], "velocities": [[0, speed]]},
    ).engine
    gaps, tops = [], []
    for _ in range(60):
        engine.advance(1)
        place, moved = engine.positions()[0, 1], amplitude * math.sin(frequency * engine.time)
        gaps.append(place - radius - moved)
        tops.append(place + radius)
    known = 1e-11 * (height + amplitude * frequency * engine.timestep)
    assert min(gaps) > -known and max(tops) < height + known


@pytest.mark.parametrize("draw", range(40))
def test_nothing_leaves_a_round_vessel_whatever_the_scales(draw):
    """Down to a ten-thousandth of its size, speeds of six decades, with gravity or not."""
    rng, d = np.random.default_rng(draw), 2 + draw % 2
    vessel, speed = 10 ** rng.uniform(0.5, 1.5), 10 ** rng.uniform(-3, 3)
    size = max(vessel * 10 ** rng.uniform(-4, -0.3), 1.2e-3)
    middle, velocity = float(math.ceil(1.1 * vessel)), rng.normal(size=d)
    pull = speed**2 / vessel * 10 ** rng.uniform(-2, 1) if draw % 3 == 0 else 0.0
    engine = gas(
        [2 * middle] * d,
        walls=[(Disk if d == 2 else Sphere)([middle] * d, radius=vessel, fluid="inside")],
        number=1,
        kinds=[SphereKind(diameter=size)],
        start=RandomStart(),
        gravity=[0, -pull, 0][:d] if pull else [],
        timestep=vessel / speed,
        given={
            "positions": [middle + 0.1 * vessel * rng.uniform(-1, 1, d)],
            "velocities": [speed * velocity / np.linalg.norm(velocity)],
        },
    ).engine
    away = []
    for _ in range(100):
        engine.advance(1)
        away.append(np.linalg.norm(engine.positions()[0] - middle) + size / 2)
    assert max(away) < vessel * (1 + 1e-11)
    assert engine.collisions[1] > 10


def test_fast_disks_stay_above_a_vibrating_floor():
    floor = SurfaceContact(restitution=1.0, amplitude=0.3, frequency=20.0)
    engine = gas(
        [30, 500],
        walls=[Plates("y", lower=Surface(contact=floor))],
        number=30,
        kT=40.0,
        gravity=[0, -1],
        start=RandomStart(),
        timestep=4.0,
        collision=HardCollision(restitution=0.975, contact_time=1e-4),
    ).engine
    lowest = []
    for _ in range(60):
        engine.advance(1)
        lowest.append(engine.positions()[:, 1].min())
    assert min(lowest) > 0.5 - 0.3 - 1e-9
    assert engine.collisions[1] > 150


def test_a_search_that_fails_ends_the_run_in_a_line():
    program = """
from mesokit.method.spheres.hard.engine import walls
walls.STEPS = 2
from mesokit import *
floor = Surface(contact=SurfaceContact(restitution=1.0, amplitude=0.3, frequency=20))
case = Case(
    run=Run(50, method="event-driven"), box=Box([10, 40]), walls=[Plates("y", lower=floor)],
    spheres=HardSpheres(number=5, gravity=[0, -1], timestep=1.0),
)
try:
    Simulation(case).engine.advance(50)
except RunError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stdout.startswith("sphere ") and "no time found" in done.stdout, done.stderr


def test_walls_at_two_temperatures_heat_a_gas_to_their_geometric_mean():
    # few spheres that hardly meet: each wall sends out sqrt(kT) of theirs; sqrt(T1 T2)
    hot = Surface(rule="diffuse", contact=SurfaceContact(temperature=2.0))
    engine = gas(
        [10, 20], walls=[Plates("y", Surface(rule="diffuse"), hot)], number=12, timestep=20.0
    ).engine
    engine.advance(20)
    across = []
    for _ in range(1500):
        engine.advance(1)
        across.append((engine.velocities()[:, 1] ** 2).mean())
    error = np.std(across) / math.sqrt(len(across))
    assert abs(np.mean(across) - math.sqrt(2.0)) < 4 * error < 0.15


def test_a_moving_wall_drags_rough_spheres_along():
    lid = Surface(velocity=[0.5, 0], contact=SurfaceContact(tangential=1.0))
    rough = HardCollision(1.0, tangential=1.0)
    engine = gas(
        [12, 8], walls=[Plates("y", lid, lid)], number=30, timestep=50.0, collision=rough
    ).engine
    engine.advance(4)
    drift = engine.totals()[1][0] / engine.n
    assert drift == pytest.approx(0.5, abs=4 * math.sqrt(1.5 / engine.n))
