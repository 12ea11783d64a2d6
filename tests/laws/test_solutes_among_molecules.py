"""Solutes in a fluid of molecules: both are in equilibrium, both hand over what they have."""

import dataclasses

import numpy as np
import pytest

from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.start.fluid import start
from tests.helpers.kinds_of_fluid import AMONG_MOLECULES, DIMERS
from tests.helpers.kinds_of_fluid import OF_MANY_MASSES as DISSOLVED
from tests.helpers.small_fluids import make_case, make_fluid, mean

pytestmark = pytest.mark.long

CHAINS, RINGS, BALLS = slice(0, 240), slice(240, 264), slice(264, 276)
BULK, EXACT, SLIT, SHEARED = (
    AMONG_MOLECULES[k] for k in ("bulk", "exact dimers", "slit", "sheared")
)


@pytest.fixture(scope="module")
def bulk():
    """Without a thermostat: temperature and energy are those of the start."""
    return make_fluid(**BULK, measures=("stress",))


def total_energy(fluid):
    return fluid.totals()[2] + fluid.potential_energy()


def refined(refine):
    molecule = dataclasses.replace(DIMERS, substeps=refine * DIMERS.substeps)
    solutes = dataclasses.replace(DISSOLVED, substeps=refine * DISSOLVED.substeps)
    return make_fluid(**BULK | {"molecule": molecule, "solutes": solutes})


def test_energy_is_kept_to_second_order_in_the_substep():
    """That of the bonds of both; collisions keep that of each cell exactly."""
    changes = []
    for refine in (1, 2, 4):
        fluid = refined(refine)
        first, worst = total_energy(fluid), 0.0
        for _ in range(10):
            fluid.advance(1)
            worst = max(worst, abs(total_energy(fluid) - first))
        changes.append(worst / first)
    assert changes[0] < 0.01
    assert changes[1] < 0.45 * changes[0] and changes[2] < 0.45 * changes[1]


def test_the_energy_is_that_of_all_bonds(bulk):
    """U = r^2 of each, the fluid's bonds first, then those of solutes."""
    squares, pairs = (bulk.bond_vectors() ** 2).sum(axis=1), bulk.bonds()
    fluid, chains = bulk.n // 2, 60 * 3
    assert len(squares) == len(pairs) == fluid + chains + 8 * 3
    assert pairs[:fluid].max() < bulk.n <= pairs[fluid:].min()
    way = np.diff(bulk.whole_positions(pairs.ravel()).reshape(-1, 2, 3), axis=1)[:, 0]
    np.testing.assert_allclose(way[:fluid], bulk.bond_vectors()[:fluid], atol=1e-12)
    assert bulk.potential_energy() == pytest.approx(squares.sum(), rel=1e-12)


def test_both_are_in_equilibrium(bulk):
    """Of one temperature, bead by bead and kind by kind; bonds and ends as without a solvent."""
    mass, heat = bulk.masses(np.arange(bulk.n + 276)), {"dimers": [], "kinds": [], "beads": []}
    sizes, ends, bonds, pressure = [], [], [], []
    momentum, energy = bulk.totals()[1], total_energy(bulk)
    bulk.advance(200)
    for _ in range(360):
        bulk.advance(12, measure=["stress"])
        number, _, kinetic = bulk.totals()
        kT = 2 * kinetic / (3 * (number - 1))
        own = mass * (bulk.velocities(np.arange(number)) ** 2).sum(axis=1) / (3 * kT)
        own /= 1.0 - mass / mass.sum()  # of a whole at rest
        beads = own[bulk.n :]
        heat["dimers"].append(own[: bulk.n].mean())
        heat["kinds"].append([beads[part].mean() for part in (CHAINS, RINGS, BALLS)])
        heat["beads"].append(beads[CHAINS].reshape(60, 4).mean(axis=0))
        way = (bulk.bond_vectors() ** 2).sum(axis=1) / kT
        bonds.append([way[: bulk.n // 2].mean(), way[bulk.n // 2 :][180:].mean()])
        r = bulk.solutes.places[CHAINS].reshape(60, 4, 3)
        ends.append(((r[:, -1] - r[:, 0]) ** 2).sum(axis=1) / kT)
        arm = r - r.mean(axis=1, keepdims=True)
        sizes.append((arm**2).sum(axis=2).mean(axis=1) / kT)
        pressure.append(-np.trace(sum(bulk.stress.values())) / 3 / kT)
    assert abs(bulk.totals()[1] - momentum).max() < 1e-8 * bulk.n
    assert total_energy(bulk) == pytest.approx(energy, rel=2e-3)

    def over_time(values):
        return mean(np.reshape(values, (20, -1)).mean(axis=1))

    report = []
    for name, found in heat.items():
        for column in np.reshape(found, (360, -1)).T:
            report.append((name, over_time(column), 1.0))
    fluid, rings = np.transpose(bonds)
    report.append(("bonds of dimers", over_time(fluid), 1.5))
    report.append(("bonds of rings", over_time(rings), 1.5 * (1 - 1 / 3)))
    report.append(("ends of chains", mean(np.mean(ends, axis=0)), 4.5))
    report.append(("gyration of chains", mean(np.mean(sizes, axis=0)), 1.5 * 15 / 24))
    carriers = (bulk.n / 2 + 60 + 8 + 12) / 512
    report.append(("pressure", over_time(pressure), carriers))
    for name, found, expected in report:
        assert found.agrees(expected), (name, str(found), expected)
    errors = {name: found.error / expected for name, found, expected in report}
    assert errors["bonds of dimers"] < 0.005 and errors["ends of chains"] < 0.05
    assert errors["kinds"] < 0.03 and errors["pressure"] < 0.01


def test_exact_dimers_beside_chains():
    """Both at the temperature, both as long as Boltzmann has them."""
    fluid = make_fluid(**EXACT)
    heat, bonds = [], []
    for _ in range(100):
        fluid.advance(20)
        heat.append(fluid.solutes.motion()[-1] / (3 * 80 * (1 - 3 / (3360 + 240))))
        way = (fluid.bond_vectors() ** 2).sum(axis=1)
        bonds.append([way[:1680].mean(), way[1680:].mean()])
    dimers, chains = (mean(np.reshape(b, (10, 10)).mean(axis=1)) for b in np.transpose(bonds))
    found = mean(heat)
    assert found.agrees(1.0) and found.error < 0.02
    assert dimers.agrees(1.5) and dimers.error < 0.01
    assert chains.agrees(1.5) and chains.error < 0.15


def test_walls_take_what_both_lose():
    fluid = make_fluid(**SLIT)
    _, before, _ = fluid.totals()
    fluid.advance(200)
    taken = fluid.wall_impulse[:, :2].sum(axis=0)
    _, after, _ = fluid.totals()
    assert abs(before - after).max() > 1.0
    np.testing.assert_allclose(taken, before - after, atol=1e-8)
    y = np.concatenate([fluid.positions()[:, 1], fluid.solutes.places[:, 1]])
    assert y.min() >= 0 and y.max() <= 7


def test_no_bond_notices_the_sliding_boundary():
    """Components along the gradient: bonds of both are those of rest, wherever they lie."""
    fluid = make_fluid(**SHEARED)
    trimers, chains = [], []
    for _ in range(100):
        fluid.advance(25)
        way = fluid.bond_vectors()[:, 1] ** 2
        trimers.append(way[: fluid.n * 2 // 3].mean())
        chains.append(way[fluid.n * 2 // 3 :].mean())
    assert abs(fluid.bond_vectors()).max() < 12
    trimers, chains = mean(trimers), mean(np.reshape(chains, (10, 10)).mean(axis=1))
    assert trimers.agrees(0.5, systematic=0.02), trimers
    assert chains.agrees(0.5, systematic=0.02) and chains.error < 0.05, chains


def test_given_places_of_both():
    """A run that starts where another is, both with their velocities."""
    fluid = make_fluid(**BULK)
    fluid.advance(5)
    again = CPU(make_case(**BULK), 1)
    places, beads = fluid.whole_positions(), fluid.solutes.places.copy()
    start(again, places, fluid.velocities(), beads, fluid.solutes.velocities.copy())
    np.testing.assert_allclose(again.bond_vectors(), fluid.bond_vectors(), atol=1e-12)
    np.testing.assert_allclose(again.totals()[1], fluid.totals()[1], atol=1e-9)
    assert total_energy(again) == pytest.approx(total_energy(fluid), rel=1e-12)
