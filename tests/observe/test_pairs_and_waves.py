"""Radial distribution and structure factor, of places that are known."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    WCA,
    Harmonic,
    Plates,
    Polymer,
    RadialDistribution,
    Solutes,
    StructureFactor,
    Uniform,
    theory,
)
from mesokit.errors import CaseError
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.observe.structure_factor import wave_shells
from mesokit.observe.shared.pairs import count_pairs, count_within
from tests.helpers.comparisons import comparisons
from tests.helpers.fake_fluid import FakeFluid
from tests.helpers.fake_molecules import Moved
from tests.helpers.small_fluids import make_case

SIZES = [(9, 8), (6, 5, 7)]
BOND = Harmonic(K=1.5)


def solution(observable, size, *polymers, pair=None, **parts):
    """Solutes in a random solvent."""
    bond = BOND if any(p.length > 1 for p in polymers) else None
    solutes = Solutes(polymers, bond=bond, pair=pair, solvent="random")
    return make_case(size, [observable], solutes=solutes, **parts)


def gaussian_chains(rng, number, length, size):
    """Ideal chains (number, length, d), anywhere."""
    bond = rng.normal(size=(number, length, len(size))) / np.sqrt(2 * BOND.K)
    bond[:, 0] = rng.random((number, len(size))) * size
    return bond.cumsum(axis=1)


def sampled(observable, case, every):
    """What it says of molecules at each of the places."""
    engine, accumulator = Moved(case), observable.accumulator(case)
    for time, r in enumerate(every):
        accumulator.observe(engine.place(float(time), r))
    return accumulator


def agrees(result):
    """Whether deviations are those of chance: chi-square per bin is 1 on the average."""
    deviation = result.deviation[result.error > 0]
    assert np.isfinite(deviation).all() and len(deviation) >= 0.7 * len(result.value)
    assert np.abs(deviation).max() < 5
    assert (deviation**2).mean() < 1 + 5 * np.sqrt(2 / len(deviation))
    sure = [c for c in comparisons(result) if np.isfinite(c.deviation)]
    assert sure and all(abs(c.deviation) < 4 for c in sure)


def test_neighbours_say_that_a_run_is_short_and_have_no_error_where_nothing_changes():
    """A run of less than 100 times 9/(2 d (D + D)), in which two beads diffuse over 3 cells."""
    case, rng = solution(RadialDistribution(reach=3), (9, 8), Polymer(2)), np.random.default_rng(3)
    D = theory.bead_diffusion("srd", 2, 10, 0.1, 130, 1.0, 1.0, 1.0, (1 / 72, 1.0))
    for samples in (40, int(110 * 9 / (8 * D))):  # a sample is one time unit
        found = sampled(case.observe[0], case, rng.random((samples, 2, 1, 2)) * 5).result()
        note = found["neighbours"].note
        assert ("lower bound" in note) == (samples == 40), note
    fixed = sampled(case.observe[0], case, np.tile([[[1.0, 1.0]], [[2.0, 2.0]]], (31, 1, 1, 1)))
    found = fixed.result()["neighbours"]
    assert found.measured == pytest.approx(1.0) and np.isnan(found.error)
    assert "(" not in str(found).split("(r <")[0]


@pytest.mark.parametrize("size", SIZES)
def test_pairs_are_counted_once_and_through_the_bounds(size):
    rng, box, edges = np.random.default_rng(1), np.array(size, float), np.linspace(0, 2.5, 6)
    r = rng.random((4, 5, len(size))) * box
    flat = r.reshape(-1, len(size))

    def by_hand(one, other):
        away = one[:, None] - other + box * np.round((other - one[:, None]) / box)
        return np.sqrt((away**2).sum(axis=2))

    all_of_them = by_hand(flat, flat)[np.triu_indices(len(flat), 1)]
    assert (count_pairs(flat, None, box, edges) == np.histogram(all_of_them, edges)[0]).all()
    two = np.histogram(by_hand(r[0], r[1]), edges)[0]
    assert (count_pairs(r[0], r[1] + box, box, edges) == two).all()
    inside = [by_hand(m, m)[np.triu_indices(5, 1)] for m in r]
    assert (count_within(r, box, edges) == np.histogram(np.concatenate(inside), edges)[0]).all()


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("quantity", [RadialDistribution, StructureFactor])
def test_an_ideal_gas_has_no_structure(size, quantity):
    few = {"particles": 150} if quantity is RadialDistribution else {"shells": 12, "waves": 3}
    observable = quantity(**few)
    case = make_case(size, [observable], density=2)
    fluid, accumulator = FakeFluid(case), observable.accumulator(case)
    for _ in range(120):
        fluid.jump()
        accumulator.observe(fluid)
    result = accumulator.result()
    assert (result.expected == 1).all()
    agrees(result)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("of", ["beads", "chains"])
def test_gaussian_chains_obey_debye(size, of):
    observable = StructureFactor(of=of, largest=5.0, shells=15, waves=6)
    case = solution(observable, size, Polymer(20, length=8))
    rng = np.random.default_rng(4)
    every = (gaussian_chains(rng, 20, 8, size) for _ in range(200))
    result = sampled(observable, case, every).result()
    assert result.value[0] > 2 * result.value[-1]
    agrees(result)


def test_chains_and_monomers_have_the_mean_of_both():
    observable = StructureFactor(largest=4.0, shells=10, waves=6)
    case = solution(observable, (9, 8), Polymer(6, length=8), Polymer(30))
    rng = np.random.default_rng(5)
    every = [
        np.concatenate([gaussian_chains(rng, 6, 8, (9, 8)).reshape(-1, 2), rng.random((30, 2)) * 9])
        for _ in range(2)
    ]
    debye = theory.gaussian_structure_factor
    result = sampled(observable, case, every).result()
    alone = StructureFactor(of="chains", largest=4.0, shells=10, waves=6)
    chain = alone.accumulator(case).expected()
    assert result.expected == pytest.approx((48 * chain + 30) / 78)
    longest = [2 * np.pi / 9, 2 * np.pi / 8]  # both in the first shell
    exact = debye(longest, [(i, i + 1) for i in range(7)], 2 / (2 * BOND.K), 2)
    assert chain[0] == pytest.approx(exact.mean())


def test_pairs_of_different_molecules_are_those_of_an_ideal_gas():
    """Also where a sample of the molecules is looked at; with those within, g is what it is."""
    size, rng = (9, 8), np.random.default_rng(6)
    between = RadialDistribution(pairs="between", bins=20, particles=60)
    every = RadialDistribution(bins=20, particles=60)
    all_seen = RadialDistribution(bins=20, particles=10**6)
    case = make_case(size, [], density=5, molecule=Molecule(bond=BOND, length=5))
    number = case.particles // 5
    places = [gaussian_chains(rng, number, 5, size) for _ in range(120)]
    agrees(sampled(between, case, places).result())
    some, all_of_them = (sampled(one, case, places).result() for one in (every, all_seen))
    assert some.expected is None and some.value[1] > 1.2
    error = np.hypot(some.error, all_of_them.error)
    assert np.abs((some.value - all_of_them.value) / error).max() < 5


def test_all_get_their_turn():
    """A sample of a fluid at rest: in the mean it is all of it, as far as chance allows."""
    observable = RadialDistribution(bins=1, reach=2.0, particles=40)
    case = make_case((8, 8), [observable], density=5)
    fluid, accumulator = FakeFluid(case), observable.accumulator(case)
    for _ in range(case.particles):  # each begins once
        accumulator.observe(fluid)
    exact = count_pairs(fluid.positions(), None, fluid.box, np.array([0.0, 2.0]))[0]
    ideal = case.particles * (case.particles - 1) / 2 * 4 * np.pi / 64
    one = count_pairs(fluid.positions(np.arange(40) * 8), None, fluid.box, np.array([0.0, 2.0]))[0]
    away = accumulator.result().value[0] - exact / ideal
    assert abs(away) < 0.25 * (2 / (40 * 39 * 4 * np.pi / 64)) ** 0.5
    assert abs(one / (40 * 39 / 2 * 4 * np.pi / 64) - exact / ideal) > abs(away)


def test_dilute_beads_follow_boltzmann():
    """Two beads: exp(-U/kT), by Metropolis moves of their distance in the box."""
    size, pair, kT = (7, 7), WCA(epsilon=1.0, sigma=2.0), 1.0
    observable = RadialDistribution(bins=14)
    case = solution(observable, size, Polymer(2), pair=pair)
    rng, box, walkers = np.random.default_rng(7), np.array(size, float), 8000
    r = rng.random((walkers, 2, 2)) * box

    def energy(r):
        way = r[:, 1] - r[:, 0]
        square = ((way - box * np.rint(way / box)) ** 2).sum(axis=1)
        six = (4.0 / np.maximum(square, 1e-3)) ** 3
        return np.where(square < 4 * 2 ** (1 / 3), 4 * (six**2 - six) + 1, 0.0)

    weight = rng.random(walkers) < np.exp(-energy(r) / kT)  # drawn by rejection: exact
    kept = r[weight][:4000]
    result = sampled(observable, case, kept).result()
    # in a box the mean of exp(-U/kT) over all places is the constant before it
    fine = np.linspace(0, 3.5, 14 * 200 + 1)
    middle = (fine[1:] + fine[:-1]) / 2
    factor = np.exp(-energy(np.stack([np.zeros((len(middle), 2)), np.c_[middle, 0 * middle]], 1)))
    lost = (1 - factor) @ (2 * np.pi * middle * np.diff(fine))
    weights = middle.reshape(14, -1)
    expected = (factor.reshape(14, -1) * weights).sum(axis=1) / weights.sum(axis=1)
    expected /= 1 - lost / box.prod()
    away = result.value - expected
    seen = expected > 0.01
    assert result.expected is None and (result.value[expected < 1e-6] == 0).all()
    assert np.abs(away[seen] / result.error[seen]).max() < 4.5
    assert expected[seen].min() < 0.7 < 1.1 < expected.max()


def test_kinds_are_told_apart():
    """Monomers of the second kind sit at a distance of 1.25 of each of the first."""
    rng, size = np.random.default_rng(8), (9, 8)
    one = rng.random((15, 2)) * size
    places = np.concatenate([one, one + [1.25, 0.0]])
    polymers = Polymer(15, name="red"), Polymer(15, name="blue")
    for kinds, found in ((("red", "blue"), True), (("red",), False), ((1, 2), True)):
        observable = RadialDistribution(kinds=kinds, bins=30)
        case = solution(observable, size, *polymers)
        value = sampled(observable, case, [places]).result().value
        assert (value[9] > 3) == found


def test_error_bars_hold_where_nothing_has_moved():
    """Runs of four samples of the same places: a single sample scatters by all of S."""
    size, rng = (9, 8), np.random.default_rng(10)
    observable, deviations = StructureFactor(largest=4.0, shells=10), []
    case = solution(observable, size, Polymer(40))
    for _ in range(30):
        r = rng.random((40, 2)) * size
        found = sampled(observable, case, [r] * 4)
        result = found.result()
        deviations.append(result.deviation)
    root_mean_square = np.sqrt(np.mean(np.square(deviations)))
    assert 0.7 < root_mean_square < 1.5


@pytest.mark.parametrize("largest", [2.0, 6.0])
def test_waves_fit_the_box_and_one_of_each_two_is_there(largest):
    size = np.array([6.0, 5.0, 7.0])
    shells = wave_shells(size, largest, 10, 10**6)
    waves = np.concatenate(shells)
    whole = waves * size / (2 * np.pi)
    assert np.allclose(whole, np.rint(whole)) and np.abs(waves).sum(axis=1).min() > 0
    rows = {tuple(row) for row in np.rint(whole).astype(int)}
    assert len(rows) == len(waves) and not any(tuple(-np.array(row)) in rows for row in rows)
    n = np.stack(np.meshgrid(*[np.arange(-8, 9)] * 3), -1).reshape(-1, 3) * 2 * np.pi / size
    inside = ((n**2).sum(axis=1) <= largest**2).sum() - 1
    assert 2 * len(rows) == inside
    for shell in shells:
        assert np.ptp(np.linalg.norm(shell, axis=1)) <= largest / 10 + 1e-9


def test_resistances_of_rings_and_stars():
    """Of a ring of n beads k (n - k)/n; a star's arms as chains through the centre."""
    q = np.array([0.3, 1.0, 2.0])
    ring = theory.gaussian_structure_factor(q, [(i, (i + 1) % 6) for i in range(6)], 1.2, 3)
    k = np.arange(6)
    assert ring == pytest.approx(np.exp(-(q[:, None] ** 2) * 0.2 * k * (6 - k) / 6).sum(axis=1))
    star = theory.gaussian_structure_factor(q, [(0, 1), (0, 2), (0, 3)], 1.2, 3)
    x = np.exp(-(q**2) * 0.2)
    assert star == pytest.approx((4 + 6 * x + 6 * x**2) / 4)
    with pytest.raises(ValueError, match="expected to link all 4 beads"):
        theory.gaussian_structure_factor(q, [(0, 1), (2, 3)], 1.2)


@pytest.mark.parametrize(
    ("observable", "parts", "said"),
    [
        (RadialDistribution(), {"shear_rate": 0.1}, "not under box.shear_rate"),
        (RadialDistribution(), {"walls": (Plates(axis="y"),)}, "not with walls"),
        (StructureFactor(), {"walls": (Plates(axis="y"),)}, "not with walls"),
        (StructureFactor(), {"shear_rate": 0.1}, "not under box.shear_rate"),
        (StructureFactor(of="chains"), {}, "needs molecules"),
        (StructureFactor(largest=0.1), {}, "largest = 0.1: expected 0.7854"),
        (RadialDistribution(reach=5), {}, "reach = 5: expected at most 4, half of the shortest"),
        (RadialDistribution(of="beads"), {}, "needs molecules"),
        (RadialDistribution(kinds=(1, 1)), {}, "expected two different ones"),
        (RadialDistribution(kinds=(1, 2)), {}, r"kinds = \[1, 2\]: only with"),
    ],
)
def test_refused(observable, parts, said):
    with pytest.raises(CaseError, match=said):
        make_case((8, 8), [observable], **parts)


@pytest.mark.parametrize("quantity", [RadialDistribution, StructureFactor])
def test_no_theory_where_there_is_none(quantity):
    """Of beads that feel one another, and of what a force stirs."""
    felt = solution(quantity(), (9, 8), Polymer(9), pair=WCA())
    assert quantity().accumulator(felt).expected() is None
    pushed = make_case((9, 8), [quantity()], force=Uniform((0.01, 0.0)))
    assert quantity().accumulator(pushed).expected() is None


@pytest.mark.parametrize("observable", [RadialDistribution(), StructureFactor(of="chains")])
def test_runs_are_pooled(observable):
    size, rng = (9, 8), np.random.default_rng(9)
    case = solution(observable, size, Polymer(9, length=4))
    places = [gaussian_chains(rng, 9, 4, size) for _ in range(8)]
    one, other, whole = (
        sampled(observable, case, some) for some in (places[:4], places[4:], places)
    )
    one.pool(other)
    assert one.result().samples == 8
    assert one.result().value == pytest.approx(whole.result().value)
    assert (one.result().error > 0).any()
