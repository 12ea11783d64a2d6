"""Laws of islands: which sites they have, and how many there are of each size."""

import numpy as np
import pytest

from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.observe.island_density import IslandDensity
from mesokit.method.kinetic_monte_carlo.observe.island_sizes import IslandSizes
from mesokit.method.kinetic_monte_carlo.observe.shared.islands_of import islands
from mesokit.method.kinetic_monte_carlo.observe.shared.neighbours import Neighbours
from mesokit.method.kinetic_monte_carlo.start import UniformStart
from tests.helpers.lattices import FakeLattice, lattice_case, near, results_of

SIZES = {1: (24,), 2: (8, 6), 3: (4, 6, 4)}
GAS = LatticeGas(
    process=[
        GasProcess(name="adsorb", site="empty -> A", rate=1.0),
        GasProcess(name="desorb", site="A -> empty", rate=0.5),
        GasProcess(name="hop", site="A -> empty", neighbour="empty -> A", rate=1.0),
    ]
)


def measured(observable, sites, model=None, kind="square", **lattice):
    made = observable.accumulator(lattice_case(sites.shape, model or Ising(), kind, **lattice))
    made.observe(FakeLattice(sites))
    return made.result()


@pytest.mark.parametrize("ends", [(), ("x",)])
@pytest.mark.parametrize("name", KINDS)
def test_islands_are_sites_that_can_be_reached_from_one_another(name, ends):
    kind, size = KINDS[name], SIZES[KINDS[name].dimension]
    use = np.random.default_rng(5).random(np.prod(size)) < 0.4
    places, length = kind.places(size), np.array(size) * kind.spacing
    apart = places[:, None] - places
    folded = apart - length * np.rint(apart / length)
    if ends:
        folded[..., 0] = apart[..., 0]
    linked = (abs(np.linalg.norm(folded, axis=-1) - 1) < 1e-9) & use & use[:, None]
    left, expected = set(np.flatnonzero(use).tolist()), {}
    while left:
        reached = {min(left)}
        while True:
            more = set(np.flatnonzero(linked[sorted(reached)].any(axis=0)).tolist()) | reached
            if more == reached:
                break
            reached = more
        expected[min(reached)] = len(reached)
        left -= reached
    sizes, first = islands(Neighbours(lattice_case(size, Ising(), name, ends=ends)), use)
    assert dict(zip(first.tolist(), sizes.tolist(), strict=True)) == expected


def test_islands_drawn_by_hand_are_counted():
    sites = np.zeros((16, 16), int)
    sites[0, 3] = sites[15, 3] = sites[15, 4] = 1  # over the periodic end along x
    sites[7, 7] = sites[8, 8] = 1  # two that touch at a corner
    found = {one.key: one.measured for one in measured(IslandDensity(), sites).comparisons}
    assert found["last-islands-per-site"] == pytest.approx(3 / 256)
    assert found["last-mean-size-of-islands"] == pytest.approx(5 / 3)
    assert found["last-share-of-covered-sites"] == pytest.approx(5 / 256)
    larger = measured(IslandDensity(smallest=2), sites).comparisons
    assert [one.measured for one in larger] == pytest.approx([1 / 256, 3, 5 / 256])
    ends = measured(IslandDensity(), sites, ends=["x"]).comparisons
    assert ends[0].measured == pytest.approx(4 / 256)
    sizes = measured(IslandSizes(), sites)
    assert sizes.select(size=1)[0] == pytest.approx(2 / 256)
    assert sizes.select(size=3)[0] == pytest.approx(1 / 256) and np.isnan(sizes.value[1])
    assert sizes["mean size of the island of a site"].measured == pytest.approx(11 / 5)


def test_islands_of_heights_are_above_a_level():
    heights = np.zeros((16, 16), int)
    heights[2:5, 2:5] = 1
    heights[3, 3] = 2
    for level, sites in ((None, 9), (1, 9), (2, 1), (0, 256)):
        found = measured(IslandDensity(level=level), heights, Family()).comparisons
        assert found[0].measured == pytest.approx(1 / 256)
        assert found[1].measured == pytest.approx(sites)


def test_a_gas_on_a_chain_has_the_islands_of_chance():
    """(1 - p)^2 p^s islands of s sites, (1 - p) p^m of m sites and more, also on the way there."""
    observe = [IslandSizes(every=2), IslandDensity(every=1, smallest=2)]
    case = lattice_case(
        (50_000,), GAS, "chain", steps=40, timestep=0.1, start=UniformStart(), observe=observe[1:]
    )
    result = results_of(case)["islands"]
    use = result.error > 0
    assert use.sum() > 30 and abs(result.deviation[use]).max() < 5
    assert result.value[-1] == pytest.approx(result.expected[-1], rel=0.03)
    assert near(result.comparisons) == {"last islands per site"}
    case = lattice_case((4096,), GAS, "chain", steps=200, warmup=10, observe=observe[:1])
    result = results_of(case)["island-sizes"]
    use = result.error > 0
    assert use.sum() > 10 and abs(result.deviation[use][:12]).max() < 5
    assert near(result.comparisons) == {"islands per site"}
    assert result.select(size=1)[0] == pytest.approx((1 / 3) ** 2 * (2 / 3), rel=0.02)
    mean = result["mean size of islands"]
    assert abs(mean.measured - 3.0) < 4 * mean.error < 0.3


def test_spins_on_a_chain_have_domains_of_geometric_lengths():
    case = lattice_case(
        (4096,), Ising(kT=1.0), "chain", steps=400, warmup=50, observe=[IslandSizes(every=4)]
    )
    result = results_of(case)["island-sizes"]
    use = result.error > 0
    assert use.sum() > 10 and abs(result.deviation[use][:12]).max() < 5
    mean = result["mean size of islands"]
    expected = 2 / (1 - np.tanh(1.0))
    assert abs(mean.measured - expected) < 4 * mean.error < 0.1 * expected


def test_seeds_are_pooled():
    sites = [np.random.default_rng(seed).integers(0, 2, (16, 16)) for seed in (1, 2)]
    case, made = lattice_case((16, 16), Ising()), []
    for some in sites:
        made.append(IslandSizes().accumulator(case))
        made[-1].observe(FakeLattice(some))
    each = [one.result().comparisons[0].measured for one in made]
    made[0].pool(made[1])
    assert made[0].result().samples == 2
    assert made[0].result().comparisons[0].measured == pytest.approx(np.mean(each))
