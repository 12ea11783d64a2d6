"""Molecules whose bonds are a list: phantom networks have the sizes of Kirchhoff's matrix."""

import numpy as np
import pytest

from mesokit import FENE, WCA, Harmonic, Polymer, Solutes
from mesokit.errors import CaseError
from mesokit.method.mpcd.solute.free import FreeMolecule
from mesokit.method.mpcd.start.first_state import first_state
from mesokit.method.mpcd.start.growth import grown
from tests.helpers.small_fluids import make_fluid, mean

PATCH = ((0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (3, 4))  # a loop, a chord, a tail
K = 1.5
NETWORK = Polymer(250, length=5, topology="free", bonds=PATCH)
DENDRIMER = tuple((0 if b < 4 else (b + 2) // 2 - 2, b) for b in range(1, 10))


def everywhere(places):
    return np.ones(places.shape[:-1], bool)


def squares(kT=1.0, d=2):
    """Mean square distance of any two beads: from the pseudo-inverse of the matrix."""
    matrix = np.zeros((5, 5))
    for i, j in PATCH:
        matrix[[i, j], [i, j]] += 1
        matrix[[i, j], [j, i]] -= 1
    inverse = np.linalg.pinv(matrix)
    own = np.diag(inverse)
    return d * kT / (2 * K) * (own[:, None] + own[None] - 2 * inverse)


def distances(places):
    r = places.reshape(-1, 5, 2)
    return ((r[:, :, None] - r[:, None]) ** 2).sum(axis=3).mean(axis=0)


def test_drawn_networks_are_in_equilibrium():
    solutes = Solutes([Polymer(4000, length=5, topology="free", bonds=PATCH)], bond=Harmonic(K=K))
    box = np.array([30.0, 30.0])
    found = distances(grown(solutes, 1.0, box, box, 1, everywhere))
    i, j = np.triu_indices(5, 1)
    assert np.abs(found[i, j] / squares()[i, j] - 1).max() < 4.5 / np.sqrt(4000)


@pytest.mark.long
def test_networks_come_to_the_sizes_of_theory():
    """From three times their size, in a random solvent, to the distances of all pairs of beads."""
    solutes = Solutes([NETWORK], mass=2.0, bond=Harmonic(K=K), solvent="random")
    fluid = make_fluid((30, 30), solutes=solutes, density=5, timestep=0.2, seed=2)
    fluid.solutes.places[:] *= 3.0
    fluid.advance(300)
    found = []
    for _ in range(24):
        fluid.advance(50)
        found.append(distances(fluid.solutes.places))
    for i, j in zip(*np.triu_indices(5, 1), strict=True):
        measured = mean(np.array(found)[:, i, j].reshape(12, 2).mean(axis=1))
        assert measured.agrees(squares()[i, j], 0.006) and measured.error < 0.03 * squares()[i, j]


def test_theory_knows_networks():
    molecule = Solutes([NETWORK], bond=Harmonic(K=K)).molecule(0)
    bonds = [squares()[i, j] for i, j in PATCH]
    assert molecule.mean_square_bond(2, 1.0) == pytest.approx(np.mean(bonds))


def test_a_dendrimer_grows_without_overlaps():
    solutes = Solutes(
        [Polymer(3, length=10, topology="free", bonds=DENDRIMER)], bond=FENE(), pair=WCA()
    )
    box = np.full(3, 12.0)
    r = grown(solutes, 1.0, box, box, 1, everywhere)
    links = solutes.bonds()
    lengths = np.linalg.norm(r[links[:, 0]] - r[links[:, 1]], axis=1)
    assert len(lengths) == 27 and lengths.max() < 1.5 and lengths.min() > 0.7
    apart = np.linalg.norm(r[:, None] - r[None], axis=2) + 9 * np.eye(30)
    assert apart.min() > 0.7


def test_lists_come_from_files_and_stay_with_the_case(tmp_path, make_case):
    file = tmp_path / "bonds.txt"
    file.write_text("# a patch\n" + "\n".join(f"{i} {j}" for i, j in PATCH))
    solutes = Solutes([Polymer(2, length=5, topology="free", bonds=str(file))], bond=Harmonic(K=K))
    file.unlink()
    assert isinstance(solutes.molecule(0), FreeMolecule) and solutes.molecule(0).bonds == PATCH
    case = make_case((8, 8), solutes=solutes)
    (tmp_path / "case.toml").write_text(case.to_toml())
    again = type(case).from_toml(tmp_path / "case.toml")
    np.testing.assert_array_equal(again.solutes.bonds(), solutes.bonds())


@pytest.mark.parametrize(
    ("parts", "says"),
    [
        ({"bonds": [(0, 1)]}, "bonds: they leave 2 pieces"),
        ({"bonds": [(0, 1), (1, 2), (1, 0)]}, r"bonds: row 3, \[1, 0\]: said before"),
        ({"bonds": [(0, 3)]}, r"bonds: row 1, \[0, 3\]: expected beads from 0 to 2"),
        ({"bonds": "none.txt"}, "bonds = .*none.txt': cannot be read: no such file"),
        ({}, "bonds: missing; topology = 'free' needs them"),
        ({"topology": "chain", "bonds": [(0, 1)]}, "bonds: only with topology = 'free'"),
    ],
)
def test_lists_that_make_no_molecule(parts, says):
    with pytest.raises(CaseError, match=says):
        Polymer(**{"length": 3, "topology": "free"} | parts)


def test_loops_of_other_bonds_need_places(make_case):
    case = make_case((8, 8), solutes=Solutes([NETWORK], bond=FENE()))
    with pytest.raises(CaseError, match=r"solutes\.start\.positions: missing; .* close loops"):
        first_state(case)
