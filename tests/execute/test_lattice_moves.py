"""Moves on lattices, listed in plain Python: against compiled tables, energies and first rates."""

import numpy as np
import pytest

from mesokit.method.kinetic_monte_carlo.model.aggregation import Aggregation
from mesokit.method.kinetic_monte_carlo.model.balance import detailed_balance
from mesokit.method.kinetic_monte_carlo.model.eden import Eden
from mesokit.method.kinetic_monte_carlo.model.first_rates import first_rate, rate_of_all
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.islands import Islands
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.model.potts import Potts
from mesokit.method.kinetic_monte_carlo.model.rsos import RestrictedSolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.sintering import Sintering
from mesokit.method.kinetic_monte_carlo.model.solid_on_solid import SolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.surface_diffusion import SurfaceDiffusion
from tests.helpers.lattices import lattice_case, lattice_engine

ADSORB = GasProcess(name="adsorb", site="empty -> A", rate=1.0)
DESORB = GasProcess(name="desorb", site="A -> empty", rate=0.5, bond=0.3, bonded=["A"])
HOP = GasProcess(
    name="hop", site="A -> empty", neighbour="empty -> A", rate=2.0, bond=0.3, bonded=["A"]
)
PAIRS = GasProcess(name="pair", site="empty -> B", neighbour="empty -> B", rate=2.0)
PARTS = GasProcess(name="part", site="B -> empty", neighbour="B -> empty", rate=0.5)
TURN = GasProcess(name="turn", site="A -> B", rate=0.7, bond=0.3, bonded=["A"])
BACK = GasProcess(name="back", site="B -> A", rate=0.7)
MIXED = GasProcess(name="mixed", site="A -> B", rate=0.2, bond=0.5, bonded=["A", "B"])
THREE = ["empty", "A", "B"]
BALANCED = {
    "metropolis": Ising(kT=1.7, field=0.2),
    "glauber": Ising(kT=1.7, field=0.2, dynamics="glauber"),
    "potts": Potts(q=3, kT=0.8),
    "spins that are exchanged": Ising(kT=1.7, moves="exchange"),
    "states that are exchanged": Potts(q=2, kT=0.8, moves="exchange", dynamics="glauber"),
    "islands that break": Islands(flux=0.0, bond_factor=0.1),
    "sintering": Sintering(),
    "adatoms": SurfaceDiffusion(bond_energy=0.4, flux=1.0, desorption_rate=3.0),
    "a surface": SolidOnSolid(bond_energy=0.7),
    "a gas": LatticeGas(process=[ADSORB, DESORB, HOP]),
    "two species": LatticeGas(
        species=THREE, process=[ADSORB, DESORB, HOP, PAIRS, PARTS, TURN, BACK]
    ),
}
BROKEN = {
    "deposit": SolidOnSolid(flux=0.1),
    "adsorb": SurfaceDiffusion(bond_energy=0.4, flux=1.0),
    "hop down": SolidOnSolid(step_barrier=0.5),
}
OTHERS = [
    Aggregation(sticking=0.4, reservoir=0.2),
    Eden(version="A"),
    Eden(version="B"),
    Eden(version="C"),
    RestrictedSolidOnSolid(),
    LatticeGas(species=THREE, process=[ADSORB, DESORB, HOP, TURN, MIXED]),
]


class WrongSpins(Ising):
    """Spins that flip as if they were warmer than they are."""

    def list_moves(self, kind):
        return Ising(kT=1.1 * self.kT).list_moves(kind)


@pytest.mark.parametrize("kind", ["square", "triangular"])
@pytest.mark.parametrize("ends", [[], ["x"]])
@pytest.mark.parametrize("name", BALANCED)
def test_rates_are_in_balance_with_the_energy(name, ends, kind):
    assert detailed_balance(lattice_case((8, 8), BALANCED[name], kind, ends=ends)) == ""


@pytest.mark.parametrize("name", BROKEN)
def test_what_breaks_the_balance_is_named(name):
    assert detailed_balance(lattice_case((8,), BROKEN[name], "chain")) in (name, "hop")


def test_rates_at_another_temperature_are_not_in_balance():
    case = lattice_case((8, 8), Ising(kT=1.5))
    object.__setattr__(case.lattice, "model", WrongSpins(kT=1.5))
    assert detailed_balance(case) in ("up", "down")


@pytest.mark.parametrize(
    "processes",
    [
        [ADSORB, HOP],  # nothing leaves
        [ADSORB, GasProcess(name="off", site="A -> empty", rate=0.5), HOP],  # bonds of one alone
        [ADSORB, DESORB, PAIRS, PARTS, TURN, GasProcess(name="back", site="B -> A", rate=0.1)],
    ],
)
def test_a_gas_that_circles_has_no_energy(processes):
    gas = LatticeGas(species=THREE, process=processes)
    assert gas.energies() is None
    assert detailed_balance(lattice_case((8, 8), gas)) is None


def test_energies_of_a_gas_follow_from_its_rates():
    found = BALANCED["two species"].energies()
    assert found.site == pytest.approx([0.0, -np.log(2.0), -np.log(2.0)])
    assert found.pair == pytest.approx(np.diag([0.0, -0.3, 0.0]))


TABLES = [one for one in BALANCED.values() if getattr(one, "moves", "") != "exchange"]


@pytest.mark.parametrize("model", [*TABLES, *BROKEN.values(), *OTHERS])
def test_tables_have_the_rates_of_all_moves(model):
    case = lattice_case((9, 8), model, ends=["x"])
    engine = lattice_engine((9, 8), model, ends=["x"])
    states = np.random.default_rng(3).integers(len(model.states()) or 4, size=engine.n)
    engine.start(states)
    compiled = engine.model.rates[engine.lattice.around[engine.places]]
    assert rate_of_all(case, states) == pytest.approx(compiled.sum())
    assert compiled.sum() > 0


def test_two_processes_count_their_own_neighbours():
    """One counts bonds to A, the other to A and B: neither adds to the other's."""
    alone = LatticeGas(species=THREE, process=[DESORB]).kernel
    both = LatticeGas(
        species=THREE,
        process=[DESORB, GasProcess(name="never", site="A -> B", rate=0.0, bond=1.0,
                                    bonded=["A", "B"])],
    ).kernel  # fmt: skip
    kind = lattice_case((4, 4), Ising()).lattice.lattice
    assert np.unique(both(kind, False).rates) == pytest.approx(np.unique(alone(kind, False).rates))


def test_the_first_rate_of_exchanges_is_not_listed():
    """It depends on neighbours of neighbours."""
    assert first_rate(lattice_case((4, 4), Ising(moves="exchange"))) is None


def test_the_first_rate_is_that_of_the_start():
    case = lattice_case((10, 10), Ising(kT=2.0), start=None, steps=1)
    engine = lattice_engine((10, 10), Ising(kT=2.0))
    compiled = engine.model.rates[engine.lattice.around[engine.places]]
    assert first_rate(case) == pytest.approx(compiled.sum())


@pytest.mark.parametrize(
    ("version", "rate"), [("A", 7), ("B", 8), ("C", 3)]
)  # an angle of three cells: empty sites beside it, bonds to them, cells
def test_versions_of_eden_grow_at_sites_bonds_or_cells(version, rate):
    case = lattice_case((8, 8), Eden(version=version))
    cells = np.zeros((8, 8), int)
    cells[3, 3] = cells[3, 4] = cells[4, 3] = 1
    assert rate_of_all(case, cells.ravel()) == pytest.approx(rate)
