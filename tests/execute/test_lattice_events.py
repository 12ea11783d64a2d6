"""Events on lattices: neighbours, what is kept of each site, and bits that do not depend on how a
run is cut."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesokit import Simulation
from mesokit.method.kinetic_monte_carlo.engine import engine as engine_module
from mesokit.method.kinetic_monte_carlo.lattice.grid import by_number, grid_of, neighbour
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model.exclusion import Exclusion
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.model.solid_on_solid import SolidOnSolid
from mesokit.method.kinetic_monte_carlo.observe.tracer_displacement import TracerDisplacement
from mesokit.method.kinetic_monte_carlo.observe.waiting_times import WaitingTimes
from mesokit.run.schedule import Schedule
from mesokit.seam.engine import Interrupted
from tests.helpers.lattices import lattice_case, lattice_engine

GAS = LatticeGas(
    species=["empty", "A", "B"],
    process=[
        GasProcess(name="on", site="empty -> A", rate=1.0),
        GasProcess(name="pair", site="empty -> B", neighbour="empty -> B", rate=0.3),
        GasProcess(name="hop", site="A -> empty", neighbour="empty -> A", rate=2.0),
        GasProcess(name="react", site="A -> empty", neighbour="B -> empty", rate=1.0),
        GasProcess(name="off", site="A -> empty", rate=0.1, bond=0.4, bonded=["A", "B"]),
    ],
)
MODELS = {
    "ising": Ising(kT=1.7, field=0.1),
    "gas": GAS,
    "family": Family(),
    "solid on solid": SolidOnSolid(flux=0.5, step_barrier=0.5),
}


@pytest.mark.parametrize("kind", KINDS)
def test_neighbours_are_at_distance_one_and_have_the_way_back(kind):
    lattice = KINDS[kind]
    size = (20, 18, 6)[: lattice.dimension]  # tiles stick out of it
    grid, places = (
        grid_of(lattice, size, (False,) * lattice.dimension),
        lattice.places(size),
    )
    memory = by_number(grid)
    number = {int(i): n for n, i in enumerate(memory)}
    found = np.array(
        [[number[neighbour(grid, int(i), k)] for k in range(lattice.neighbours)] for i in memory]
    )
    box = np.array(size) * np.array(lattice.spacing)
    way = places[found] - places[:, None]
    way -= box * np.rint(way / box)
    assert np.linalg.norm(way, axis=2) == pytest.approx(np.ones(found.shape))
    back = found[found, lattice.back[None, :]]
    assert (back == np.arange(len(memory))[:, None]).all()
    assert (np.sort(found, axis=1)[:, 1:] != np.sort(found, axis=1)[:, :-1]).all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_lattice_ends_where_it_is_closed(kind):
    lattice = KINDS[kind]
    size = (6, 6, 4)[: lattice.dimension]
    grid = grid_of(lattice, size, (True,) * lattice.dimension)
    places, memory = lattice.places(size), by_number(grid)
    number = {int(i): n for n, i in enumerate(memory)}
    bonds = [
        (n, number[j])
        for n, i in enumerate(memory)
        for k in range(lattice.neighbours)
        if (j := neighbour(grid, int(i), k)) >= 0
    ]
    one, other = np.array(bonds).T
    apart = np.linalg.norm(places[one] - places[other], axis=1)
    assert apart == pytest.approx(np.ones(len(bonds)))
    near = (np.linalg.norm(places[:, None] - places[None], axis=2) < 1.0001).sum() - len(places)
    assert len(bonds) == near  # all those that are one apart, without images


def kept(engine):
    """What an engine keeps of its sites beside their states."""
    return {
        "around": engine.lattice.around[engine.places],
        **{name: getattr(engine.choice, name) for name in ("of", "numbers", "counts", "lengths")},
        "ranks": ranks(engine.choice),
    }


def ranks(choice):
    """Where each tile is in the list of each class that it has any of."""
    return np.where(choice.counts > 0, choice.ranks, -1)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("kind", ["square", "triangular", "cubic"])
def test_what_is_kept_of_sites_is_as_if_it_were_made_anew(name, kind):
    size = (21, 20, 6)[: KINDS[kind].dimension]
    engine = lattice_engine(
        size, MODELS[name], kind=kind, ends=["x"], timestep=0.5, select="classes"
    )
    engine.advance(20)
    assert engine.happened().sum() > 500
    found = {name: array.copy() for name, array in kept(engine).items()}
    engine.restore(engine.state())
    for array, anew in zip(found.values(), kept(engine).values(), strict=True):
        np.testing.assert_array_equal(array, anew)
    choice = engine.choice
    able = choice.of[engine.places] < len(choice.rates) - 1
    assert (
        able.sum()
        == choice.numbers[:-1].sum()
        == choice.counts.reshape(-1, len(choice.rates))[:, :-1].sum()
    )


@given(cuts=st.lists(st.integers(1, 40), min_size=1, max_size=6), seed=st.integers(0, 2**63))
@settings(max_examples=10)
def test_slices_of_time_change_no_bit(cuts, seed):
    total = sum(cuts)
    whole = lattice_engine((24, 20), GAS, timestep=0.03, seed=seed)
    whole.advance(total)
    cut = lattice_engine((24, 20), GAS, timestep=0.03, seed=seed)
    for steps in cuts:
        cut.advance(steps)
        state = {name: array.copy() for name, array in cut.state().items()}
        cut = lattice_engine((24, 20), GAS, timestep=0.03, seed=seed)
        cut.restore(state)
    for name, array in whole.state().items():
        np.testing.assert_array_equal(array, cut.state()[name])
    assert whole.happened().sum() > 0


@pytest.mark.parametrize("select", ["classes", "attempts"])
def test_a_large_lattice_has_the_same_bits_in_any_slices(select):
    """Memory of coming events is fetched there, by guesses that depend on where a slice begins."""

    def engine():
        return lattice_engine((512, 400), Ising(kT=1.7, field=0.1), timestep=0.02, select=select)

    whole, cut = engine(), engine()
    whole.advance(12)
    for steps in (1, 4, 7):
        cut.advance(steps)
    assert whole.happened().sum() > 5000
    for name, array in whole.state().items():
        np.testing.assert_array_equal(array, cut.state()[name], err_msg=name)


def test_records_go_on_to_the_same_bits():
    """Tracers and waiting times, of particles that hop, come and go; and what is made of them."""
    observe = [TracerDisplacement(every=1, max_lag=8, state="A"), WaitingTimes(every=2, state="A")]
    case = lattice_case((24, 20), GAS, timestep=0.03, steps=60, warmup=6, observe=observe)
    whole = Simulation(case)
    whole.run()
    cut, schedule = Simulation(case), Schedule(case)
    for target in (3, 6, 14, 15, 32, 66):
        cut.replicas.first.go(schedule.legs(cut.engine.step, target))
        engine = {name: array.copy() for name, array in cut.engine.state().items()}
        made = {
            name: {key: np.array(array) for key, array in one.state().items()}
            for name, one in cut.accumulators.items()
        }
        cut = Simulation(case)
        cut.engine.restore(engine)
        for name, one in cut.accumulators.items():
            one.restore(made[name])
    assert {"tags", "moved", "since", "waits", "sums", "began"} <= set(whole.engine.state())
    same(whole.engine.state(), cut.engine.state())
    for name, one in whole.accumulators.items():
        same(one.state(), cut.accumulators[name].state())


def same(state, other):
    assert set(state) == set(other)
    for name, array in state.items():
        np.testing.assert_array_equal(array, other[name])


def test_the_clock_keeps_short_waits_late_in_a_run():
    """Times of 1e9 and waits of 1e-8: a sum of doubles would lose a tenth of each of these."""
    engine = lattice_engine((64, 64), fast_gas(), timestep=1.0)
    engine.course.clock[:] = [1e9, 0.0, 1e9, 0.0]
    engine.step = 10**9
    engine.advance(1)
    events = engine.happened().sum()
    assert abs(events - 4096 * 1000.0) < 4 * np.sqrt(4096 * 1000.0)
    between = engine.course.clock[2:].sum() - engine.course.clock[:2].sum()
    assert between >= 0


def fast_gas():
    return LatticeGas(
        process=[
            GasProcess(name="on", site="empty -> A", rate=1000.0),
            GasProcess(name="off", site="A -> empty", rate=1000.0),
        ]
    )


def test_a_signal_ends_a_long_step_which_then_goes_on_to_the_same_bits(monkeypatch):
    whole = lattice_engine((64, 64), fast_gas(), timestep=2.0)
    whole.advance(2)
    cut = lattice_engine((64, 64), fast_gas(), timestep=2.0)
    monkeypatch.setattr(engine_module, "heard", lambda: True)
    with pytest.raises(Interrupted):
        cut.advance(2)
    assert cut.step == 0 and 0 < cut.happened().sum() < whole.happened().sum()
    monkeypatch.setattr(engine_module, "heard", lambda: False)
    state = {name: array.copy() for name, array in cut.state().items()}
    cut = lattice_engine((64, 64), fast_gas(), timestep=2.0)
    cut.restore(state)
    cut.advance(2)
    for name, array in whole.state().items():
        np.testing.assert_array_equal(array, cut.state()[name])


def test_particles_are_kept_by_hops():
    engine = lattice_engine((40,), Exclusion(backward=0.5), kind="chain")
    before = engine.sites().sum()
    engine.advance(50)
    assert engine.sites().sum() == before
    assert engine.happened().sum() > 100


def test_an_absorbing_state_waits_for_ever():
    gas = LatticeGas(process=[GasProcess(name="on", site="empty -> A", rate=1.0)])
    engine = lattice_engine((8, 8), gas)
    engine.advance(10_000)
    assert engine.sites().all() and engine.absorbed
    engine.advance(10)
    assert engine.happened().sum() <= 64
