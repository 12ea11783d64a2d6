"""Molecules stay together in memory, and their runs are the same for any threads and any stops."""

import numpy as np
import pytest
from laboratory import assert_same, fingerprint, make_case, make_fluid

from mesokit import Disk, Harmonic, MaxwellBoltzmann, Plates, Surface, Uniform
from mesokit.execute.cpu.engine import CPU
from mesokit.execute.cpu.strips.layout import LANES, STRIPS, places_of_beads
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start.fluid import start

SHEARED = {
    "size": (5, 11, 6), "density": 2310 / 330, "shear_rate": 0.2,
    "molecule": Molecule(length=7, bond=Harmonic(K=1.0), substeps=2),
    "thermostat": MaxwellBoltzmann(),
}  # fmt: skip
CASES = {
    "dimers in a slit": {
        "size": (13, 7), "density": 1778 / 91, "thermostat": MaxwellBoltzmann(),
        "molecule": Molecule(bond=Harmonic(K=1.0), substeps=3), "measures": ("walls",),
        "force": Uniform(acceleration=(0.05, -0.02)),
        "walls": [Plates(axis="y", upper=Surface(velocity=(0.3, 0.0)))],
    },
    "sheared chains": SHEARED,
    "chains whose shear oscillates": SHEARED | {"shear_frequency": 0.3},
    "stars about a disk": {
        "size": (16, 12), "density": 8, "thermostat": MaxwellBoltzmann(),
        "molecule": Molecule(topology="star", length=4, arms=3, bond=Harmonic(K=1.0), substeps=2),
        "force": Uniform(acceleration=(0.05, -0.02)),
        "walls": [Disk(centre=(8, 6), radius=3, surface=Surface("diffuse"))],
    },
}  # fmt: skip
STEPS = 110  # more than one re-sorting


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES.keys())
def case(request):
    return request.param


@pytest.fixture(scope="module")
def reference(case):
    fluid = make_fluid(**case, threads=1)
    assert fluid.numbers.filling.molecules % 256
    fluid.advance(STEPS)
    return fingerprint(fluid)


@pytest.mark.parametrize("threads", [2, 3, 7])
def test_for_any_number_of_threads(case, reference, threads):
    fluid = make_fluid(**case, threads=threads)
    fluid.advance(STEPS)
    assert_same(fingerprint(fluid), reference)


@pytest.mark.parametrize("cut", [1, 7, 100])
def test_however_the_steps_are_divided(case, reference, cut):
    fluid = make_fluid(**case)
    while fluid.step < STEPS:
        fluid.advance(min(cut, STEPS - fluid.step))
        fluid.bond_vectors()  # looking changes nothing
    assert_same(fingerprint(fluid), reference)


@pytest.mark.parametrize("step", [0, 33, 100])
def test_from_a_state(case, reference, step):
    fluid = make_fluid(**case)
    fluid.advance(step)
    parts = {key: value for key, value in case.items() if key not in ("size", "measures")}
    other = CPU(make_case(case["size"], **parts), 3, case.get("measures", ()))
    other.restore(fluid.state())
    other.advance(STEPS - step)
    assert_same(fingerprint(other), reference)


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
def test_rubbish_in_spare_lanes_changes_nothing(case, reference, rubbish):
    fluid = make_fluid(**case)
    used = places_of_beads(fluid.numbers.filling.molecules, fluid.numbers.beads).ravel()
    spare = np.setdiff1d(np.arange(fluid.memory.strips * LANES), used)
    assert len(spare)
    for k in range(2 * fluid.dimension):
        fluid.memory.fluid.particles.data[fluid.memory.at(k, spare)] = rubbish
    fluid.advance(STEPS)
    assert_same(fingerprint(fluid), reference)


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
