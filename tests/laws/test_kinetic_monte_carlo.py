"""Laws of events on lattices: their times, equilibrium, currents, and surfaces that grow."""

import numpy as np
import pytest
from scipy import stats

from mesokit import Simulation, theory
from mesokit.method.kinetic_monte_carlo.engine.events import NEXT, events
from mesokit.method.kinetic_monte_carlo.model.exclusion import Exclusion
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.model.potts import Potts
from mesokit.method.kinetic_monte_carlo.model.random_deposition import RandomDeposition
from mesokit.method.kinetic_monte_carlo.model.rsos import RestrictedSolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.single_step import SingleStep
from mesokit.method.kinetic_monte_carlo.model.solid_on_solid import SolidOnSolid
from mesokit.method.kinetic_monte_carlo.observe.coverage import Coverage
from mesokit.method.kinetic_monte_carlo.observe.event_rates import EventRates
from mesokit.method.kinetic_monte_carlo.observe.lattice_energy import LatticeEnergy
from mesokit.method.kinetic_monte_carlo.observe.magnetisation import Magnetisation
from mesokit.method.kinetic_monte_carlo.observe.order_parameter import OrderParameter
from mesokit.method.kinetic_monte_carlo.observe.roughness import Roughness
from mesokit.method.kinetic_monte_carlo.observe.site_profile import SiteProfile
from mesokit.method.kinetic_monte_carlo.start import AlternatingStart, RandomStart, UniformStart
from tests.helpers.lattices import lattice_case, lattice_engine, near, results_of

UNLIKELY = 1e-4
CRITICAL = 2 / np.log(1 + 2**0.5)
KEEP, GAIN = 0.3, 0.7


def two_states():
    return LatticeGas(
        species=["empty", "A"],
        process=[
            GasProcess(name="adsorb", site="empty -> A", rate=GAIN),
            GasProcess(name="desorb", site="A -> empty", rate=KEEP),
        ],
    )


def test_waiting_times_are_exponential_with_the_rate_of_all_events():
    engine = lattice_engine((8, 8), RandomDeposition(flux=0.25))
    times = [engine.course.clock[NEXT]]
    for _ in range(5000):
        events(*engine._arguments(), np.inf, 1)  # the next event alone
        times.append(engine.course.clock[NEXT])
    assert engine.sites().sum() == 5000
    assert stats.kstest(np.diff(times) * 0.25 * 64, "expon").pvalue > UNLIKELY


def test_sites_are_chosen_alike():
    engine = lattice_engine((37, 21), RandomDeposition())  # tiles that stick out of the lattice
    engine.advance(100)
    heights = engine.sites()
    assert stats.chisquare(heights).pvalue > UNLIKELY
    assert abs(heights.mean() - 100) < 4 * np.sqrt(100 / heights.size)


def test_sites_of_two_states_relax_at_the_sum_of_the_rates():
    engine = lattice_engine((300, 300), two_states(), timestep=0.5, start=UniformStart())
    n, part = engine.n, GAIN / (GAIN + KEEP)
    found = []
    for _ in range(8):
        engine.advance(1)
        found.append(engine.sites().mean())
    expected = part * (1 - np.exp(-(GAIN + KEEP) * 0.5 * np.arange(1, 9)))
    error = np.sqrt(expected * (1 - expected) / n)
    assert (abs(found - expected) < 4 * error).all()


def test_barriers_give_arrhenius():
    rates = []
    for kT in (0.5, 1.0):
        gas = LatticeGas(
            process=[
                GasProcess(name="on", site="empty -> A", rate=1.0, barrier=2.0),
                GasProcess(name="off", site="A -> empty", rate=1.0, barrier=2.0),
            ],
            kT=kT,
        )
        engine = lattice_engine((128, 128), gas, timestep=50.0)
        engine.advance(1)
        rates.append(engine.happened().sum() / (50.0 * engine.n))
    assert np.log(rates[1] / rates[0]) == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize("dynamics", ["metropolis", "glauber"])
def test_few_spins_are_in_equilibrium(dynamics):
    model = Ising(kT=CRITICAL, dynamics=dynamics)
    observe = [LatticeEnergy(every=1), Magnetisation(every=1)]
    case = lattice_case((4, 4), model, steps=30_000, warmup=100, timestep=4.0, observe=observe)
    found = results_of(case)
    energy, spins = (found[name].comparisons for name in ("lattice-energy", "magnetisation"))
    assert near(energy) == {"mean energy", "heat capacity"}
    assert near(spins) >= {"mean size", "mean square", "Binder cumulant", "susceptibility"}
    assert energy[0].expected == pytest.approx(-1.56562, abs=1e-5)
    assert energy[0].measured == pytest.approx(energy[0].expected, rel=0.01)


def test_spins_in_a_field_are_in_equilibrium():
    model, observe = Ising(kT=2.0, field=0.3), [LatticeEnergy(every=1), Magnetisation(every=1)]
    found = results_of(
        lattice_case((3, 4), model, steps=60_000, warmup=100, ends=["x"], observe=observe)
    )
    assert "mean energy" in near(found["lattice-energy"].comparisons)
    assert "mean spin" in near(found["magnetisation"].comparisons)


def test_many_spins_have_the_energy_of_onsager():
    observe = [LatticeEnergy(every=2)]
    case = lattice_case((128, 128), Ising(kT=3.0), steps=600, warmup=60, observe=observe)
    (energy, *_) = results_of(case)["lattice-energy"].comparisons
    assert near([energy]) == {"mean energy"}
    assert energy.expected == pytest.approx(-0.81731, abs=1e-5)
    assert energy.measured == pytest.approx(energy.expected, rel=0.005)


def test_three_states_of_few_sites_are_in_equilibrium():
    """Against a sum over all states of 3 x 3 sites with periodic bonds."""
    kT, sites = 0.9, np.arange(9).reshape(3, 3)
    states = (np.arange(3**9)[:, None] // 3 ** np.arange(9)) % 3
    alike = sum(
        (states == states[:, np.roll(sites, 1, axis).ravel()]).sum(axis=1) for axis in (0, 1)
    )
    weight = np.exp(alike / kT)
    expected = -(weight @ alike) / weight.sum() / 9
    parts = np.stack([(states == q).mean(axis=1) for q in range(3)])
    order, square = (3 * parts.max(axis=0) - 1) / 2, (3 * (parts**2).sum(axis=0) - 1) / 2
    mean, second, fourth = (weight @ x / weight.sum() for x in (order, square, square**2))
    observe = [LatticeEnergy(every=1), OrderParameter(every=1)]
    case = lattice_case((3, 3), Potts(q=3, kT=kT), steps=30_000, timestep=4.0, observe=observe)
    found = results_of(case)
    energy, *orders = (
        found["lattice-energy"].comparisons[0],
        *found["order-parameter"].comparisons,
    )
    wanted = [expected, mean, second, 1 - fourth / (2 * second**2)]
    off = [(one.measured - x) / one.error for one, x in zip((energy, *orders), wanted, strict=True)]
    assert np.abs(off).max() < 4
    measured = [one.measured for one in (energy, *orders)]
    assert measured == pytest.approx(wanted, rel=0.015)


def test_two_states_are_spins_with_half_the_coupling():
    observe = [LatticeEnergy(every=2)]
    case = lattice_case((64, 64), Potts(q=2, kT=1.5), steps=600, warmup=60, observe=observe)
    energy = results_of(case)["lattice-energy"].comparisons[0]
    assert near([energy]) == {"mean energy"}
    assert energy.expected == pytest.approx(theory.onsager_energy(0.5, 1.5) - 1.0)


def test_a_long_chain_is_full_as_its_ends_have_it():
    """Where particles enter slowly the chain has their density (low-density phase)."""
    model, observe = Exclusion(enter=0.2, leave=1.0), [SiteProfile(every=5)]
    case = lattice_case(
        (200,), model, "chain", steps=20_000, warmup=2000, ends=["x"], observe=observe
    )
    profile = results_of(case)["site-profile"]
    part, error = profile.value[20:120, 1].mean(), profile.error[20:120, 1].mean()
    assert part == pytest.approx(0.2, abs=0.01) and error < 0.02


def test_a_chain_that_is_quenched_loses_walls_as_glauber_has_it():
    model = Ising(kT=0.0, dynamics="glauber")
    engine = lattice_engine((1_000_000,), model, kind="chain", timestep=0.5)
    found = {}
    for step in range(1, 11):
        engine.advance(1)
        spins = engine.sites()
        found[0.5 * step] = (spins != np.roll(spins, 1)).mean()
    times = np.array([0.5, 1.0, 2.0, 5.0])
    expected = theory.glauber_walls(times)
    assert [found[t] for t in times] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("particles", [0.25, 0.5])
def test_a_ring_carries_the_exact_current(particles):
    start = RandomStart(fractions=[1 - particles, particles], exact=True)
    observe = [EventRates(every=20)]
    case = lattice_case(
        (40,), Exclusion(), kind="chain", steps=40_000, start=start, observe=observe
    )
    (hops,) = results_of(case)["event-rates"].comparisons
    expected = theory.ring_current(round(40 * particles), 40)
    assert abs(hops.measured - expected) < 4 * hops.error
    assert hops.measured == pytest.approx(expected, rel=0.01)


def test_an_open_chain_carries_the_exact_current():
    model, observe = Exclusion(enter=1.0, leave=1.0), [EventRates(every=20)]
    case = lattice_case(
        (20,), model, "chain", steps=40_000, warmup=200, ends=["x"], observe=observe
    )
    comparisons = results_of(case)["event-rates"].comparisons
    assert near(comparisons) == {"rate of enter", "rate of forward", "rate of leave"}
    assert comparisons[1].expected * 20 / 19 == pytest.approx(22 / 82)


def test_a_lattice_gas_has_the_coverage_and_the_rates_of_langmuir():
    gas = LatticeGas(
        process=[
            GasProcess(name="adsorb", site="empty -> A", rate=1.0),
            GasProcess(name="desorb", site="A -> empty", rate=0.5),
            GasProcess(name="hop", site="A -> empty", neighbour="empty -> A", rate=1.0),
        ]
    )
    observe = [Coverage(every=1), EventRates(every=1)]
    found = results_of(lattice_case((128, 128), gas, steps=60, warmup=10, observe=observe))
    assert near(found["coverage"].comparisons) == {"mean part empty", "mean part A"}
    rates = found["event-rates"].comparisons
    assert near(rates) == {"rate of adsorb", "rate of desorb", "rate of hop"}
    hops = next(one for one in rates if one.what == "rate of hop")
    assert hops.measured == pytest.approx(4 * (2 / 3) * (1 / 3), rel=0.01)


def test_columns_that_grow_alone_have_the_width_of_chance():
    engine = lattice_engine((200, 200), RandomDeposition(flux=2.0))
    for time in (1, 2, 3):
        engine.advance(1)
        square = engine.sites().var()
        expected = 2.0 * time * (1 - 1 / engine.n)
        assert abs(square - expected) < 4 * expected * np.sqrt(2 / engine.n) + 4 / engine.n


def test_a_rough_start_has_no_exponent_and_grows_on_from_there():
    case = lattice_case(
        (1600,), RandomDeposition(), "chain", steps=100, observe=[Roughness(every=2)]
    )
    rough = np.random.default_rng(1).integers(-20, 21, 1600)
    simulation = Simulation(case, states=rough)
    simulation.run()
    known = {one.what: one for one in simulation["roughness"].comparisons}
    assert np.isnan(known["growth exponent"].expected)
    last = known["last mean square width"]
    assert last.expected == pytest.approx(rough.var() + 100, rel=0.01)
    assert abs(last.measured - last.expected) < 5 * last.error


def test_an_empty_chain_that_nothing_crosses_has_no_current():
    model, observe = Exclusion(forward=0.0, enter=1.0, leave=1.0), [EventRates(every=5)]
    case = lattice_case((6,), model, "chain", steps=50, ends=["x"], observe=observe)
    found = results_of(case)["event-rates"].comparisons
    assert [one.what for one in found] == ["rate of enter", "rate of leave"]
    assert np.isnan([one.expected for one in found]).all()


def test_a_ring_of_single_steps_has_the_exact_width():
    engine = lattice_engine(
        (16,), SingleStep(up=1.0, down=0.2), kind="chain", start=AlternatingStart(), timestep=2.0
    )
    engine.advance(1000)
    squares = []
    for _ in range(20_000):
        engine.advance(1)
        squares.append(engine.sites().var())
    heights = engine.sites()
    assert (abs(heights - np.roll(heights, 1)) == 1).all()
    blocks = np.reshape(squares, (50, -1)).mean(axis=1)
    assert abs(blocks.mean() - 17 / 12) < 4 * blocks.std() / np.sqrt(50)


def test_restricted_growth_has_the_known_speed():
    engine = lattice_engine((20_000,), RestrictedSolidOnSolid(), kind="chain", timestep=50.0)
    engine.advance(2)
    before = engine.sites().mean()
    engine.advance(2)
    heights = engine.sites()
    assert abs(heights - np.roll(heights, 1)).max() == 1
    assert (heights.mean() - before) / 100 == pytest.approx(0.42, rel=0.02)


def test_a_surface_in_equilibrium_has_steps_as_boltzmann_has_them():
    """Steps dh between columns cost (bond/2) |dh|, and those of a ring add up to 0."""
    length, q, most = 10, np.exp(-0.75), 40
    weight = q ** abs(np.arange(-most, most + 1.0))
    others = weight
    for _ in range(length - 2):
        others = np.convolve(others, weight)
    middle = len(others) // 2
    expected = weight * others[middle - most : middle + most + 1]  # even: the rest has -dh
    expected /= expected.sum()
    model = SolidOnSolid(bond_energy=1.5, kT=1.0)
    engine = lattice_engine((length,), model, kind="chain", timestep=20.0)
    engine.advance(1000)
    found = np.zeros((50, 4))
    for block in range(50):
        for _ in range(200):
            engine.advance(1)
            heights = engine.sites()
            found[block] += np.bincount(abs(heights - np.roll(heights, 1)), minlength=99)[:4]
    assert heights.sum() == 0  # atoms only hop
    found /= 200 * length
    wanted = [expected[most], *(2 * expected[most + k] for k in (1, 2, 3))]
    error = found.std(axis=0) / np.sqrt(50)
    assert (abs(found.mean(axis=0) - wanted) < 4 * error).all()
    assert found.mean(axis=0) == pytest.approx(wanted, rel=0.03)
