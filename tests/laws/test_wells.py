"""Laws of walkers in wells: occupations, relaxation, Arrhenius' rates, diffusion along a ring."""

import math

import numpy as np
import pytest
from scipy import stats

from mesokit import Simulation
from mesokit.method.kinetic_monte_carlo.engine.events import NEXT, events
from mesokit.method.kinetic_monte_carlo.model.balance import detailed_balance
from mesokit.method.kinetic_monte_carlo.model.wells import Link, Ring, Well, Wells
from mesokit.method.kinetic_monte_carlo.observe.coverage import Coverage
from mesokit.method.kinetic_monte_carlo.observe.event_rates import EventRates
from mesokit.method.kinetic_monte_carlo.observe.lattice_energy import LatticeEnergy
from mesokit.method.kinetic_monte_carlo.start import RandomStart, UniformStart
from tests.helpers.lattices import lattice_case, lattice_engine

UNLIKELY = 1e-4
CYCLE = np.array([[0, 1.0, 0], [0.2, 0, 0.5], [2.0, 0, 0]])  # one way round, but for one hop back
ENERGIES = np.array([0.0, -1.0, 0.5])


def two_wells(barrier=1.0, kT=1.0):
    """The second one is lower by ln 3: it has three quarters of the walkers at kT = 1."""
    wells = Well(name="0"), Well(name="1", energy=-math.log(3))
    return Wells(well=wells, link=[Link(hop="0 <-> 1", barrier=barrier)], kT=kT)


def cycle():
    hops = [(i, j) for i in range(3) for j in range(3) if CYCLE[i, j]]
    links = [Link(hop=f"w{i} -> w{j}", rate=CYCLE[i, j]) for i, j in hops]
    return Wells(well=[Well(name=f"w{k}") for k in range(3)], link=links)


def barriers():
    names = ("left", "middle", "right")
    wells = [Well(name=n, energy=e) for n, e in zip(names, ENERGIES, strict=True)]
    links = [Link(hop="left <-> middle", barrier=1.0, attempt_rate=2.0),
             Link(hop="middle <-> right", barrier=0.7)]  # fmt: skip
    return Wells(well=wells, link=links, kT=0.8)


def results_of(model, observe, **given):
    case = lattice_case((100, 100), model, observe=observe, **given)
    simulation = Simulation(case)
    simulation.run()
    return simulation.results


def deviations(result):
    """In standard errors, by name."""
    return {one.what: one.deviation for one in result.comparisons}


def test_two_wells_fill_and_relax_as_their_rates_have_it():
    engine = lattice_engine((500, 500), two_wells(), timestep=0.25, start=UniformStart())
    out, back = math.exp(-1.0), math.exp(-1.0) / 3
    found = []
    for _ in range(12):
        engine.advance(1)
        found.append(engine.sites().mean())
    engine.advance(100)
    part = engine.sites().mean()
    assert part == pytest.approx(out / (out + back), rel=0.01)
    times, gap = 0.25 * np.arange(1, 13), 0.75 - np.array(found)
    decay = -np.polyfit(times, np.log(gap / 0.75), 1, w=gap)[0]
    assert decay == pytest.approx(out + back, rel=0.01)


def test_walkers_stay_for_exponential_times():
    engine = lattice_engine((8, 8), two_wells(), start=UniformStart())
    before, since, stays = engine.sites().copy(), np.zeros(64), []
    for _ in range(12_000):
        now = engine.course.clock[NEXT]
        events(*engine._arguments(), np.inf, 1)  # the next event alone, or an attempt in vain
        after = engine.sites()
        left = (before == 0) & (after == 1)
        stays += (now - since[left]).tolist()
        since[before != after] = now
        before = after.copy()
    assert len(stays) > 2900
    assert stats.kstest(np.array(stays) * math.exp(-1.0), "expon").pvalue > UNLIKELY


def test_rates_have_the_slope_of_the_barrier():
    counts, temperatures = [], np.array([0.5, 1.0])
    for seed, kT in enumerate(temperatures):
        model = Wells(ring=Ring(wells=5, barrier=3.0), kT=kT)
        engine = lattice_engine((128, 128), model, timestep=math.exp(3.0 / kT) * 20, seed=seed)
        engine.advance(1)
        counts.append(engine.happened().sum() / (engine.n * 20 * math.exp(3.0 / kT)))
    slope = -np.diff(np.log(counts))[0] / np.diff(1 / temperatures)[0]
    assert slope == pytest.approx(3.0, rel=0.005)


@pytest.mark.parametrize("tilt", [0.0, 1.0])
def test_walkers_diffuse_along_a_ring(tilt):
    """Along it they drift at k_+ - k_-, and their variance grows by k_+ + k_- in a unit of time."""
    wells, barrier = 64, 1.5
    model = Wells(ring=Ring(wells=wells, barrier=barrier, tilt=tilt))
    rates = np.exp(-barrier + np.array([0.5, -0.5]) * tilt)
    engine = lattice_engine((300, 300), model, timestep=2.0, start=UniformStart())
    x = np.zeros(engine.n)
    for _ in range(10):
        before = engine.sites().astype(int)
        engine.advance(1)
        x += (engine.sites() - before + wells // 2) % wells - wells // 2
    spread = math.sqrt(2 / engine.n)
    assert abs(x.mean() - 20 * (rates[0] - rates[1])) < 4 * math.sqrt(20 * rates.sum() / engine.n)
    assert x.var() / 20 == pytest.approx(rates.sum(), rel=4 * spread)
    assert 4 * spread < 0.02


def test_rates_one_way_are_in_the_steady_state_of_the_master_equation():
    observe = [Coverage(every=1), EventRates(every=1)]
    found = results_of(cycle(), observe, steps=400, warmup=20, timestep=1.0, start=RandomStart())
    flow = CYCLE - np.diag(CYCLE.sum(axis=1))
    steady = np.linalg.lstsq(np.vstack([flow.T, np.ones(3)]), [0, 0, 0, 1.0], rcond=None)[0]
    parts = found["coverage"].comparisons
    assert [one.expected for one in parts] == pytest.approx(steady.tolist())
    assert [one.measured for one in parts] == pytest.approx(steady.tolist(), rel=0.01)
    assert [one.expected for one in found["event-rates"].comparisons] == pytest.approx(
        [steady[0] * 1.0, steady[1] * 0.2, steady[1] * 0.5, steady[2] * 2.0]
    )
    every = deviations(found["coverage"]) | deviations(found["event-rates"])
    assert len(every) == 7 and max(map(abs, every.values())) < 4


def test_barriers_lead_to_the_occupations_of_boltzmann():
    observe = [Coverage(every=1), EventRates(every=1), LatticeEnergy(every=1)]
    model = barriers()
    found = results_of(model, observe, steps=400, warmup=40, timestep=2.0, start=RandomStart())
    weight = np.exp(-ENERGIES / 0.8)
    known = [one.expected for one in found["coverage"].comparisons]
    assert known == pytest.approx((weight / weight.sum()).tolist())
    there, back, on, off = (one.expected for one in found["event-rates"].comparisons)
    assert (there, on) == pytest.approx((back, off))
    every = [deviations(one) for one in found.values()]
    assert [len(one) for one in every] == [3, 4, 2]
    assert max(abs(one) for some in every for one in some.values()) < 4
    assert detailed_balance(lattice_case((4, 4), model)) == ""


def test_occupations_relax_as_the_master_equation_has_it():
    observe = [Coverage(every=1), EventRates(every=1)]
    found = results_of(barriers(), observe, steps=30, timestep=0.5, start=UniformStart())
    coverage = found["coverage"]
    assert coverage.value[0].tolist() == coverage.expected[0].tolist() == [1, 0, 0]
    share = coverage.expected[1:]
    error = np.sqrt(share * (1 - share) / 10_000)
    assert abs((coverage.value[1:] - share) / error).max() < 4.5
    compared = [one for result in found.values() for one in result.comparisons]
    assert len(compared) == 7 and all(one.note.startswith("not steady") for one in compared)
