"""Laws of domains: their walls, their length in time, and how fast it grows."""

import numpy as np
import pytest

from mesokit import theory
from mesokit.method.kinetic_monte_carlo.expected_structure import (
    domain_exponent,
    plain_spins,
    walls_in_equilibrium,
)
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.model.potts import Potts
from mesokit.method.kinetic_monte_carlo.observe.domain_length import DomainLength
from mesokit.method.kinetic_monte_carlo.observe.shared.neighbours import Neighbours
from mesokit.method.kinetic_monte_carlo.start import UniformStart
from mesokit.statistics import blocking_error
from tests.helpers.lattices import FakeLattice, lattice_case, near, results_of

SIZES = {1: (12,), 2: (8, 6), 3: (4, 6, 4)}


@pytest.mark.parametrize("ends", [(), ("x",)])
@pytest.mark.parametrize("name", KINDS)
def test_each_pair_of_neighbours_counts_once(name, ends):
    """Against all pairs of sites at the distance 1."""
    kind, size = KINDS[name], SIZES[KINDS[name].dimension]
    neighbours = Neighbours(lattice_case(size, Ising(), name, ends=ends))
    places, length = kind.places(size), np.array(size) * kind.spacing
    apart = places[:, None] - places
    folded = apart - length * np.rint(apart / length)
    if ends:
        folded[..., 0] = apart[..., 0]
    near_pairs = np.argwhere(abs(np.linalg.norm(folded, axis=-1) - 1) < 1e-9)
    numbers = np.arange(np.prod(size)).reshape(size)
    found = [
        pair
        for there, counts in neighbours.pairs(numbers)
        for pair in zip(numbers[counts], there[counts], strict=True)
    ]
    assert sorted(found + [pair[::-1] for pair in found]) == sorted(map(tuple, near_pairs))


def test_stripes_have_the_length_of_their_walls():
    """Stripes of 8 sites: a wall for each 8 sites, and waves of 16."""
    sites = np.repeat(np.arange(8) % 2, 8 * 16).reshape(64, 16)
    made = DomainLength().accumulator(lattice_case((64, 16), Potts(q=2)))
    made.observe(FakeLattice(sites))
    walls, waves = made.result().value[0]
    assert walls == pytest.approx(8) and 8 < waves < 16  # the third harmonic is seen too


def test_a_chain_that_is_quenched_has_the_domains_of_glauber():
    model, observe = Ising(kT=0.0, dynamics="glauber"), [DomainLength(every=1)]
    case = lattice_case((100_000,), model, "chain", steps=40, timestep=0.5, observe=observe)
    result = results_of(case)["domain-length"]
    assert near(result.comparisons) == {"last length from walls"}
    deviation = result.deviation[:, 0]
    assert abs(deviation).max() < 4.5
    assert result.value[:, 0] == pytest.approx(
        1 / theory.glauber_walls(0.5 * np.arange(41)), rel=0.02
    )


def test_domains_in_a_plane_grow_as_the_root_of_time():
    case = lattice_case((512, 512), Ising(kT=0.0), steps=100, observe=[DomainLength(every=4)])
    found = {one.key: one for one in results_of(case)["domain-length"].comparisons}
    exponent = found["exponent-of-the-length-from-walls"]
    assert exponent.expected == 0.5 and exponent.error < 0.04
    assert abs(exponent.measured - 0.5) < 4 * exponent.error
    last = found["last-length-from-walls"]  # measured at 251.5 on 1024 x 1024: 28.2
    assert abs(last.measured - 28.2 * (100 / 251.5) ** 0.5) < 4 * last.error
    assert last.error < 1.0


@pytest.mark.long
def test_domains_in_a_large_plane_have_the_known_lengths():
    """Lengths of an independent program, with an error of 2 %; means of six runs."""
    lengths = []
    for seed in range(1, 7):
        case = lattice_case(
            (1024, 1024), Ising(kT=0.0), steps=1000, seed=seed, observe=[DomainLength(every=25)]
        )
        result = results_of(case)["domain-length"]
        time = result.x["time"]
        lengths.append(result.value[:, 0])
    length, use = np.mean(lengths, axis=0), time >= 30
    slope = np.polyfit(np.log(time[use]), np.log(length[use]), 1)[0]
    assert slope == pytest.approx(0.5, abs=0.03)
    assert np.interp(251.5, time, length) == pytest.approx(28.2, rel=0.05)
    assert length[-1] == pytest.approx(56.6, rel=0.08)


def test_walls_of_spins_in_equilibrium_leave_no_domains():
    observe = [DomainLength(every=2, walls=0.0)]
    case = lattice_case(
        (64, 64), Ising(kT=2.0), steps=1000, warmup=50, start=UniformStart(), observe=observe
    )
    walls = 1 / results_of(case)["domain-length"].value[:, 0]
    error = blocking_error(walls)
    assert abs(walls.mean() - walls_in_equilibrium(case)) < 4 * error
    assert error < 0.03 * walls.mean()
    assert walls_in_equilibrium(case) == pytest.approx(1 - 0.5 * 1.74556, abs=1e-5)


def test_exponents_are_those_of_what_is_conserved():
    swap = LatticeGas(
        process=[GasProcess(name="hop", site="A -> empty", neighbour="empty -> A", rate=1.0)]
    )
    assert domain_exponent(lattice_case((32, 32), Ising(kT=1.0)))[0] == 0.5
    assert domain_exponent(lattice_case((32, 32), Potts(q=3, kT=0.5)))[0] == 0.5
    kept = lattice_case((32, 32), Ising(kT=1.3, moves="exchange"))
    assert domain_exponent(kept)[0] == pytest.approx(1 / 3)
    assert walls_in_equilibrium(kept) > 0 and not plain_spins(kept, "square")
    for model in (Ising(kT=2.5), Ising(kT=1.0, field=0.1), Ising(coupling=-1.0), swap):
        assert np.isnan(domain_exponent(lattice_case((32, 32), model))[0])
