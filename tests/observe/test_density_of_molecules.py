"""Where beads, ends and centres of molecules are in a slit: ideal molecules between hard walls."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import SRD, DensityProfile, Disk, Harmonic, MaxwellBoltzmann, Plates, Spring, Uniform
from mesokit.errors import CaseError
from mesokit.method.mpcd.molecule import Molecule
from tests.helpers.comparisons import comparisons
from tests.helpers.small_fluids import make_case, make_fluid

BOND = Harmonic(K=1.0)
MOLECULES = {
    "chains": Molecule(length=5, bond=BOND),
    "rings": Molecule(topology="ring", length=5, bond=BOND),
    "stars": Molecule(topology="star", length=5, arms=4, bond=BOND),
}


def in_slit(molecule, of, steps=3000, **parts):
    """A profile in a slit whose molecules cross it in some tens of steps."""
    parts = {
        "timestep": 1.0, "collision": SRD(angle=90), "thermostat": MaxwellBoltzmann(),
        "walls": [Plates(axis="y")],
    } | parts  # fmt: skip
    fluid = make_fluid((40, 8), density=10, molecule=molecule, **parts)
    accumulators = [DensityProfile(of=o, bins_per_cell=3).accumulator(fluid.case) for o in of]
    for _ in range(steps // 20):
        fluid.advance(20)
        for accumulator in accumulators:
            accumulator.observe(fluid)
    return [accumulator.result() for accumulator in accumulators]


def expected(accumulator):
    return accumulator.theory.expected(accumulator)


@pytest.mark.parametrize("molecule", MOLECULES.values(), ids=MOLECULES.keys())
def test_walls_keep_molecules_off_as_they_should(molecule):
    """Beads, ends and centres in every slice, with chi-square of what is left."""
    ring = molecule.topology == "ring"
    means = {"particles": 10, "centres": 2} | ({} if ring else {"ends": 8 if molecule.arms else 4})
    for (of, mean), result in zip(means.items(), in_slit(molecule, means), strict=True):
        assert result.value.mean() == pytest.approx(mean)
        if result.expected is None:
            assert ring and of == "centres"
            continue
        assert result.expected.mean() == pytest.approx(mean)
        assert result.expected[0] < 0.6 * result.expected.mean()
        assert all(abs(c.deviation) < 4 for c in comparisons(result)), result


def test_theory_sees_walls_that_are_not_there():
    """Molecules that know nothing of each other's ends: the law of dimers fails for chains."""
    result = in_slit(MOLECULES["chains"], ["particles"])[0]
    case = make_case(
        (40, 8), density=10, molecule=Molecule(bond=BOND), walls=[Plates(axis="y")], timestep=1.0
    )
    dimers = expected(DensityProfile(bins_per_cell=3).accumulator(case))
    assert np.nanmax(np.abs(result.value - dimers) / result.error) > 10


def test_a_force_across_the_slit():
    """Barometric weights of each bead: more below, in step with the theory."""
    result = in_slit(MOLECULES["chains"], ["particles"], force=Uniform((0.0, -0.1)))[0]
    assert result.expected[:12].sum() > 1.5 * result.expected[12:].sum()
    assert abs(result.comparisons[0].deviation) < 4, result.comparisons[0]


def test_without_walls_all_is_uniform():
    for of, mean in (("particles", 10), ("centres", 2), ("ends", 4)):
        accumulator = DensityProfile(of=of).accumulator(
            make_case((8, 8), density=10, molecule=MOLECULES["chains"])
        )
        np.testing.assert_allclose(expected(accumulator), mean)
    fluid = make_fluid((8, 8), density=10, molecule=MOLECULES["chains"])
    centres = DensityProfile(of="centres").accumulator(fluid.case)
    centres.observe(fluid)
    assert centres.blocks.mean().mean() == pytest.approx(2)  # none is lost over the boundary


def test_where_there_is_no_theory():
    """Bonds of a length of their own in a slit; and obstacles."""
    stiff = Molecule(bond=Spring(k=20.0, length=0.5))
    for parts in ({"molecule": stiff, "walls": [Plates(axis="y")]},
                  {"walls": [Disk(centre=(4, 4), radius=1)]}):  # fmt: skip
        case = make_case((8, 8), density=10, **parts)
        assert expected(DensityProfile().accumulator(case)) is None


def test_what_has_no_meaning_is_refused():
    chains, rings = MOLECULES["chains"], MOLECULES["rings"]
    with pytest.raises(CaseError, match=r"of = 'ends' needs molecules"):
        make_case((8, 8), [DensityProfile(of="ends")])
    with pytest.raises(CaseError, match=r"observe\[#1\].of = 'ends': rings have none"):
        make_case((8, 8), [DensityProfile(of="ends")], density=10, molecule=rings)
    with pytest.raises(CaseError, match=r"of = 'centres': not along 'x' under shear"):
        make_case((8, 8), [DensityProfile("x", of="centres")], density=10, molecule=chains,
                  shear_rate=0.1)  # fmt: skip
