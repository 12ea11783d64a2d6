"""What sizes of ideal molecules are expected to be when forces pull at them."""

import dataclasses

import numpy as np
import pytest
from scipy.special import ndtr

from mesokit import (
    Box,
    Case,
    Fluid,
    Harmonic,
    MoleculeHistogram,
    MoleculeSize,
    MoleculeTracks,
    Plates,
    Polymer,
    Pull,
    Run,
    Solutes,
    Trap,
    theory,
)  # fmt: skip
from mesokit.method.mpcd.expected.traps import held

PULLS = (Pull([-2.0, 1.0], bead=1), Pull([2.0, -1.0], bead=-1))
K, BEADS, BOND = 1.5, 4, 2 / 3  # mean square of a bond without forces, 2D
ENDS = 3 * np.array([2.0, -1.0]) / (2 * K)


def pulled(walls=(), **changed):
    """Dimers without pulls, and chains with them."""
    given = {"pulls": [dataclasses.replace(pull, kind=2) for pull in PULLS]} | changed
    kinds = (Polymer(2, length=2), Polymer(3, length=BEADS))
    # in so many sub-steps springs swing as in theory
    solutes = Solutes(kinds, bond=Harmonic(K=K), mass=5.0, substeps=1000, **given)
    return Case(run=Run(1), box=Box([12, 12]), fluid=Fluid(), solutes=solutes, walls=walls)


def test_sizes_are_those_at_rest_and_of_the_mean_shape():
    expected = MoleculeSize(kind=2).accumulator(pulled()).expected()
    free = 3 * BOND / 2 * np.eye(2)
    np.testing.assert_allclose(expected[1], free + np.outer(ENDS, ENDS), rtol=1e-7)
    places = np.arange(BEADS)[:, None] * ENDS / 3  # evenly along a line
    around = places - places.mean(axis=0)
    square = theory.mean_square_gyration(theory.linear_modes(BEADS), BOND)
    shape = square / 2 * np.eye(2) + around.T @ around / BEADS
    np.testing.assert_allclose(expected[0], shape, rtol=1e-7)


def test_the_histogram_of_a_component_is_moved_by_the_extension():
    of = MoleculeHistogram(of="end-to-end", axis="x", kind=2).accumulator(pulled())
    assert of.edges[-1] > ENDS[0] + 3 * (3 * BOND / 2) ** 0.5
    expected = ndtr((of.edges - ENDS[0]) / (3 * BOND / 2) ** 0.5)
    np.testing.assert_allclose(of.cdf(of.edges), expected, rtol=1e-4, atol=1e-9)
    for what in ("gyration", "end-to-end", "orientation"):  # no theory of these
        of = MoleculeHistogram(of=what, kind=2).accumulator(pulled())
        assert of.cdf(of.edges) is None


def test_series_of_molecules_have_the_same_theory():
    tracks = MoleculeTracks(kind=2).accumulator(pulled()).result()
    assert tracks.extra["ideal_end_to_end"] == pytest.approx((3 * BOND + ENDS @ ENDS) ** 0.5)


@pytest.mark.parametrize(
    "changed",
    [
        {"pulls": [Pull([1.0, 0.0], bead=1, kind=2)]},  # moves the fluid
        {"pulls": [Pull([1.0, 0.0], bead=1), Pull([-1.0, 0.0], bead=1, kind=2)]},
        {"traps": [Trap([5.0, 5.0], kind=2)]},
        {"walls": (Plates("y"),)},
    ],
    ids=["one end", "two kinds", "trap", "walls"],
)
def test_elsewhere_there_is_none(changed):
    assert np.isnan(MoleculeSize(kind=2).accumulator(pulled(**changed)).expected()).all()


def test_what_holds_another_kind_does_not_matter():
    """A canonical fluid at rest: each ideal molecule has Boltzmann's distribution of its own."""
    alone, beside = pulled(), pulled(traps=[Trap([5.0, 5.0], kind=1)])
    expected = MoleculeSize(kind=2).accumulator(beside).expected()
    np.testing.assert_array_equal(expected, MoleculeSize(kind=2).accumulator(alone).expected())
    of = MoleculeHistogram(of="end-to-end", axis="x", kind=2).accumulator(beside)
    assert of.cdf(of.edges) is not None
    # nor does what pulls at chains matter to dimers, which are as at rest
    free = MoleculeHistogram(of="end-to-end", kind=1).accumulator(alone)
    assert free.cdf(free.edges) is not None
    # a trapped kind that all of a force is left over on stays where it is
    push = [*alone.solutes.pulls, Pull([1.0, 0.0], bead=1, kind=1)]
    still = pulled(traps=[Trap([5.0, 5.0], kind=1)], pulls=push)
    np.testing.assert_array_equal(MoleculeSize(kind=2).accumulator(still).expected(), expected)


def test_traps_beside_chains_that_forces_stretch_keep_their_theory():
    traps = [Trap([5.0, 5.0], kind=1)]
    one, other = (pulled(traps=traps, **parts) for parts in ({"pulls": []}, {}))
    assert held(other, 1).centre_variance == held(one, 1).centre_variance
    assert held(pulled(traps=traps, pulls=[Pull([1.0, 0.0], bead=1, kind=2)]), 1) is None
