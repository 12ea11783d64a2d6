"""Fluids of molecules: mechanics of the bonds, equilibrium of the beads, stress."""

import dataclasses

import numpy as np
import pytest

from mesokit import (
    FENE,
    SRD,
    WCA,
    Bending,
    BondLength,
    Disk,
    Harmonic,
    MaxwellBoltzmann,
    Plates,
    Spring,
    Surface,
    Uniform,
)
from mesokit.errors import CaseError, RunError
from mesokit.method.mpcd.expected.molecules import bond_at_rest
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start.first_state import first_state
from tests.helpers.small_fluids import make_case, make_fluid, mean

pytestmark = pytest.mark.long

CHAINS = {
    "dimers": Molecule(bond=Harmonic(K=1 / 6), substeps=4),
    "decamers": Molecule(length=10, bond=Harmonic(K=1.0), substeps=4),
    "rings": Molecule(topology="ring", length=5, bond=Spring(k=8.0, length=0.6), substeps=8),
    "stars": Molecule(topology="star", length=7, arms=3, bond=Harmonic(K=1.0), substeps=4),
    "stiff chains": Molecule(
        length=5, bond=Spring(k=40.0, length=0.8), bending=Bending(kappa=4.0), substeps=20
    ),
    "Kremer and Grest": Molecule(length=5, bond=FENE(), pair=WCA(), substeps=60),
}


@pytest.fixture(scope="module", params=CHAINS.values(), ids=CHAINS.keys())
def molecule(request):
    return request.param


def total_energy(fluid):
    return fluid.totals()[2] + fluid.potential_energy()


def refined(molecule, substeps, **parts):
    """The same molecules by other sub-steps. Collisions keep the energy of each cell exactly."""
    molecule = dataclasses.replace(molecule, substeps=substeps)
    return make_fluid((8, 8, 8), density=molecule.length, molecule=molecule, **parts)


def test_energy_is_kept_to_second_order_in_the_substep(molecule):
    """Largest change of the energy over ten flights, with sub-steps and with half of them."""
    changes = []
    for refine in (1, 2, 4):
        fluid = refined(molecule, refine * molecule.substeps)
        first, worst = total_energy(fluid), 0.0
        for _ in range(10):
            fluid.advance(1)
            worst = max(worst, abs(total_energy(fluid) - first))
        changes.append(worst / first)
    assert changes[0] < 0.01
    assert changes[1] < 0.45 * changes[0] and changes[2] < 0.45 * changes[1]


def test_momentum_is_kept_to_rounding(molecule):
    fluid = refined(molecule, molecule.substeps)
    _, momentum, _ = fluid.totals()
    fluid.advance(300)
    assert abs(fluid.totals()[1] - momentum).max() < 1e-9 * fluid.n


def test_exact_dimers_are_what_many_substeps_come_to():
    found = []
    for parts in ({"propagation": "exact"}, {"substeps": 300}):
        molecule = Molecule(bond=Harmonic(K=0.4), **parts)
        fluid = make_fluid(
            (6, 6, 6), density=4, molecule=molecule, measures=("stress",),
            force=Uniform(acceleration=(0.1, 0.0, -0.2)), timestep=0.3,
        )  # fmt: skip
        fluid.advance(1, measure=["stress"])
        found.append((fluid.positions(unwrapped=True), fluid.velocities(), fluid.stress["bond"]))
    for a, b in zip(*found, strict=True):
        np.testing.assert_allclose(a, b, atol=1e-6)


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize(
    "molecule",
    [
        Molecule(bond=Harmonic(K=1.0)),
        Molecule(bond=Harmonic(K=1.0), propagation="exact"),
        Molecule(length=5, bond=Harmonic(K=1.0)),
        Molecule(topology="ring", length=4, bond=Harmonic(K=1.0)),
        Molecule(length=3, bond=FENE(k=6.0, R0=2.0)),
    ],
    ids=["dimers", "exact dimers", "pentamers", "rings", "FENE"],
)
def test_bonds_and_beads_have_the_temperature(molecule, d):
    """The mean square bond is that of Boltzmann, at the start and after."""
    size = (20, 18) if d == 2 else (9, 10, 8)
    fluid = make_fluid(size, density=10, molecule=molecule, thermostat=MaxwellBoltzmann())
    expected = molecule.mean_square_bond(d, 1.0)
    bonds = (fluid.bond_vectors() ** 2).sum(axis=1).reshape(-1, len(molecule.bonds))
    assert mean(bonds.mean(axis=1)).agrees(expected)
    squares, temperatures = [], []
    for _ in range(30):
        fluid.advance(80)  # bonds forget in half of that
        squares.append((fluid.bond_vectors() ** 2).sum(axis=1).mean())
        temperatures.append(2 * fluid.totals()[2] / (d * (fluid.n - 1)))
    assert mean(squares).agrees(expected, systematic=0.01), (mean(squares), expected)
    assert mean(temperatures).agrees(1.0, systematic=0.002), mean(temperatures)


@pytest.mark.parametrize(("K", "timestep", "substeps"), [(1.3, 0.2, 2), (0.7, 0.25, 1)])
def test_bonds_are_as_long_as_their_sub_steps_make_them(K, timestep, substeps):
    molecule = Molecule(length=5, bond=Harmonic(K=K), substeps=substeps)
    parts = {"density": 10, "timestep": timestep, "molecule": molecule}
    parts |= {"thermostat": MaxwellBoltzmann()}
    case = make_case((20, 18), [BondLength()], **parts)
    longer = bond_at_rest(case)
    fluid = make_fluid((20, 18), **parts)
    squares = []
    for _ in range(120):
        fluid.advance(int(8 / timestep))
        squares.append((fluid.bond_vectors() ** 2).sum(axis=1).mean())
    found = mean(squares)
    assert longer - 1 > 6 * found.error / found.value  # is seen
    assert found.agrees(longer / K), (found, longer / K)
    printed = BondLength().accumulator(case).expected().trace(axis1=1, axis2=2)
    np.testing.assert_allclose(printed, longer / K, rtol=1e-5)


def test_length_three_for_one_sixth():
    assert Molecule(bond=Harmonic(K=1 / 6)).mean_square_bond(3, 1.0) == pytest.approx(9)
    ring = Molecule(topology="ring", length=4, bond=Harmonic(K=1.0))
    assert ring.mean_square_bond(3, 1.0) == pytest.approx(1.5 * 3 / 4)


@pytest.mark.parametrize("propagation", ["verlet", "exact"])
def test_pressure_is_that_of_an_ideal_gas_of_molecules(propagation):
    """Kinetic n kT, bonds -n kT (1 - 1/N): what holds together pushes less."""
    molecule = Molecule(bond=Harmonic(K=1.0), propagation=propagation)
    fluid = make_fluid(
        (8, 8, 8), molecule=molecule, thermostat=MaxwellBoltzmann(), measures=("stress",)
    )
    fluid.advance(50)
    kinetic, bond = [], []
    for _ in range(40):
        fluid.advance(9)
        fluid.advance(1, measure=["stress"])
        kinetic.append(-np.trace(fluid.stress["kinetic"]) / 3)
        bond.append(-np.trace(fluid.stress["bond"]) / 3)
    assert mean(kinetic).agrees(10.0, systematic=0.005), mean(kinetic)
    assert mean(bond).agrees(-5.0, systematic=0.01), mean(bond)


def test_a_force_moves_molecules_as_a_whole():
    g, molecule = 0.05, Molecule(length=4, bond=Harmonic(K=1.0))
    force = Uniform(acceleration=(g, 0.0, 0.0))
    fluid = make_fluid((4, 4, 4), density=4, molecule=molecule, force=force)
    fluid.advance(100)
    _, momentum, _ = fluid.totals()
    assert momentum == pytest.approx(
        [fluid.n * g * 100 * fluid.numbers.timestep, 0.0, 0.0], abs=1e-8
    )


class TestSheared:
    """Lees-Edwards: images slide, and bonds do not notice."""

    @pytest.mark.parametrize("frequency", [0.0, 0.02])
    def test_a_boundary_is_no_place(self, frequency):
        """Bonds over the sliding boundary are as long as all others, along and across."""
        molecule = Molecule(length=3, bond=Harmonic(K=1.0))
        fluid = make_fluid(
            (8, 10, 8), shear_rate=0.1, shear_frequency=frequency, molecule=molecule,
            thermostat=MaxwellBoltzmann(), density=9,
        )  # fmt: skip
        far, near, all_over, along = [], [], [], []
        for _ in range(40):
            fluid.advance(25)
            way, ends = fluid.bond_vectors(), fluid.bonds()
            y = fluid.positions(unwrapped=True)[:, 1]
            over = np.floor(y[ends[:, 0]] / 10) != np.floor(y[ends[:, 1]] / 10)
            far.append((way[over, 2] ** 2).mean())
            near.append((way[~over, 2] ** 2).mean())
            along.append((way[over, 0] ** 2).mean() / (way[~over, 0] ** 2).mean())
            all_over.append((way[:, 2] ** 2).mean())
        assert np.abs(way).max() < 8
        assert mean(all_over).agrees(0.5, systematic=0.03), mean(all_over)
        assert mean(along).agrees(1.0, systematic=0.06), mean(along)
        assert mean(far).agrees(0.5, systematic=0.06) and mean(near).agrees(0.5, systematic=0.03)

    def test_the_profile_is_linear_and_bonds_lean(self):
        rate, K = 0.1, 0.25
        molecule = Molecule(bond=Harmonic(K=K), substeps=2)
        fluid = make_fluid(
            (10, 20, 10), shear_rate=rate, molecule=molecule, thermostat=MaxwellBoltzmann()
        )
        fluid.advance(600)
        profile, lean = [], []
        for _ in range(60):
            fluid.advance(20)
            _, mass, momentum, _ = fluid.moments((1,), (20,))
            profile.append(momentum[0] / mass)
            way = fluid.bond_vectors()
            lean.append((way[:, 0] * way[:, 1]).mean())
        y = np.arange(20) + 0.5
        assert np.polyfit(y, np.mean(profile, axis=0), 1)[0] == pytest.approx(rate, rel=0.02)
        assert abs(np.mean(profile, axis=0) - rate * (y - 10)).max() < 0.1
        assert 0.05 < np.mean(lean) < 5


class TestAmongSolids:
    """Beads bounce off solids, and never are in them."""

    @pytest.mark.parametrize("rule", ["no-slip", "slip"])
    def test_plates(self, rule):
        molecule = Molecule(length=4, bond=Harmonic(K=0.5), substeps=5)
        fluid = make_fluid(
            (10, 8), density=10, molecule=molecule, thermostat=MaxwellBoltzmann(),
            force=Uniform(acceleration=(0.01, 0.0)), measures=("walls",),
            walls=[Plates(axis="y", upper=Surface(rule))],
        )  # fmt: skip
        for _ in range(30):
            fluid.advance(10)
            r = fluid.positions()
            assert (r[:, 1] >= 0).all() and (r[:, 1] <= 8).all()
        taken = fluid.wall_impulse[:, :2].sum(axis=0)
        given = np.array([fluid.n * 0.01 * 300 * fluid.numbers.timestep, 0.0])
        assert abs(given - taken - fluid.totals()[1]).max() < 1e-6 * fluid.n

    @pytest.mark.parametrize("rule", ["no-slip", "slip", "diffuse"])
    def test_a_disk(self, rule):
        molecule = Molecule(length=4, bond=Harmonic(K=0.5), substeps=5)
        disk = Disk(centre=(6, 5), radius=2.5, surface=Surface(rule))
        fluid = make_fluid(
            (16, 10), density=10, molecule=molecule, thermostat=MaxwellBoltzmann(), walls=[disk],
            force=Uniform(acceleration=(0.01, 0.0)), measures=("walls",),
        )  # fmt: skip
        for _ in range(30):
            fluid.advance(10)
            assert (fluid.numbers.solids.distance(fluid.positions()) >= 0).all()
        taken = fluid.wall_impulse[:, :2].sum(axis=0)
        given = np.array([fluid.n * 0.01 * 300 * fluid.numbers.timestep, 0.0])
        assert abs(given - taken - fluid.totals()[1]).max() < 1e-6 * fluid.n

    def test_bonds_between_plates_have_the_temperature(self):
        """Those of beads that feel nothing of one another are as long as without plates."""
        molecule = Molecule(bond=Harmonic(K=1.0), substeps=3)
        fluid = make_fluid(
            (20, 16), molecule=molecule, thermostat=MaxwellBoltzmann(), walls=[Plates(axis="y")],
            force=Uniform(acceleration=(0.0, 0.0)),  # the kernels of a force, without one
        )  # fmt: skip
        along = []
        for _ in range(30):
            fluid.advance(80)
            along.append((fluid.bond_vectors()[:, 0] ** 2).mean())
        assert mean(along).agrees(0.5, systematic=0.01), mean(along)


def test_start_from_arrays_takes_folded_ones():
    molecule = Molecule(length=4, bond=Harmonic(K=1.0))
    fluid = make_fluid((6, 7), density=4, molecule=molecule)
    r, v = fluid.positions(), fluid.velocities()
    bonds = fluid.bond_vectors()
    other = make_fluid((6, 7), r, v, density=4, molecule=molecule)
    near = np.abs(bonds).max(axis=1) < 3.0
    np.testing.assert_allclose(other.bond_vectors()[near], bonds[near], atol=1e-12)
    np.testing.assert_allclose(other.velocities(), v)


def test_a_torn_bond_stops_the_run():
    molecule = Molecule(length=2, bond=FENE(k=3.0, R0=2.0), substeps=2)
    parts = {"density": 2, "molecule": molecule, "thermostat": MaxwellBoltzmann()}
    fluid = make_fluid((8, 8), **parts)
    r, v = fluid.positions(), fluid.velocities()
    v[11] += 40.0
    fluid = make_fluid((8, 8), r, v, **parts)
    with pytest.raises(RunError, match=r"^step 1: the bond of particles 10 and 11 is longer than"):
        fluid.advance(100)


def test_energy_does_not_drift():
    molecule = Molecule(length=10, bond=Harmonic(K=1.0))
    fluid = make_fluid((10, 10, 10), molecule=molecule, collision=SRD(130))
    first = total_energy(fluid)
    fluid.advance(500)
    assert total_energy(fluid) == pytest.approx(first, rel=2e-3)


class TestOctant:
    """The start of the thesis: bonds of the right size, all of which point one way."""

    OCTANT = Molecule(length=5, bond=Harmonic(K=1.0), conformation="octant")

    @pytest.mark.parametrize("d", [2, 3])
    def test_bonds_are_uniform_in_the_octant(self, d):
        fluid = make_fluid((20, 20) if d == 2 else (9, 10, 8), density=10, molecule=self.OCTANT)
        bonds, s = fluid.bond_vectors(), np.sqrt(1.5)  # d s^2/3 = d kT/2K
        assert bonds.min() >= 0 and bonds.max() < s
        assert mean((bonds**2).sum(axis=1)).agrees(0.5 * d)
        assert mean(bonds.ravel()).agrees(0.5 * s) and mean(bonds.ravel() ** 4).agrees(s**4 / 5)
        assert abs(fluid.totals()[1]).max() < 1e-9 * fluid.n

    def test_molecules_forget_it(self):
        """After some relaxation times bonds point anywhere, as long as Boltzmann has them."""
        fluid = make_fluid((9, 10, 8), molecule=self.OCTANT, thermostat=MaxwellBoltzmann())
        fluid.advance(1500)  # seven times the longest normal-mode time
        bonds = fluid.bond_vectors().reshape(-1, 4, 3)
        assert all(mean(bonds[:, :, k].mean(axis=1)).agrees(0.0) for k in range(3))
        assert mean((bonds**2).sum(axis=2).mean(axis=1)).agrees(1.5)

    def test_it_stays_below_the_longest_bond(self):
        molecule = Molecule(length=5, bond=FENE(), pair=WCA(), conformation="octant")
        fluid = make_fluid((8, 8, 8), density=10, molecule=molecule)
        bonds = fluid.bond_vectors()
        assert bonds.min() >= 0 and np.linalg.norm(bonds, axis=1).max() < 0.9 * 1.5

    def test_where_it_has_no_meaning_it_is_refused(self):
        with pytest.raises(CaseError, match="close no ring"):
            Molecule(topology="ring", length=3, bond=Harmonic(K=1.0), conformation="octant")
        with pytest.raises(CaseError, match="not with bending"):
            dataclasses.replace(self.OCTANT, bending=Bending(kappa=1.0))
        case = make_case((6, 6), density=5, molecule=self.OCTANT)
        with pytest.raises(CaseError, match=r"conformation = 'octant': no effect with positions"):
            first_state(case, positions=np.zeros((180, 2)))
