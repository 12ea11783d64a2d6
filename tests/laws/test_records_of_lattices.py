"""Laws of particles that are followed on lattices, and of the times that sites stay in a state."""

import numpy as np
import pytest
from scipy import stats

from mesokit import Simulation
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model.exclusion import Exclusion
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.observe.tracer_displacement import TracerDisplacement
from mesokit.method.kinetic_monte_carlo.observe.waiting_times import WaitingTimes
from mesokit.method.kinetic_monte_carlo.start import RandomStart, UniformStart
from tests.helpers.lattices import lattice_case, near, results_of

UNLIKELY = 1e-4
HOP = GasProcess(name="hop", site="A -> empty", neighbour="empty -> A", rate=0.5)
HOPS = LatticeGas(process=[HOP])
GAS = LatticeGas(
    process=[
        GasProcess(name="adsorb", site="empty -> A", rate=0.7),
        GasProcess(name="desorb", site="A -> empty", rate=0.3),
    ]
)
SIZES = {1: (160_000,), 2: (400, 400), 3: (54, 54, 54)}
MEET = 0.003  # how much 256 walkers on these hinder one another: twice their part of the sites
TRACERS, WAITS = "tracer-displacement", "waiting-times"


def exactly(number, sites):
    return RandomStart(fractions=[1 - number / sites, number / sites], exact=True)


@pytest.mark.parametrize("name", KINDS)
def test_walkers_diffuse_by_the_rate_of_their_hops_on_every_lattice(name):
    """256 walkers that hardly meet: D = K a^2/(2 d), with K the rate of all hops of one."""
    kind = KINDS[name]
    size = SIZES[kind.dimension]
    observe = [TracerDisplacement(every=1, max_lag=4)]
    start = exactly(256, int(np.prod(size)))
    result = results_of(
        lattice_case(size, HOPS, name, steps=600, timestep=2.0, start=start, observe=observe)
    )[TRACERS]
    d, rate = kind.dimension, 0.5 * kind.neighbours
    square = result.value[1:] / (rate * result.x["time"][1:])
    error = result.error[1:] / (rate * result.x["time"][1:])
    assert (abs(square - 1) < 4 * error + MEET).all() and error[0] < 0.007
    diffusion, *drift = result.comparisons
    assert diffusion.expected == pytest.approx(rate / (2 * d))
    off = abs(diffusion.measured / diffusion.expected - 1)
    assert off < 4 * diffusion.error / diffusion.expected + MEET
    assert near(drift) == {f"drift along {axis}" for axis in "xyz"[:d]}


def test_a_lone_walker_has_the_exact_coefficient():
    observe = [TracerDisplacement(every=1, max_lag=8)]
    case = lattice_case((12, 12), HOPS, steps=5000, start=exactly(1, 144), observe=observe)
    result = results_of(case)[TRACERS]
    assert near(result.comparisons) == {"diffusion coefficient", "drift along x", "drift along y"}
    assert (abs(result.deviation[1:]) < 4).all()


@pytest.mark.parametrize("backward", [0.0, 0.25])
def test_tagged_particles_of_a_ring_drift_as_its_current_has_it(backward):
    observe = [TracerDisplacement(every=10, max_lag=20)]
    model = Exclusion(backward=backward)
    case = lattice_case((40,), model, "chain", steps=60_000, start=exactly(10, 40), observe=observe)
    diffusion, drift = results_of(case)[TRACERS].comparisons
    assert np.isnan(diffusion.measured)  # a square displacement of drift is none of diffusion
    assert near([drift]) == {"drift along x"}
    assert drift.expected == pytest.approx((1 - backward) * 30 / 39)
    assert drift.measured == pytest.approx(drift.expected, rel=0.01)


def test_those_that_have_left_do_not_count():
    """Walkers that vanish at a rate diffuse as they did before, while they are there."""
    gone, timestep, steps = 0.02, 2.0, 60
    model = LatticeGas(process=[HOP, GasProcess(name="gone", site="A -> empty", rate=gone)])
    start, observe = exactly(1000, 160_000), [TracerDisplacement(every=1, max_lag=16)]
    case = lattice_case(
        (400, 400), model, steps=steps, timestep=timestep, start=start, observe=observe
    )
    result = results_of(case)[TRACERS]
    assert result.x["time"][-1] == 16 * timestep
    square = result.value[1:] / (2.0 * result.x["time"][1:])
    error = result.error[1:] / (2.0 * result.x["time"][1:])
    assert (abs(square - 1) < 4 * error + 0.01).all() and error.max() < 0.05
    left = float(result.comparisons[0].note.split("; ")[1].split(" %")[0])
    share = 1 - np.exp(-gone * timestep * steps)
    assert abs(left / 100 - share) < 4 * np.sqrt(share * (1 - share) / 1000) + 0.005


def test_particles_that_exchange_places_are_followed_to_where_they_are():
    """Spins that are conserved: those up are where the tracers are."""
    case = lattice_case(
        (20, 18),
        Ising(moves="exchange", kT=1.5),
        kind="triangular",
        observe=[TracerDisplacement()],
        timestep=3.0,
    )
    engine = Simulation(case).engine
    kind, size = KINDS["triangular"], np.array([20, 18])
    engine.advance(2)
    engine.end_warmup()
    places, box = kind.places((20, 18)), size * np.array(kind.spacing)
    engine.advance(5)
    moved, kept = engine.tracers()
    assert kept.all() and (abs(moved) > 1).any()
    there = places + moved
    apart = there[:, None] - places
    apart -= box * np.rint(apart / box)
    site = np.linalg.norm(apart, axis=-1).argmin(axis=1)
    assert sorted(site) == list(range(360))
    np.testing.assert_array_equal(engine.sites()[site], engine.began())


@pytest.mark.long
@pytest.mark.parametrize("part", [0.25, 0.5])
def test_a_single_file_spreads_as_the_root_of_time(part):
    observe = [TracerDisplacement(every=4, max_lag=800)]
    model, start = Exclusion(backward=1.0), exactly(int(4000 * part), 4000)
    case = lattice_case((4000,), model, "chain", steps=16_000, start=start, observe=observe)
    result = results_of(case)[TRACERS]
    time, use = result.x["time"], result.x["time"] >= 100
    slope = np.polyfit(np.log(time[use]), np.log(result.value[use]), 1)[0]
    assert slope == pytest.approx(0.5, abs=0.05)
    last = next(c for c in result.comparisons if "longest" in c.what)
    assert last.measured == pytest.approx(last.expected, rel=0.1)
    assert near(result.comparisons) == {"drift along x"}


@pytest.mark.parametrize(("state", "rate"), [("A", 0.3), ("empty", 0.7)])
def test_sites_stay_in_a_state_for_times_that_are_exponential(state, rate):
    case = lattice_case((32, 32), GAS, steps=1000, observe=[WaitingTimes(every=2, state=state)])
    result = results_of(case)[WAITS]
    mean, spread, stays = result.comparisons
    assert near(result.comparisons) == {"mean stay", "mean square over the square of the mean"}
    assert mean.expected == pytest.approx(1 / rate)
    assert mean.measured == pytest.approx(mean.expected, rel=0.01)
    assert spread.measured == pytest.approx(2.0, rel=0.02)
    assert stays.measured == pytest.approx(1024 * 1000 * 0.21, rel=0.02)
    assert as_likely_as_expected(result) > UNLIKELY


def as_likely_as_expected(result):
    """Chance of the numbers of stays in bins, of which at least eight have some."""
    stays = result.comparisons[-1].measured * np.diff(result.extra["edges"])
    expected = result.expected * stays
    use = expected > 10
    assert use.sum() > 8
    square = (np.nan_to_num(result.value * stays) - expected)[use] ** 2 / expected[use]
    return stats.chi2.sf(square.sum(), use.sum())


def test_stays_of_a_short_run_are_not_biased_by_those_that_have_not_ended():
    """Three mean stays, of sites that are all in the state at first."""
    observe = [WaitingTimes(every=1)]
    case = lattice_case((64, 64), GAS, steps=10, start=UniformStart(state="A"), observe=observe)
    result = results_of(case)[WAITS]
    assert near(result.comparisons) == {"mean stay", "mean square over the square of the mean"}
    mean, spread, _ = result.comparisons
    assert mean.measured == pytest.approx(1 / 0.3, rel=0.04)
    assert spread.expected < 1.9
    assert as_likely_as_expected(result) > UNLIKELY


def test_stays_count_from_the_end_of_the_warmup():
    """A site that is never left stays no time that ends; the first stays of the others are told."""
    case = lattice_case((16, 16), Ising(kT=3.0), warmup=5, steps=20, observe=[WaitingTimes()])
    simulation = Simulation(case)
    simulation.run()
    engine = simulation.engine
    counts, sums = engine.waits()
    assert counts.sum() == engine.happened().sum()  # each flip ends a stay
    spent = sums[:, 0] + engine.waiting()
    assert spent.sum() == pytest.approx(256 * 20)
    mean, *_ = simulation[WAITS].comparisons
    assert np.isnan(mean.expected) and "began before measuring" in mean.note


def test_runs_are_pooled_where_one_has_no_particle():
    none, one, other = (tracers_of(number, seed) for number, seed in ((0, 1), (1, 2), (1, 3)))
    alone = [made.result().value for made in (none, one, other)]
    assert [len(value) for value in alone] == [0, 5, 5]
    none.pool(one)
    np.testing.assert_allclose(none.result().value, alone[1])
    none.pool(other)
    np.testing.assert_allclose(none.result().value, (alone[1] + alone[2]) / 2)
    assert none.result().samples == 600


def tracers_of(number, seed):
    """What is measured of so many walkers."""
    observe, start = [TracerDisplacement(every=1, max_lag=4)], exactly(number, 144)
    case = lattice_case((12, 12), HOPS, steps=200, seed=seed, start=start, observe=observe)
    simulation = Simulation(case)
    simulation.run()
    return simulation.accumulators[TRACERS]
