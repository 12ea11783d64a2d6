"""Solutes that act on the fluid by a potential: mechanics, and an ideal gas about them."""

import dataclasses

import numpy as np
import pytest

from mesokit import WCA
from mesokit.errors import RunError
from mesokit.method.mpcd.solutes import Polymer, Solutes
from mesokit.potential.thermal import energies, excluded_volume
from tests.helpers.kinds_of_fluid import EMBEDDED as SEVERAL
from tests.helpers.small_fluids import make_fluid, mean

pytestmark = pytest.mark.long

SIZE, DENSITY = (20, 20), 5.0
HEAVY = Solutes((Polymer(1),), mass=1e6, coupling="potential", solvent_pair=WCA(sigma=3.0))


def with_beads(solutes, **more):
    return make_fluid(SIZE, density=DENSITY, solutes=solutes, **more)


def total_energy(fluid):
    return fluid.totals()[2] + fluid.potential_energy()


def test_energy_is_kept_to_second_order_in_the_substep():
    """Forces are minus the gradient of the energy, and no particle near a bead is missed."""
    changes = []
    for refine in (1, 2, 4):
        fluid = with_beads(dataclasses.replace(SEVERAL, substeps=8 * refine))
        first, worst = total_energy(fluid), 0.0
        for _ in range(8):
            fluid.advance(1)
            worst = max(worst, abs(total_energy(fluid) - first))
        changes.append(worst)
    assert changes[0] < 0.1
    assert changes[1] < 0.45 * changes[0] and changes[2] < 0.45 * changes[1]


def test_momentum_is_kept_to_rounding():
    fluid = with_beads(SEVERAL)
    fluid.advance(200)
    assert abs(fluid.totals()[1]).max() < 1e-12 * fluid.n
    assert abs(fluid.solutes.velocities).max() > 0.1


def test_who_is_moved_in_substeps_does_not_matter():
    """With a large skin all particles are: the others have missed no force."""
    found = []
    for skin in (0.1, 8.0):
        fluid = with_beads(dataclasses.replace(SEVERAL, skin=skin))
        fluid.advance(5)
        near = fluid.memory.solutes.embedded[0].number[0, 0]
        assert (near == fluid.n) == (skin == 8.0)
        found.append(np.concatenate([fluid.positions(), fluid.solutes.places]))
    apart = found[0] - found[1]
    apart -= np.rint(apart / SIZE) * SIZE  # those at an edge may be on either side
    assert abs(apart).max() < 1e-9


def test_beads_have_the_temperature_of_the_fluid():
    fluid, samples = with_beads(SEVERAL), []
    fluid.advance(50)
    for _ in range(900):
        fluid.advance(8)
        _, _, energy = fluid.totals()
        kT = energy / (fluid.n + SEVERAL.beads - 1)  # of two axes each, less the momentum
        square = (fluid.solutes.velocities**2).sum(axis=1).mean()
        samples.append(0.5 * SEVERAL.mass * square / kT)
    measured = mean(np.reshape(samples, (30, -1)).mean(axis=1))
    # what the beads may take is the rest of a fluid at rest: 1 - M / (mass of all)
    rest = 1.0 - SEVERAL.mass / (fluid.n + SEVERAL.mass * SEVERAL.beads)
    assert measured.error < 0.03
    assert measured.agrees(rest)


def test_density_about_a_bead_is_that_of_an_ideal_gas():
    """exp(-U/kT), from the first step on, and far away the density that was asked for."""
    fluid, kernel = with_beads(HEAVY), HEAVY.solvent_pair.kernel()
    edges = np.array([0.0, 2.7, 2.8, 2.9, 3.0, 3.15, 3.3, 3.4, 4.0, 6.0, 9.0])
    counts = []
    for _ in range(300):
        away = fluid.positions() - fluid.solutes.places[0]
        away -= np.rint(away / SIZE) * SIZE
        counts.append(np.histogram(np.sqrt((away**2).sum(axis=1)), edges)[0])
        fluid.advance(10)
    fine = np.linspace(edges[0], edges[-1], 9001)
    weight = 2 * np.pi * fine * np.exp(-energies((kernel,), fine))
    steps = 0.5 * (weight[1:] + weight[:-1]) * np.diff(fine)
    which = np.searchsorted(edges, fine[:-1], side="right") - 1
    expected = DENSITY * np.bincount(which, steps)
    blocks = np.reshape(counts, (15, -1, len(expected))).mean(axis=1)
    error = blocks.std(axis=0, ddof=1) / np.sqrt(15)
    error = np.maximum(error, np.sqrt(expected / len(counts)))  # of shells that are nearly empty
    assert (abs(blocks.mean(axis=0) - expected) < 4 * error).all()
    assert (error[6:] < 0.03 * expected[6:]).all()
    room = 400 - excluded_volume(kernel, 2, 1.0, HEAVY.solvent_pair.reach)
    assert fluid.n == round(DENSITY * room)


def test_a_bead_that_goes_too_far_is_refused():
    fluid = with_beads(dataclasses.replace(SEVERAL, skin=0.02))
    fluid.solutes.velocities[3] = 1.0
    with pytest.raises(RunError, match=r"step 1: bead 4 went farther than solutes.skin = 0.02"):
        fluid.advance(1)


def test_a_start_with_overlaps_is_refused():
    fluid = with_beads(SEVERAL)
    places = fluid.positions()
    places[7] = fluid.solutes.places[2] + 0.01
    fluid.memory.fill(places, fluid.velocities())
    with pytest.raises(RunError, match=r"step 1: a particle of the fluid hit bead 3 too hard"):
        fluid.advance(1)
