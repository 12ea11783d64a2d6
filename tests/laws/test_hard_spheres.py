"""Event-driven dynamics: what hard spheres keep, their pressure, and how inelastic ones cool."""

import math

import numpy as np
import pytest

from mesokit import (
    Andersen,
    CaseError,
    EquationOfState,
    HardCollision,
    Kicks,
    Plates,
    RandomStart,
    RunError,
    SphereKind,
    SquareWell,
    Viscoelastic,
    theory,
)
from tests.helpers.hard_spheres import gas, same, smallest_gap

KINDS = [SphereKind(1.0), SphereKind(0.6, spread=0.1, density=1.0)]


@pytest.mark.parametrize("dimension", [2, 3])
def test_elastic_spheres_keep_momentum_and_energy_and_never_overlap(dimension):
    engine = gas(
        [14.5] * dimension, kinds=KINDS, packing_fraction=0.4, timestep=1.0, start=RandomStart()
    ).engine
    first, size = engine.totals()[2], math.sqrt(engine.n)
    for _ in range(5):
        engine.advance(2)
        _, momentum, energy = engine.totals()
        assert abs(energy / first - 1) < 1e-12
        assert np.abs(momentum).max() < 1e-12 * size
        assert smallest_gap(engine) > -1e-12
    assert engine.collisions[0] > 10 * engine.n


@pytest.mark.parametrize("dimension", [2, 3])
def test_perfectly_rough_spheres_keep_energy_and_turn_as_hot_as_they_fly(dimension):
    rough = HardCollision(1.0, tangential=1.0)
    engine = gas(
        [36 - 8 * dimension] * dimension,
        packing_fraction=0.3,
        timestep=0.5,
        collision=rough,
        spin_kT=0.0,
    ).engine
    first = sum(engine.energies().values())
    engine.advance(20)
    ratios = []
    for _ in range(60):
        engine.advance(1)
        energies = engine.energies()
        turning = energies["rotation"] / (1 if dimension == 2 else 3)
        ratios.append(turning / (energies["translation"] / dimension))
    assert abs(sum(energies.values()) / first - 1) < 1e-12
    error = np.std(ratios) / math.sqrt(len(ratios) / 4)  # some two collisions of each in a step
    assert abs(np.mean(ratios) - 1) < 4 * error < 0.2


def test_a_rough_collision_takes_what_the_closed_form_says():
    e, beta, radius = 0.7, 0.4, 0.5
    v, w = np.array([[0.3, 0.2], [-0.9, 0.5]]), np.array([0.7, -0.2])
    engine = gas(
        [8, 8],
        number=2,
        timestep=1.0,
        collision=HardCollision(e, tangential=beta),
        given={"positions": [[3, 4], [4.5, 4.2]], "velocities": v, "spins": w},
    ).engine
    before = sum(engine.energies().values())
    r = np.array([3, 4]) - np.array([4.5, 4.2])
    u, n = v[0] - v[1], None
    b, square = r @ u, u @ u
    time = (-b - math.sqrt(b * b - square * (r @ r - 1))) / square
    n = r + u * time
    along = np.array([-n[1], n[0]])
    normal, slip = u @ n, u @ along - radius * (w[0] + w[1])
    inertia = 1 / 8
    levers = 2 * radius**2 / inertia
    lost = (1 - e**2) * normal**2 / 4 + (1 - beta**2) * slip**2 / (2 * (2 + levers))
    engine.advance(1)
    assert engine.collisions[0] == 1
    assert before - sum(engine.energies().values()) == pytest.approx(lost, abs=1e-14)


def test_a_square_well_keeps_energy_and_binds():
    well = SquareWell(depth=1.0, width=1.5)
    engine = gas([14, 14], packing_fraction=0.3, timestep=1.0, collision=well).engine

    def energy():
        places = engine.positions()
        way = places[:, None] - places
        way -= 14 * np.rint(way / 14)
        pairs = (np.linalg.norm(way, axis=2) < 1.5).sum() - engine.n
        return engine.totals()[2] - pairs / 2

    first = energy()
    engine.advance(20)
    assert abs(energy() / first - 1) < 1e-11
    assert engine.totals()[2] > engine.n  # hotter: more pairs are bound than on the lattice


@pytest.mark.parametrize(
    "collision", [HardCollision(), SquareWell(width=1.3), Viscoelastic(0.05, contact_time=1e-4)]
)
def test_the_length_of_a_step_changes_no_bit(collision):
    given = {"packing_fraction": 0.45, "start": RandomStart(), "collision": collision}
    one, other = (gas([12, 13.5], timestep=1.0, **given).engine for _ in range(2))
    one.advance(12)
    slices = gas([12, 13.5], timestep=0.125, **given).engine
    for _ in range(12):
        slices.advance(7)
        slices.positions()
        slices.advance(1)
    other.restore({**slices.state(), "step": np.array(12)})
    assert same(one, other)


def test_a_step_of_more_events_than_are_done_at_once():
    """Between which signals are heard; the clock of the loop is that of the gas."""
    given = {"packing_fraction": 0.65, "kT": 1e6, "start": RandomStart()}
    one = gas([20, 20], timestep=0.4, **given).engine
    one.advance(1)
    assert one.collisions[0] > 1_000_000
    slices = gas([20, 20], timestep=0.04, **given).engine
    slices.advance(10)
    assert np.array_equal(one.positions(), slices.positions())
    assert np.array_equal(one.velocities(), slices.velocities())


@pytest.mark.parametrize(("size", "fraction"), [([9, 10], 0.9), ([5, 5, 5], 0.72)])
def test_growing_spheres_that_jam_are_no_start(size, fraction):
    with pytest.raises(CaseError, match=r"jam before they fill 0\.[789]"):
        gas(size, packing_fraction=fraction, start=RandomStart())


def test_growing_spheres_that_collide_without_end_begin_anew():
    # with these velocities rounding keeps two of them in touch (seed 1)
    walls, kinds = [Plates("x"), Plates("y")], [SphereKind(1.0, spread=0.2)]
    start = gas([40, 60], walls=walls, number=1500, kinds=kinds, start=RandomStart())
    assert smallest_gap(start.engine) > -1e-9


@pytest.mark.parametrize(
    ("size", "fraction", "kinds"),
    [
        ([30, 30], 0.2, [SphereKind()]),
        ([30, 30], 0.5, [SphereKind()]),
        ([10, 10, 10], 0.3, [SphereKind()]),
        ([30, 30], 0.4, [SphereKind(), SphereKind(0.6)]),
        ([9, 9, 9], 0.4, [SphereKind(), SphereKind(0.6)]),
    ],
)
def test_pressure_and_collision_rate(size, fraction, kinds):
    simulation = gas(
        size,
        200,
        observe=[EquationOfState(every=1)],
        packing_fraction=fraction,
        kinds=kinds,
        timestep=0.2,
        start=RandomStart(),
    )
    simulation.run()
    result = simulation["equation-of-state"]
    of_equal_spheres = ["Z by the collision rate", "collision rate"]
    for name in ["Z by the virial", *(of_equal_spheres if len(kinds) == 1 else [])]:
        found = result[name]
        assert abs(found.measured - found.expected) < 4 * found.error
        assert found.error < 0.02 * found.expected


@pytest.mark.parametrize(
    ("size", "number", "fraction"), [([5, 5, 5], 12, 0.16), ([8, 8], 20, 0.4), ([9, 9, 9], 30, 0.1)]
)
def test_few_spheres_have_the_pressure_of_few(size, number, fraction):
    """The law of many is 6 to 20 standard errors away."""
    simulation = gas(
        size,
        12000,
        observe=[EquationOfState(every=1)],
        number=number,
        packing_fraction=fraction,
        timestep=1.0,
    )
    simulation.run()
    found = simulation["equation-of-state"]
    for name in ("Z by the virial", "Z by the collision rate", "collision rate"):
        one = found[name]
        assert abs(one.measured - one.expected) < 4 * one.error
        assert one.error < 0.003 * one.expected


def test_a_gas_cools_by_the_law_of_haff():
    e, haff = 0.9, 39.51
    engine = gas(
        [177.25, 177.25],
        number=4000,
        timestep=haff / 2,
        collision=HardCollision(e),
        start=RandomStart(),
    ).engine
    # clustering makes it some percent hotter than the law; another program has these
    for turn, known in ((1, 0.4482), (2, 0.2537)):
        engine.advance(1)
        kT = engine.totals()[2] / (engine.n - 1)
        assert kT == pytest.approx(known, rel=0.03), turn
        expected = float(theory.haff_temperature(engine.time, haff))
        assert kT == pytest.approx(expected, rel=0.05), turn
        collisions = 2 * engine.collisions[0] / engine.n
        assert kT == pytest.approx(math.exp(-(1 - e**2) * collisions / 2), rel=0.03)


def test_kicks_hold_a_temperature():
    engine = gas(
        [40, 40],
        packing_fraction=0.2,
        timestep=1.0,
        collision=HardCollision(0.95),
        heating=Kicks(0.0627, interval=0.05),
    ).engine
    engine.advance(20)
    found = []
    for _ in range(150):
        engine.advance(1)
        found.append(engine.totals()[2] / engine.n)
    rate = theory.enskog_rate(engine.n / 1600, 1.0, 1.0, engine.n * math.pi / 4 / 1600, 2)
    error = np.std(found) / math.sqrt(len(found) / 16)  # relaxes within 16 time units
    expected = theory.kicked_temperature(0.0627, 0.95, rate)
    assert abs(np.mean(found) - expected) < 3 * error + 0.005  # the kicks of an interval
    assert error < 0.03
    assert np.abs(engine.totals()[1]).max() < 1e-9


def test_the_bath_of_andersen_has_a_temperature():
    engine = gas(
        [30, 30], packing_fraction=0.2, kT=0.5, timestep=2.0, heating=Andersen(rate=0.5, kT=2.0)
    ).engine
    engine.advance(5)
    found = []
    for _ in range(60):
        engine.advance(1)
        found.append(engine.totals()[2] / engine.n)
    error = 2.0 / math.sqrt(engine.n * len(found) / 2)
    assert abs(np.mean(found) - 2.0) < 4 * error


def test_slow_collisions_of_viscoelastic_spheres_are_elastic():
    rule = Viscoelastic(0.1)
    for speed, e in ((1e-5, 1 - 0.1e-1 + 0.6e-4), (1.0, 0.906)):
        engine = gas(
            [8, 8],
            number=2,
            kT=speed**2,
            timestep=2.0 / speed,
            collision=rule,
            given={
                "positions": [[3, 4], [5, 4]],
                "velocities": [[speed / 2, 0], [-speed / 2, 0]],
            },
        ).engine
        engine.advance(1)
        v = engine.velocities()[:, 0]
        assert (v[1] - v[0]) / speed == pytest.approx(e, rel=1e-9)


def test_without_a_contact_time_a_dense_inelastic_gas_collapses():
    given = {"packing_fraction": 0.25, "timestep": 1.0, "start": RandomStart()}
    engine = gas([20, 20], collision=HardCollision(0.2), **given).engine
    with pytest.raises(RunError, match=r"inelastic collapse at t = .*contact_time"):
        engine.advance(100)
    engine = gas([20, 20], collision=HardCollision(0.2, contact_time=1e-4), **given).engine
    engine.advance(100)
    assert engine.collisions[2] > 0


@pytest.mark.parametrize(("e", "collapses"), [(0.05, True), (0.09, False)])
def test_three_free_disks_on_a_line_collapse_below_seven_minus_four_root_three(e, collapses):
    # the outer ones come upon the one in the middle in turn: 7 - 4 sqrt(3) = 0.0718
    engine = gas(
        [40, 4],
        number=3,
        timestep=50.0,
        collision=HardCollision(e),
        given={"positions": [[17, 2], [20, 2], [22, 2]], "velocities": [[1, 0], [0, 0], [-1, 0]]},
    ).engine
    if collapses:
        with pytest.raises(RunError, match="inelastic collapse"):
            engine.advance(1)
    else:
        engine.advance(1)
        assert 2 < engine.collisions[0] < 100


@pytest.mark.parametrize("share", [0.02, 0.1, 0.3])
def test_a_contact_time_makes_so_many_collisions_elastic(share):
    # 1 - exp(-1.87 x) at a packing fraction of 0.25, measured: correlated, less than 2 x
    rate = theory.enskog_rate(0.25 * 4 / math.pi, 1.0, 1.0, 0.25, 2)
    engine = gas(
        [40, 40],
        packing_fraction=0.25,
        timestep=10.0,
        collision=HardCollision(1.0, contact_time=share / rate),
        start=RandomStart(),
    ).engine
    engine.advance(1)
    engine.end_warmup()
    engine.advance(15)
    pairs, _, elastic = engine.collisions
    expected = 1 - math.exp(-1.87 * share)
    error = math.sqrt(expected * (1 - expected) / pairs)
    assert abs(elastic / pairs - expected) < 0.02 * expected + 3 * error
