"""Molecules stay together in memory, and what lies beside them there changes nothing."""

import numpy as np
import pytest

from mesokit import Harmonic
from mesokit.loops.layout import LANES, STRIPS, places_of_beads
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start.fluid import start
from tests.helpers.kinds_of_fluid import MOLECULES, SHEARED
from tests.helpers.small_fluids import assert_same, fingerprint, make_case, make_fluid

STEPS = 110  # more than one re-sorting


@pytest.fixture(scope="module", params=MOLECULES.values(), ids=MOLECULES.keys())
def case(request):
    return request.param


def test_bonds_stay_bonds(case):
    """In memory, beads of one molecule are side by side, and bond vectors are what they were."""
    fluid = make_fluid(**case)
    places = places_of_beads(fluid.numbers.filling.molecules, fluid.numbers.beads)
    for _ in range(3):
        fluid.advance(100)
        ids = fluid.memory.fluid.particles.ident[places]
        assert (ids == ids[:, :1] + np.arange(fluid.numbers.beads)).all()
        assert sorted(ids.ravel()) == list(range(fluid.n))
        way = fluid.bond_vectors()
        fluid.sort()
        np.testing.assert_allclose(fluid.bond_vectors(), way, atol=1e-12)
        assert np.abs(way).max() < 6


@pytest.mark.parametrize("rubbish", [1e20, np.inf, np.nan])
def test_rubbish_in_spare_lanes_changes_nothing(case, rubbish):
    fluid, clean = make_fluid(**case), make_fluid(**case)
    used = places_of_beads(fluid.numbers.filling.molecules, fluid.numbers.beads).ravel()
    spare = np.setdiff1d(np.arange(fluid.memory.strips * LANES), used)
    assert len(spare)
    for k in range(2 * fluid.dimension):
        fluid.memory.fluid.particles.data[fluid.memory.at(k, spare)] = rubbish
    for one in (fluid, clean):
        one.advance(STEPS)
    assert_same(fingerprint(fluid), fingerprint(clean))


def test_molecules_reach_over_blocks():
    """Groups of seven strips do not fit into blocks of sixteen."""
    fluid = make_fluid(**SHEARED | {"size": (12, 12, 12), "density": 10.5}, threads=2)
    assert fluid.memory.strips > 3 * STRIPS
    r = fluid.positions(unwrapped=True)[:, 1:]  # along x images slide
    fluid.advance(1)
    assert np.abs(fluid.positions(unwrapped=True)[:, 1:] - r).max() < 1.0


def test_a_start_is_the_same_in_any_process():
    """Drawn from the seed alone."""
    molecule = Molecule(length=4, bond=Harmonic(K=1.0))
    one, other = (make_fluid((6, 6), density=4, molecule=molecule) for _ in range(2))
    np.testing.assert_array_equal(one.positions(), other.positions())
    third = CPU(make_case((6, 6), density=4, molecule=molecule, seed=2))
    start(third)
    assert not np.array_equal(one.positions(), third.positions())
