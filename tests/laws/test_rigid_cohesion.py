"""Grains that pull one another at short range."""

import math

import numpy as np
import pytest

from mesokit import Plates, RandomStart, SphereKind
from tests.helpers.rigid_grains import at_rest, exact, rigid

G = 1.0


def hanging(n, force, reach=0.01):
    """A row of grains that hangs from the upper plate."""
    engine = rigid(
        [8, 16], walls=[Plates("y")], given=at_rest([[4.0, 15.5 - i] for i in range(n)]),
        gravity=[0.0, -G], timestep=0.002, solver=exact(),
        contact={"friction": 0.5, "cohesion": {"force": force, "range": reach}},
    )  # fmt: skip
    engine.advance(200)
    return engine


def test_a_chain_hangs_as_long_as_its_weight_is_below_the_force():
    holds, breaks = hanging(5, 5.05), hanging(5, 4.95)
    assert np.abs(holds.velocities()).max() < 1e-9
    assert holds.wall_impulse[1] == pytest.approx([0.0, -5 * G * holds.time], rel=1e-9, abs=1e-9)
    # the upper plate holds the most, and lets go first; the rest falls as one, pulled within the
    # range: by 0.05 of its weight too much over 0.01, which takes sqrt(2)
    speeds = breaks.velocities()[:, 1]
    assert speeds == pytest.approx(speeds[0], abs=1e-9)
    t = breaks.time
    assert speeds[0] == pytest.approx(-0.01 * G * t, abs=1e-9)
    assert breaks.wall_impulse[1] == pytest.approx([0.0, -4.95 * t], abs=1e-9)
    breaks.advance(1200)
    late = math.sqrt(2 * 0.01 / (0.01 * G))  # then it falls freely
    fallen = -0.01 * G * late - G * (breaks.time - late)
    assert breaks.velocities()[:, 1] == pytest.approx(fallen, abs=5e-3)


def parted(share, force=3.0, reach=0.05, dimension=2):
    """Relative speed, at a time when two have parted or have not, of two that touch and move apart
    with a share of the work that this takes."""
    mass = 0.5
    speed = math.sqrt(2 * share * force * reach / mass)
    middle = [4.0] * (dimension - 1)
    places = [[4.0, *middle], [5.0, *middle]]
    still = [0.0] * (dimension - 1)
    engine = rigid(
        [10.0] * dimension, timestep=2e-4, solver=exact(),
        given=at_rest(places, velocities=[[-0.5 * speed, *still], [0.5 * speed, *still]]),
        contact={"cohesion": {"force": force, "range": reach}},
    )  # fmt: skip
    engine.advance(3000)
    return np.diff(engine.velocities()[:, 0])[0] / speed


def test_to_part_two_takes_the_force_times_the_range():
    assert parted(2.0) == pytest.approx(math.sqrt(0.5), rel=0.01)
    assert parted(1.1, dimension=3) == pytest.approx(math.sqrt(1 / 11), rel=0.03)
    assert parted(0.9) == pytest.approx(0.0, abs=1e-9)


def test_friction_holds_more_where_grains_pull_one_another():
    # a disk on a floor that pulls: mu (m g + F) of friction
    friction, force = 0.2, 1.5
    engine = rigid(
        [40, 5], walls=[Plates("y")], given=at_rest([[5.0, 0.5]], velocities=[[3.0, 0.0]]),
        gravity=[0.0, -G], timestep=0.005, solver=exact(),
        contact={"friction": friction, "cohesion": {"force": force, "range": 0.01}},
    )  # fmt: skip
    engine.advance(100)
    slowed = friction * (G + force) * engine.time
    assert engine.velocities()[0, 0] == pytest.approx(3.0 - slowed, abs=1e-9)
    assert engine.wall_impulse[0] == pytest.approx([slowed, -G * engine.time], abs=1e-8)


def test_forces_within_the_range_pull_grains_together():
    force, gap, reach = 2.0, 0.04, 0.05
    engine = rigid(
        [10, 10], given=at_rest([[4.0, 5.0], [5.0 + gap, 5.0]]), timestep=1e-3,
        contact={"friction": 0.0, "cohesion": {"force": force, "range": reach}},
    )  # fmt: skip
    engine.advance(100)
    t, dt = engine.time, engine.timestep
    assert engine.velocities()[:, 0] == pytest.approx([force * t, -force * t], abs=1e-9)
    moved = force * t * (t + dt) / 2
    assert engine.positions()[0, 0] - 4.0 == pytest.approx(moved, abs=1e-9)
    engine.advance(400)  # they meet, and stay
    assert engine.velocities()[:, 0] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert np.diff(engine.positions()[:, 0])[0] == pytest.approx(1.0, abs=1e-9)


def test_grains_beyond_the_range_do_not_pull():
    engine = rigid(
        [10, 10], given=at_rest([[4.0, 5.0], [5.06, 5.0]]), timestep=1e-3,
        contact={"friction": 0.0, "cohesion": {"force": 2.0, "range": 0.05}},
    )  # fmt: skip
    engine.advance(100)
    assert not engine.velocities().any()


def test_contacts_of_a_packing_hold_its_weight_with_those_that_only_pull():
    engine = rigid(
        [8, 16], walls=[Plates("x"), Plates("y")], number=40, kinds=[SphereKind(1.0, spread=0.2)],
        gravity=[0.0, -G], start=RandomStart(), timestep=0.01, solver=exact(tolerance=1e-9),
        contact={"friction": 0.5, "cohesion": {"force": 1.0, "range": 0.01}},
    )  # fmt: skip
    engine.advance(2000)
    assert np.abs(engine.velocities()).max() < 1e-6
    found = engine.contacts()
    total = engine.made.masses[:, None] * np.array([0.0, -G])
    np.add.at(total, found.pairs[:, 0], found.forces)
    pairs = ~found.at_walls
    np.add.at(total, found.pairs[pairs, 1], -found.forces[pairs])
    assert np.abs(total).max() < 1e-4
    assert (found.gaps[pairs] > 1e-5).sum() > 2  # pulled over a gap, and held apart by others


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_the_work_of_the_pull_is_in_the_books_of_energy(friction):
    """Two that pull one another together lose what the pull has given them, F times the way."""
    force, reach, gap = 2.0, 0.05, 0.04
    engine = rigid(
        [10, 10], given=at_rest([[4.0, 5.0], [5.0 + gap, 5.0]]), timestep=1e-4, solver=exact(),
        contact={"friction": friction, "cohesion": {"force": force, "range": reach}},
    )  # fmt: skip
    assert engine.energies()["contact"] == pytest.approx(-force * (reach - gap), abs=1e-12)
    engine.advance(100)  # they fly towards one another
    flying, speed = engine.energies(), np.abs(engine.velocities()[:, 0])
    assert speed == pytest.approx(force * engine.time, rel=1e-9)
    assert flying["translation"] == pytest.approx(force**2 * engine.time**2, rel=1e-9)
    assert flying["translation"] + flying["contact"] == pytest.approx(
        -force * (reach - gap),
        abs=2e-2 * flying["translation"],  # first order in the step
    )
    assert sum(engine.lost.values()) == pytest.approx(0.0, abs=1e-12)
    engine.advance(2000)
    rest = engine.energies()
    assert rest["translation"] == pytest.approx(0.0, abs=1e-12)
    assert rest["contact"] == pytest.approx(-force * reach, rel=1e-6)
    assert engine.lost["impact"] == pytest.approx(force * gap, rel=2e-2)
