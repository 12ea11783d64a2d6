"""Contacts of soft spheres in closed form: friction, rolling, walls, springs; and baths."""

import math

import numpy as np
import pytest

from mesokit import (
    Disk,
    HertzLaw,
    Langevin,
    Plates,
    RandomStart,
    SphereKind,
    SpringDashpot,
    Surface,
    SurfaceContact,
)
from tests.helpers.soft_spheres import at_rest, soft, total

G = 10.0


def on_floor(dimension, lower=None, spheres=1, speed=0.0, **law):
    """One sphere that lies on a floor along x, at its place there."""
    pair = SpringDashpot(0.3, contact_time=0.01, **law)
    k, _ = pair.constants(1.0)
    place = [5.0, *[5.0] * (dimension - 2), 0.5 - G / k]
    velocity = [[speed, *[0.0] * (dimension - 1)]]
    return soft(
        [40.0, *[40.0] * (dimension - 2), 5.0],
        walls=[Plates("xyz"[dimension - 1], **({} if lower is None else {"lower": lower}))],
        given=at_rest([place], velocities=velocity), number=1, pair=pair,
        kinds=[SphereKind(1.0, mass=1.0)], gravity=[*[0.0] * (dimension - 1), -G],
    )  # fmt: skip


def turn(engine):
    """How fast the surface at the floor moves along x by the spin, for a sphere of radius 1/2."""
    spins = engine.spins()
    return 0.5 * (spins[0] if spins.ndim == 1 else -spins[0, 1])


# --- friction and walls -------------------------------------------------------------------------


@pytest.mark.parametrize("belt", [0.0, 1.5])
@pytest.mark.parametrize(("dimension", "share"), [(2, 1 / 2), (3, 2 / 5)])
def test_what_slides_on_a_floor_ends_in_rolling(dimension, share, belt):
    # I = share m r^2; sliding takes mu g per time until v r = omega: v_0/(1 + share) of the belt
    friction, speed = 0.2, 1.0
    lower = Surface(velocity=[belt, *[0.0] * (dimension - 1)])
    engine = on_floor(dimension, lower, speed=speed, friction=friction)
    slip = speed - belt
    end = abs(slip) * share / (1 + share) / (friction * G)
    for part in (0.25, 0.5, 0.75):
        engine.advance(round(part * end / engine.timestep) - engine.step)
        lost = math.copysign(friction * G * engine.time, slip)
        assert engine.velocities()[0, 0] == pytest.approx(speed - lost, abs=2e-3)
        assert turn(engine) == pytest.approx(-lost / share, abs=4e-3)
    engine.advance(round(3 * end / engine.timestep))
    rolling = belt + slip / (1 + share)
    assert engine.velocities()[0, 0] == pytest.approx(rolling, abs=2e-3)
    assert engine.velocities()[0, 0] + turn(engine) == pytest.approx(belt, abs=1e-3)


@pytest.mark.parametrize(
    ("lower", "friction"),
    [
        (Surface(), 0.5),
        (Surface(contact=SurfaceContact(friction=0.1)), 0.1),
        (Surface(rule="slip"), 0.0),
    ],
)
def test_a_wall_has_a_friction_of_its_own(lower, friction):
    engine = on_floor(2, lower, speed=5.0, friction=0.5)
    engine.advance(500)
    assert 5.0 - engine.velocities()[0, 0] == pytest.approx(friction * G * engine.time, abs=2e-3)


@pytest.mark.parametrize("restitution", [None, 0.9])
@pytest.mark.parametrize("floor", [0.0, 0.1])
def test_a_wall_has_a_restitution_of_its_own_and_pushes_as_it_moves(restitution, floor):
    # a floor that goes up at the speed u: v' = u + e (v + u)
    given = {} if floor == 0 else {"amplitude": 0.5, "frequency": floor / 0.5}
    contact = SurfaceContact(restitution=restitution, **given)
    engine = soft(
        [10.0, 10.0], walls=[Plates("y", lower=Surface(contact=contact))],
        given=at_rest([[5.0, 0.502]], velocities=[[0.0, -1.0]]), number=1,
        pair=SpringDashpot(0.3, contact_time=0.002),
    )  # fmt: skip
    engine.advance(200)
    e = 0.3 if restitution is None else restitution
    assert engine.velocities()[0, 1] == pytest.approx(floor + e * (1 + floor), abs=2e-3)


def test_friction_acts_along_a_round_wall_wherever_it_is():
    # a disk rolls in a pipe: v^2 = (4/3) g h, friction a third of the weight along the slope
    law, radius, start = SpringDashpot(1.0, contact_time=0.005, friction=2.0), 4.5, 1.2
    place = [5 + 4 * math.sin(start), 5 - 4 * math.cos(start)]
    engine = soft(
        [10.0, 10.0], walls=[Disk([5, 5], radius, fluid="inside")], given=at_rest([place]),
        number=1, start=RandomStart(), pair=law, kinds=[SphereKind(1.0, mass=1.0)],
        gravity=[0.0, -G],
    )  # fmt: skip
    k, _ = law.constants(1.0)
    angles, normal, along, speeds = [], [], [], []
    for _ in range(2600):
        engine.advance(10)
        r = engine.positions()[0] - 5
        length = np.linalg.norm(r)
        out, force = -r / length, engine.forces()[0]
        angles.append(math.atan2(r[0], -r[1]))
        normal.append(force @ out - k * (length - 4))
        along.append(force @ np.array([-out[1], out[0]]))
        speeds.append((engine.velocities()[0] ** 2).sum())
    angles, speeds = np.array(angles), np.array(speeds)
    assert angles.min() < -0.9 * start
    assert np.abs(normal).max() < 1e-6 * k * 0.01
    expected = 4 / 3 * G * 4 * (np.cos(angles) - math.cos(start))
    assert np.abs(speeds - expected).max() < 0.02 * expected.max()
    smooth = np.convolve(along, np.ones(100) / 100, "valid")
    weight = np.convolve(G / 3 * np.sin(angles), np.ones(100) / 100, "valid")
    assert np.abs(np.abs(smooth) - np.abs(weight)).max() < 0.05 * G / 3


# --- pairs --------------------------------------------------------------------------------------


def two(law, spins=(0.0, 0.0), aside=0.0, dimension=2, apart=0.001):
    """A disk or sphere of radius 1/2 and one of radius 1 that meet at a speed of 1, with spins
    about z; `aside`: how far centres miss one another."""
    kinds = [SphereKind(1.0, mass=1.0), SphereKind(2.0, mass=3.0)]
    distance = math.sqrt((1.5 + apart) ** 2 - aside**2)
    places = [[5.0, 5.0], [5.0 + distance, 5.0 + aside]]
    velocities = [[0.75, 0.0], [-0.25, 0.0]]  # no momentum
    arrays = {"spins": np.array(spins)}
    if dimension == 3:
        places, velocities = (
            [[*row, z] for row in rows] for rows, z in ((places, 5.0), (velocities, 0.0))
        )
        arrays = {"spins": np.outer(spins, [0.0, 0.0, 1.0])}
    given = at_rest(places, velocities=np.array(velocities), **arrays)
    return soft([12.0] * dimension, given=given, number=2, kinds=kinds, pair=law)


def about_z(engine):
    return engine.spins().reshape(2, -1)[:, -1]


@pytest.mark.parametrize(("dimension", "share"), [(2, 1 / 2), (3, 2 / 5)])
@pytest.mark.parametrize("spins", [(30.0, 15.0), (-20.0, 0.0), (0.0, 20.0), (40.0, -5.0)])
def test_two_that_slip_give_one_another_mu_times_the_normal_impulse(dimension, share, spins):
    # elastic: the normal impulse is 2 m v; surfaces slip by r_1 omega_1 + r_2 omega_2
    friction, mass = 0.1, 0.75
    engine = two(
        SpringDashpot(1.0, contact_time=0.001, friction=friction), spins, dimension=dimension
    )
    engine.advance(200)
    push = math.copysign(2 * mass * friction, 0.5 * spins[0] + spins[1])
    change = about_z(engine) - np.array(spins)
    levers = np.array([0.5, 1.0]) / (share * np.array([0.25, 3.0]))
    assert change == pytest.approx(-push * levers, rel=0.02)
    across = engine.velocities()[:, 1]
    assert across == pytest.approx([-push, push / 3], rel=0.02)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("spins", [(3.0, 8.0), (-6.0, 4.0)])
def test_two_rough_ones_keep_their_angular_momentum(dimension, spins):
    law = SpringDashpot(0.7, contact_time=0.0005, friction=0.6, rolling=0.4, tangential_damping=0.5)
    engine = two(law, spins, 0.6, dimension)

    def angular():
        m, inertia = engine.masses(), engine.made.inertia
        r, v = engine.positions(unwrapped=True), engine.velocities()
        orbit = m * (r[:, 0] * v[:, 1] - r[:, 1] * v[:, 0])
        return orbit.sum() + inertia @ about_z(engine)

    before, spun = angular(), about_z(engine).copy()
    engine.advance(300)
    exchanged = np.abs(engine.made.inertia * (about_z(engine) - spun)).max()
    assert exchanged > 0.05
    assert abs(angular() - before) < 2e-3 * exchanged  # overlaps over radii


@pytest.mark.parametrize("law", [
    HertzLaw(stiffness=1e5),
    SpringDashpot(stiffness=1e5, damping=0.0),
    SpringDashpot(stiffness=1e5, damping=0.0, friction=1e4, tangential_damping=0.0),
])  # fmt: skip
def test_springs_hold_what_energy_they_take(law):
    rough = law.friction > 0
    engine = two(law, (2.0, 1.0) if rough else (0.0, 0.0), 0.7 if rough else 0.0)
    first, kinetic, totals = total(engine), [], []
    step = engine.timestep
    for _ in range(round(1.5 * law.contact_time_of(0.75, 1.0) / step) + 10):
        engine.advance(1)
        energies = engine.energies()
        kinetic.append(energies["translation"] + energies["rotation"])
        totals.append(total(engine))
    assert min(kinetic) < (0.6 if rough else 0.01) * first
    assert np.abs(np.array(totals) / first - 1).max() < (0.015 if rough else 1e-3)


@pytest.mark.parametrize(("rolling", "rolls"), [(0.25, True), (0.4, False)])
def test_resistance_to_rolling_holds_up_to_its_coefficient(rolling, rolls):
    # a disk: a = g (sin - mu_r cos)/(3/2), none where tan < mu_r
    angle = math.atan(0.3)
    law = SpringDashpot(0.3, contact_time=0.01, friction=2.0, rolling=rolling)
    k, _ = law.constants(1.0)
    engine = soft(
        [40.0, 5.0], walls=[Plates("y")], number=1, pair=law, kinds=[SphereKind(1.0, mass=1.0)],
        given=at_rest([[5.0, 0.5 - G * math.cos(angle) / k]]),
        gravity=[G * math.sin(angle), -G * math.cos(angle)],
    )  # fmt: skip
    engine.advance(5000)
    along = G * (math.sin(angle) - rolling * math.cos(angle)) / 1.5
    expected = along * engine.time if rolls else 0.0
    assert engine.velocities()[0, 0] == pytest.approx(expected, abs=0.01 * G / 1.5 * 0.3)


# --- baths --------------------------------------------------------------------------------------


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_bath_slows_what_flies_and_warms_what_turns(dimension):
    # velocities decay as exp(-friction t); spins come to kT for each way to turn
    side = 40 if dimension == 2 else 12
    number = side**dimension
    grid = np.stack(np.meshgrid(*[np.arange(side)] * dimension), -1).reshape(number, dimension)
    velocities = np.zeros((number, dimension))
    velocities[:, 0] = 1.0
    start = at_rest(2.0 * grid + 1.0, velocities=velocities)
    engine = soft(
        [2.0 * side] * dimension, given=start, number=number, timestep=2e-4,
        pair=SpringDashpot(1.0, contact_time=0.01, friction=0.5), kinds=[SphereKind(1.0, mass=2.0)],
        thermostat=Langevin(kT=0.01, friction=2.0),
    )  # fmt: skip
    engine.advance(2500)
    error = math.sqrt(0.01 / 2 / number)
    assert abs(engine.velocities()[:, 0].mean() - math.exp(-1)) < 4 * error
    turned = 0.5 * number * (1 if dimension == 2 else 3)
    warmed = 0.01 * turned * (1 - math.exp(-2 * 2.0 * engine.time))
    assert abs(engine.energies()["rotation"] / warmed - 1) < 4 / math.sqrt(turned)
