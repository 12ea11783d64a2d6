"""What contacts of rigid grains conserve, and books of what they take."""

import numpy as np
import pytest

from mesokit import Plates, RandomStart, SphereKind, Surface, SurfaceContact
from mesokit.method.spheres.rigid.engine.groups import SPEED
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel
from tests.helpers.rigid_grains import (
    at_rest,
    energy,
    exact,
    from_walls,
    impulses,
    net_impulse,
    rigid,
)

MIXED = [SphereKind(1.0, spread=0.2)]
ALL = {"friction": 0.4, "restitution": 0.5, "rolling": 0.05}
STICKY = ALL | {"cohesion": {"force": 0.3, "range": 0.02}}
BRIEF = GaussSeidel(sweeps=20)  # books do not ask for good forces


def poured(dimension, belt=0.0, number=60, contact=ALL, floor=None, roof=None, **given):
    """Grains that fall on a floor, which may move along x; floor, roof: how the plates move."""
    velocity = [belt] + [0.0] * (dimension - 1)
    lower = Surface(velocity=velocity, contact=None if floor is None else SurfaceContact(**floor))
    upper = Surface(contact=None if roof is None else SurfaceContact(**roof))
    size = [9.0, 24.0] if dimension == 2 else [6.0, 6.0, 9.0]
    given = {"kT": 0.5, "timestep": 0.01, "solver": BRIEF, **given}
    return rigid(
        size, walls=[Plates("xyz"[dimension - 1], lower=lower, upper=upper)], number=number,
        kinds=MIXED, gravity=[0.0] * (dimension - 1) + [-1.0], start=RandomStart(),
        contact=contact, **given,
    )  # fmt: skip


def weight_in_motion(engine):
    """Half a step of gravity times the momentum: by what a step mistakes the energy of a fall."""
    return 0.5 * engine.timestep * engine.totals()[1] @ np.array(engine.case.spheres.gravity)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("belt", [0.0, 0.7])
def test_energy_is_kinetic_potential_or_lost(dimension, belt):
    """The work of a floor that moves is minus the momentum it takes times its velocity."""
    engine = poured(dimension, belt)
    first = energy(engine) + weight_in_motion(engine)
    for _ in range(10):
        engine.advance(100)
        work = -belt * engine.wall_impulse[0, 0]
        now = energy(engine) + weight_in_motion(engine)
        assert now - work == pytest.approx(first, abs=1e-8 * first)
    lost = engine.lost
    assert min(lost.values()) > 1e-3 * first
    assert lost["impact"] > 0.2 * first


MOVES = {
    "none": {},
    "belt": {"belt": 0.7},
    "shaken": {"floor": {"amplitude": 0.1, "frequency": 9.0, "friction": 0.2}},
    "closing": {"roof": {"speed": 1.5, "travel": 4.0}},
    "pushed": {"roof": {"force": 30.0, "mass": 7.0}},
}


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("moves", list(MOVES))
def test_walls_take_the_weight_times_the_time_less_what_grains_gain(dimension, moves):
    engine = poured(dimension, contact=STICKY, **MOVES[moves])
    first, weight = engine.totals()[1], engine.masses().sum()
    down = -np.eye(dimension)[-1]
    gained, touched = [], 1 + int("roof" in MOVES[moves])
    for _ in range(10):
        engine.advance(40)
        given = weight * engine.time
        gained.append(engine.totals()[1] - first)
        left = engine.wall_impulse.sum(axis=0) + gained[-1] - given * down
        assert np.abs(left).max() < 1e-10 * given
    assert np.abs(gained).max() > 0.1 * weight  # they are on their way
    assert np.abs(engine.wall_impulse[:touched, -1]).min() > 0.02 * given


def test_a_pushed_plate_gains_what_its_force_gives_it_and_grains():
    engine = poured(2, contact=STICKY, **MOVES["pushed"])
    for _ in range(10):
        engine.advance(40)
        taken, speed = engine.wall_impulse[1, 1], engine.system.plates[1, SPEED]
        assert 7.0 * speed == pytest.approx(30.0 * engine.time - taken, abs=1e-9 * engine.time)
    assert taken > 0.1 * 30.0 * engine.time


@pytest.mark.parametrize("dimension", [2, 3])
def test_smooth_grains_have_no_friction_however_contacts_turn(dimension):
    engine = poured(dimension, contact={"friction": 0.0, "restitution": 0.2})
    engine.advance(700)
    assert len(impulses(engine)[0]) > 20
    assert engine.lost["friction"] == 0.0
    assert not engine.spins().any()


@pytest.mark.parametrize("dimension", [2, 3])
def test_momentum_of_a_periodic_box_is_conserved(dimension):
    size = [10.0, 9.0] if dimension == 2 else [6.0, 5.0, 6.0]
    engine = rigid(
        size, number=60, kinds=MIXED, start=RandomStart(), kT=1.0, contact=ALL, timestep=0.01,
        solver=BRIEF,
    )  # fmt: skip
    first = engine.totals()[1]
    kinetic = engine.totals()[2]
    engine.advance(400)
    assert engine.totals()[1] == pytest.approx(first, abs=1e-12 * 60)
    assert engine.totals()[2] < 0.7 * kinetic  # they did collide


def in_space(vectors):
    """Vectors (n, d) with three components."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def angular_momentum(engine):
    r, v, m = engine.positions(unwrapped=True), engine.velocities(), engine.masses()
    spins = engine.spins()
    orbit = m @ np.cross(in_space(r), in_space(v))
    spun = np.pad(spins[:, None], ((0, 0), (2, 0))) if spins.ndim == 1 else spins
    return orbit + engine.made.inertia @ spun


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("restitution", [0.0, 0.6])
def test_two_that_touch_keep_their_angular_momentum(dimension, restitution):
    along = np.array([0.6, 0.8, 0.0])[:dimension] if dimension == 2 else np.array([2.0, 2, 1]) / 3
    places = np.array([[5.0] * dimension, 5.0 + 1.5 * along])
    velocities = np.array([[1.0, 0.3, 0.5], [-1.0, 0.5, -0.8]])[:, :dimension]
    spins = np.array([3.0, -8.0]) if dimension == 2 else np.array([[3.0, 1, -2], [0.5, -4, 6]])
    engine = rigid(
        [12.0] * dimension, given=at_rest(places, velocities=velocities, spins=spins), number=2,
        kinds=[SphereKind(1.0, mass=1.0), SphereKind(2.0, mass=3.0)], timestep=1e-3,
        contact={"friction": 0.3, "rolling": 0.2, "restitution": restitution}, solver=exact(),
    )  # fmt: skip
    first, spun = angular_momentum(engine), engine.spins()
    engine.advance(1)
    assert np.abs(engine.spins() - spun).max() > 0.1
    assert min(engine.lost.values()) > 0.01
    assert angular_momentum(engine) == pytest.approx(first, abs=1e-12)


def turned_by(engine):
    """Angular impulse (n, 3) of forces of contacts about each centre in the last step."""
    pairs, found = impulses(engine)
    places = engine.positions() - engine.timestep * engine.velocities()  # where forces were found
    radii = 0.5 * engine.diameters()
    apart = places[pairs[:, 1]] - places[pairs[:, 0]]
    apart -= engine.box * np.rint(apart / engine.box) * [*[1.0] * (engine.dimension - 1), 0.0]
    out = apart / np.linalg.norm(apart, axis=1)[:, None]
    twist, total = np.cross(in_space(out), in_space(found)), np.zeros((engine.n, 3))
    np.add.at(total, pairs[:, 0], radii[pairs[:, 0], None] * twist)
    np.add.at(total, pairs[:, 1], radii[pairs[:, 1], None] * twist)
    floor = in_space(from_walls(engine)[:, 0])
    down = np.zeros(3)
    down[engine.dimension - 1] = -1.0
    return total + radii[:, None] * np.cross(down, floor)


@pytest.mark.parametrize("dimension", [2, 3])
def test_each_grain_moves_by_the_forces_that_are_reported(dimension):
    engine = poured(dimension, contact={"friction": 0.4, "restitution": 0.3})
    engine.advance(800)
    v, spins = engine.velocities(), engine.spins()
    engine.advance(1)
    m, g = engine.masses()[:, None], np.array(engine.case.spheres.gravity)
    gained = m * (engine.velocities() - v - engine.timestep * g)
    assert len(impulses(engine)[0]) > 30
    assert gained == pytest.approx(net_impulse(engine), abs=1e-12)
    spun = engine.made.inertia[:, None] * (engine.spins() - spins).reshape(engine.n, -1)
    assert spun == pytest.approx(turned_by(engine)[:, -spun.shape[1] :], abs=1e-12)
    assert np.abs(spun).max() > 1e-5


@pytest.mark.parametrize("dimension", [2, 3])
def test_forces_at_rest_carry_the_weight_and_obey_coulomb(dimension):
    engine = poured(
        dimension, contact={"friction": 0.4}, solver=GaussSeidel(sweeps=300, tolerance=1e-7)
    )
    engine.advance(1500)
    engine.end_warmup()
    before = engine.totals()[1]
    engine.advance(500)
    weight, time = engine.masses().sum(), 500 * engine.timestep
    # gravity's momentum is all in the floor, but for what grains have
    taken = (engine.wall_impulse[0] + engine.totals()[1] - before) / (weight * time)
    assert taken == pytest.approx([0.0] * (dimension - 1) + [-1.0], abs=1e-9)
    assert np.abs(engine.totals()[1]).max() < 1e-3 * weight * time
    mg = engine.masses()[:, None] * np.array(engine.case.spheres.gravity)
    held = (np.abs(engine.velocities()) < 1e-6).all(axis=1)
    assert held.mean() > 0.9
    assert np.abs(net_impulse(engine) / engine.timestep + mg)[held].max() < 1e-3
    pairs, found = impulses(engine)
    r = engine.positions()
    apart = r[pairs[:, 0]] - r[pairs[:, 1]]
    apart -= engine.box * np.rint(apart / engine.box) * [*[1.0] * (dimension - 1), 0.0]
    normal = apart / np.linalg.norm(apart, axis=1)[:, None]
    push = (found * normal).sum(axis=1)
    drag = np.linalg.norm(found - push[:, None] * normal, axis=1)
    assert push.min() > 0
    assert (drag / push).max() < 0.4 * (1 + 1e-4)
    assert (drag / push).max() > 0.3
