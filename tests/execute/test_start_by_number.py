"""Where a particle or molecule starts, and how fast, follows from its number alone."""

from typing import NamedTuple

import numpy as np
import pytest
from scipy import stats

from mesokit import FENE, WCA, Bending, Harmonic, Polymer, Solutes, Species
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start.conformation import drawn, nearest_of
from mesokit.method.mpcd.start.draws import Draws
from mesokit.method.mpcd.start.growth import grown
from mesokit.potential.protocol import central
from mesokit.potential.thermal import lengths
from mesokit.scalar.random import INITIAL_POSITION, INITIAL_VELOCITY
from tests.helpers.small_fluids import make_fluid

SIZE = np.array([8.0, 20.0, 12.0])


def places(who):
    return Draws(3, INITIAL_POSITION, who).units(3) * SIZE


@pytest.mark.parametrize("first", [0, 700, 2**33])
def test_any_part_of_the_particles_is_that_part_of_all(first):
    whole = places(np.arange(first, first + 300))
    np.testing.assert_array_equal(places(np.arange(first + 100, first + 150)), whole[100:150])
    np.testing.assert_array_equal(places([first + 7]), whole[7:8])


def test_places_are_uniform_and_each_has_its_own():
    random = Draws(3, INITIAL_POSITION, np.arange(50_000))
    found, again = random.units(3), random.of(np.arange(50_000)).units(3)
    for k in range(3):
        assert stats.kstest(found[:, k], "uniform").pvalue > 1e-4
    assert len(np.unique([found, again])) == 2 * found.size
    for a in range(3):
        for b in range(3):
            assert abs(np.corrcoef(found[:, a], again[:, b])[0, 1]) < 5 / np.sqrt(len(found))


@pytest.mark.parametrize("d", [2, 3])
def test_vectors_are_gaussian_and_each_draw_is_another(d):
    random = Draws(3, INITIAL_VELOCITY, np.arange(40_000))
    found = np.concatenate([random.normals(d), random.normals(d)], axis=1)
    for k in range(2 * d):
        assert stats.kstest(found[:, k], "norm").pvalue > 1e-4
    assert len(np.unique(found)) == found.size
    correlations = np.corrcoef(found.T) - np.eye(2 * d)
    assert np.abs(correlations).max() < 5 / np.sqrt(len(found))


MOLECULES = {
    "springs": Molecule(length=5, bond=Harmonic(K=2.0)),
    "rings": Molecule(length=6, topology="ring", bond=FENE(), pair=WCA(sigma=0.5)),
    "stiff": Molecule(length=5, bond=Harmonic(K=50.0), bending=Bending(kappa=3.0)),
}


def in_a_slab(places):
    """Half of the box, so that most molecules are drawn several times."""
    return places[..., 1] % SIZE[1] < 10.0


@pytest.mark.parametrize("molecule", MOLECULES.values(), ids=MOLECULES.keys())
def test_any_part_of_the_molecules_is_that_part_of_all(molecule):
    def of(who):
        random = Draws(3, INITIAL_POSITION, who)
        return drawn(molecule, 1.0, SIZE, random, in_a_slab).reshape(len(who), -1, 3)

    whole = of(np.arange(400))
    assert in_a_slab(whole).all() and len(np.unique(whole)) == whole.size
    np.testing.assert_array_equal(of([7, 250, 399]), whole[[7, 250, 399]])


def test_solutes_grow_from_numbers_of_their_own():
    def places(*polymers, seed=3):
        solutes = Solutes(polymers, bond=FENE(), pair=WCA(sigma=0.5))
        everywhere = lambda places: np.ones(places.shape[:-1], bool)  # noqa: E731
        return grown(solutes, 1.0, SIZE, np.full(3, np.inf), seed, everywhere)

    two, four = places(Polymer(2, length=5)), places(Polymer(4, length=5), Polymer(3, length=4))
    np.testing.assert_array_equal(four[:10], two)
    assert len(np.unique(four)) == four.size
    assert not np.isin(places(Polymer(2, length=5), seed=4), two).any()


def test_velocities_are_maxwellian_by_their_masses():
    fluid = make_fluid(
        size=(20, 20, 20), kT=2.0,
        species=(Species(mass=1.0, density=5), Species(mass=4.0, density=5)),
        solutes=Solutes((Polymer(3000),), mass=9.0),
    )  # fmt: skip
    velocities, masses = fluid.velocities(), fluid.numbers.masses()
    for mass, some in (
        (1.0, velocities[masses == 1.0]),
        (4.0, velocities[masses == 4.0]),
        (9.0, fluid.solutes.velocities),
    ):
        assert len(some) >= 3000
        for k in range(3):
            assert stats.kstest(some[:, k] * (mass / 2.0) ** 0.5, "norm").pvalue > 1e-4


def test_potentials_of_the_same_numbers_are_told_apart():
    """What is kept of one must not be found for the other."""

    class Push(NamedTuple):
        """U = K/r^2."""

        K: float

    class Harder(NamedTuple):
        """U = 4 K/r^2."""

        K: float

    central.register(Push)(lambda potential, square: (potential.K / square, 0.0))
    central.register(Harder)(lambda potential, square: (4 * potential.K / square, 0.0))
    least = [lengths((kind(2.0),), 3, 1.0, 1.0).energy.min() for kind in (Push, Harder)]
    assert least == pytest.approx([2.0, 8.0], rel=1e-3)
    assert nearest_of(Harder(2.0), 1.0) > 1.9 * nearest_of(Push(2.0), 1.0)
