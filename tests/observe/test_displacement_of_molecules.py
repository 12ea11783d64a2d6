"""Mean square displacement of beads and centres of mass, beside Rouse's theory."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from mesokit import (
    FENE,
    SRD,
    WCA,
    Harmonic,
    MaxwellBoltzmann,
    MeanSquareDisplacement,
    NormalModes,
    Uniform,
    theory,
)
from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.errors import CaseError
from mesokit.method.mpcd.derived import derive
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.expected.molecules import rouse_note
from mesokit.method.mpcd.fluid import Fluid
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.solutes import Polymer, Solutes
from mesokit.method.mpcd.start.fluid import start
from mesokit.observe.shared.origins import GROUPS
from tests.helpers.small_fluids import make_case, make_fluid

SOFT = Harmonic(K=1 / 6)  # three cells long: beads seldom meet their neighbours in a cell
THIN = {"timestep": 1.0, "collision": SRD(angle=90)}  # they fly a cell between two collisions
MOLECULES = {
    "dimers": (Molecule(bond=SOFT), 5),
    "chains": (Molecule(length=4, bond=SOFT), 5),
    "rings": (Molecule(topology="ring", length=3, bond=SOFT), 10),
    "stars": (Molecule(topology="star", length=4, arms=3, bond=SOFT), 10),
}


def moved(of, density, molecule, steps=300, shear_rate=0.0, **fluid):
    """The displacement in a fluid that runs for so many steps."""
    observable = MeanSquareDisplacement(of=of, particles=100_000, every=2, max_lag=60)
    parts = {"density": density, "molecule": molecule, "shear_rate": shear_rate} | THIN | fluid
    fluid = make_fluid((12, 12, 12), **parts)
    accumulator = observable.accumulator(fluid.case)
    accumulator.observe(fluid)
    for _ in range(steps // 2):
        fluid.advance(2)
        accumulator.observe(fluid)
    return accumulator.result()


@pytest.mark.parametrize("of", ["particles", "centres"])
@pytest.mark.parametrize(("molecule", "density"), MOLECULES.values(), ids=MOLECULES.keys())
def test_it_is_that_of_rouse(molecule, density, of):
    """At every lag, from the first flight on; collisions that are not quite independent: 2 %."""
    result = moved(of, density, molecule)
    assert result.expected is not None and "Rouse" in result.theory
    off = np.abs(result.value - result.expected)[1:]
    assert (off < 3 * result.error[1:] + 0.02 * result.expected[1:]).all()
    found = result.comparisons[0]
    assert found.expected == pytest.approx(
        theory.transport("srd", 3, density, 1.0, 90.0).diffusion / molecule.length
    )
    assert abs(found.measured - found.expected) < 3 * found.error + 0.02 * found.expected
    assert found.error < 0.02 * found.expected


def test_across_a_shear_it_is_the_same():
    """Along gradient and vorticity; along the flow, where images slide, it is refused."""
    molecule, density = MOLECULES["dimers"]
    result = moved("centres", density, molecule, shear_rate=0.02, thermostat=MaxwellBoltzmann())
    assert result.extra["components"] == "yz" and result.expected is not None
    off = np.abs(result.value - result.expected)[1:]
    assert (off < 3 * result.error[1:] + 0.03 * result.expected[1:]).all()
    with pytest.raises(CaseError, match=r"not 'x' under shear"):
        make_case(
            (8, 8), [MeanSquareDisplacement(of="centres", components=["x"])], density=4,
            molecule=molecule, shear_rate=0.1,
        )  # fmt: skip


@pytest.mark.parametrize("particles", [40, 999, 10**6])
@pytest.mark.parametrize("of", ["particles", "centres"])
def test_groups_hold_whole_molecules(of, particles):
    """Beads of one molecule move together: error bars must not take them for independent."""
    molecule = MOLECULES["chains"][0]
    case = make_case((10, 10), density=4, molecule=molecule)
    accumulator = MeanSquareDisplacement(of=of, particles=particles).accumulator(case)
    groups, ids = accumulator.origins.groups, accumulator.ids
    assert accumulator.origins.particles == len(ids) // (4 if of == "centres" else 1)
    assert groups == min(GROUPS, len(ids) // 4)
    group = np.arange(len(ids)) % groups
    for number in np.unique(ids // 4):
        assert len(set(group[ids // 4 == number])) == 1 and (ids // 4 == number).sum() == 4


def test_slow_beads_have_no_diffusion_coefficient_yet():
    """Beads diffuse only when their molecule has forgotten its shape; when, FENE does not say."""
    molecule = Molecule(length=40, bond=Harmonic(K=1.0))
    (found,) = moved("particles", 10, molecule, 100, timestep=0.1).comparisons
    assert np.isnan(found.measured)
    assert found.note.startswith("undetermined: fewer than three lags from ")
    fene = Molecule(length=2, bond=FENE(k=6.0, R0=2.0))
    bath = MaxwellBoltzmann()
    # known before the first step
    assert moved("particles", 5, fene, 0, thermostat=bath).expected is None
    assert moved("centres", 5, fene, 0, thermostat=bath).expected is not None


def test_solutes_in_a_random_solvent_obey_it():
    """Friction without hydrodynamics is Rouse's; beads that seldom share a cell: 2 %."""
    chains = Solutes(
        polymers=(Polymer(number=5), Polymer(number=100, length=4)), mass=5.0,
        bond=Harmonic(K=0.02), solvent="random",
    )  # fmt: skip
    observables = [
        MeanSquareDisplacement(of=of, kind=2, every=5, max_lag=200) for of in ("centres", "beads")
    ]
    case = Case(run=Run(steps=3000), box=Box([20, 20, 20]), fluid=Fluid(), solutes=chains)
    fluid = CPU(case)
    start(fluid)
    accumulators = [observable.accumulator(case) for observable in observables]
    for _ in range(600):
        fluid.advance(5)
        for accumulator in accumulators:
            accumulator.observe(fluid)
    for accumulator in accumulators:
        result = accumulator.result()
        off = np.abs(result.value - result.expected)[1:]
        assert (off < 3 * result.error[1:] + 0.02 * result.expected[1:]).all()
    with pytest.raises(CaseError, match="a random solvent has none"):
        MeanSquareDisplacement().accumulator(case)


def test_single_particles_have_no_centres():
    with pytest.raises(CaseError, match=r"observe\[#1\].of = 'centres' needs molecules"):
        make_case((8, 8), [MeanSquareDisplacement(of="centres")])


class TestWhenSolutesDiffuse:
    """Lags from which on the displacement of solutes is a straight line."""

    CHAINS = Solutes((Polymer(4), Polymer(4, length=20)), mass=10.0, bond=Harmonic(K=1.5))

    def first(self, of, kind, solvent, size=(12, 16, 12)):
        solutes = dataclasses.replace(self.CHAINS, solvent=solvent)
        case = make_case(size, density=10, collision=SRD(angle=130), solutes=solutes)
        return MeanSquareDisplacement(of=of, kind=kind).accumulator(case).theory.diffusive_from()

    def test_in_the_fluid_momentum_has_spread_over_the_box(self):
        viscosity = theory.transport("srd", 3, 10, 0.1, 130.0).viscosity
        expected = 5 * 16**2 / (4 * np.pi**2 * viscosity)
        for kind in (1, 2):
            assert self.first("centres", kind, "fluid") == pytest.approx(expected)
        assert self.first("beads", 1, "fluid") == pytest.approx(expected)
        assert self.first("beads", 2, "fluid") > expected

    def test_chains_turn_as_zimm_or_rouse_have_it(self):
        """Twenty beads of b = 1: in the fluid they forget their shape several times as fast."""
        friction = 1 / theory.bead_diffusion("srd", 3, 10, 0.1, 130.0, 10.0)
        viscosity = 10 * theory.transport("srd", 3, 10, 0.1, 130.0).viscosity
        laws = {
            "fluid": theory.zimm_times(20, friction, viscosity, 1.0),
            "random": theory.rouse_times(theory.linear_modes(20), friction, K=1.5),
        }
        for solvent, law in laws.items():
            solutes = dataclasses.replace(self.CHAINS, solvent=solvent)
            case = make_case((9, 9, 9), density=10, collision=SRD(angle=130), solutes=solutes)
            times, note = NormalModes(kind=2).accumulator(case).times()
            np.testing.assert_allclose(times.mode, law.mode, rtol=1e-9)
            assert ("Zimm" in note) == (solvent == "fluid")

    def test_in_a_random_solvent_only_inertia_counts(self):
        alone = theory.bead_diffusion("srd", 3, 10, 0.1, 130.0, 10.0)
        for kind in (1, 2):  # that of beads is lower by 2 %, as they meet others
            assert self.first("centres", kind, "random") == pytest.approx(50 * alone, rel=0.03)
        assert self.first("beads", 2, "random") > 100


class TestHowSolutesDiffuse:
    """What theory says of beads that drag the fluid along."""

    def coefficient(self, of, kind, size=(16, 16, 16), **more):
        solutes = dataclasses.replace(TestWhenSolutesDiffuse.CHAINS, **more)
        case = make_case(size, density=10, collision=SRD(angle=130), solutes=solutes)
        return MeanSquareDisplacement(of=of, kind=kind).accumulator(case).theory.coefficient()

    def test_is_that_of_cells_in_a_periodic_cube(self):
        """Viscosity of the fluid alone, however many beads are in it."""
        eta = theory.transport("srd", 3, 10, 0.1, 130.0).dynamic_viscosity
        friction = 1 / theory.bead_diffusion("srd", 3, 10, 0.1, 130.0, 10.0)
        solutes = TestWhenSolutesDiffuse.CHAINS
        (chains, length), beads = ((solutes.polymers[1].number, 20), solutes.polymers[0].number)
        others = [((beads - 1) / 16**3, 10.0), (chains * length / 16**3, 10.0)]
        among = 1 / theory.bead_diffusion("srd", 3, 10, 0.1, 130.0, 10.0, 1.0, 1.0, *others)
        for of, kind, length, zeta in (("beads", 1, 1, among), ("centres", 2, 20, friction)):
            free = theory.kirkwood_in_cells(length, zeta, eta, 1.0)
            found, note = self.coefficient(of, kind)
            assert found == pytest.approx(theory.diffusion_in_box(free, 16, eta))
            rough = "approximate: " if length > 1 else ""  # a chain is no rigid body
            assert note.startswith(f"{rough}Kirkwood")

    def test_says_where_nothing_is_known(self):
        for found, note in (
            self.coefficient("beads", 2), self.coefficient("beads", 1, size=(12, 16, 16)),
            self.coefficient("beads", 1, pair=WCA()),
        ):  # fmt: skip
            assert np.isnan(found) and note == "no theory of such beads in a fluid"
        found, note = self.coefficient("particles", 1)
        assert np.isnan(found) and note == "no theory of a fluid with solutes"


def test_rouse_is_approximate_where_beads_stir_up_a_flow():
    molecule = Molecule(length=2, bond=Harmonic(K=1 / 20))
    for timestep, word in (
        (0.1, "approximate: Rouse; flow that a bead stirs up"),
        (1.0, "Rouse"),
        (1.2, "approximate: Rouse; bonds turn by 0.54 rad"),
    ):
        case = make_case((12, 12, 12), timestep=timestep, molecule=molecule)
        assert rouse_note(case).startswith(word)
    solutes = Solutes((Polymer(4, length=10),), bond=Harmonic(K=1.5), solvent="random")
    assert rouse_note(make_case((8, 8, 8), solutes=solutes)).startswith("approximate")


def test_a_random_solvent_holds_what_is_pushed():
    pushed = {"size": (8, 8, 8), "force": Uniform((0.1, 0, 0)), "thermostat": MaxwellBoltzmann()}
    for solvent, said in (("fluid", True), ("random", False)):
        case = make_case(**pushed, solutes=Solutes((Polymer(4),), solvent=solvent))
        warned = any("nothing holds" in text for text in derive(case).warnings)
        assert warned == said
