"""Every way of choosing draws the next event by its rate, and the time to it by the total rate."""

import numpy as np
import pytest
from scipy import stats

from mesokit.method.kinetic_monte_carlo.engine.events import events
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.section import Sublattices
from mesokit.method.kinetic_monte_carlo.start import RandomStart
from tests.helpers.lattices import lattice_engine

SIZE, KT, FIELD = (6, 6), 2.0, 0.3
STATE = np.random.default_rng(3).integers(0, 2, 36)
DRAWS = 4000


def energy(states):
    """Of spins on a periodic square, by its definition."""
    spins = 2.0 * states.reshape(SIZE) - 1
    bonds = spins * (np.roll(spins, 1, 0) + np.roll(spins, 1, 1))
    return -bonds.sum() - FIELD * spins.sum()


def with_swapped(state, i, j):
    found = state.copy()
    found[i], found[j] = state[j], state[i]
    return found


def neighbours_of(i):
    x, y = divmod(i, SIZE[1])
    return [(x + a) % SIZE[0] * SIZE[1] + (y + b) % SIZE[1] for a, b in ((1, 0), (0, 1))]


def flips():
    """The states that may follow, and the rates of Metropolis."""
    return [np.where(np.arange(36) == i, 1 - STATE, STATE) for i in range(36)]


def exchanges():
    pairs = [(i, j) for i in range(36) for j in neighbours_of(i) if STATE[i] != STATE[j]]
    return [with_swapped(STATE, i, j) for i, j in pairs]


FOLLOW = {"flip": flips(), "exchange": exchanges()}


def drawn(engine, seed):
    """The state after one event, and the time of it."""
    engine.course = engine.course._replace(seed=np.uint64(seed))
    for array in (engine.course.clock, engine.course.drawn, engine.course.happened):
        array.fill(0)
    engine.start(STATE)
    while engine.happened().sum() == 0:
        events(*engine._arguments(), np.inf, 1)
    return engine.sites().tobytes(), engine.course.clock[0]


CHOICES = [(select, "flip") for select in ("classes", "groups", "tree", "linear", "attempts")]
CHOICES += [(select, "exchange") for select in ("classes", "groups", "attempts")]
# each of these compiles two kernels more
MORE = [pytest.param(select, "exchange", marks=pytest.mark.long) for select in ("tree", "linear")]


@pytest.mark.parametrize(("select", "moves"), [*CHOICES, *MORE])
def test_the_next_event_is_drawn_by_its_rate_and_waits_for_that_of_all(select, moves):
    model = Ising(kT=KT, field=FIELD, moves=moves)
    engine = lattice_engine(SIZE, model, select=select)
    before = energy(STATE)
    rates = np.array([min(1.0, np.exp((before - energy(s)) / KT)) for s in FOLLOW[moves]])
    kind = engine.sites().dtype
    number = {s.astype(kind).tobytes(): k for k, s in enumerate(FOLLOW[moves])}
    found = [drawn(engine, seed) for seed in range(DRAWS)]
    counts = np.bincount([number[state] for state, _ in found], minlength=len(rates))
    expected = DRAWS * rates / rates.sum()
    few = expected < 8  # chi-square needs some of each
    assert few.sum() < len(rates) / 2
    observed = [*counts[~few], counts[few].sum()]
    assert stats.chisquare(observed, [*expected[~few], expected[few].sum()]).pvalue > 1e-4
    waits = np.array([time for _, time in found])
    assert stats.kstest(waits * rates.sum(), "expon").pvalue > 1e-4


def test_attempts_find_that_nothing_can_happen():
    engine = lattice_engine((16, 16), Ising(kT=0.0), select="attempts", timestep=50.0)
    engine.start(np.zeros(256, np.uint8))
    engine.advance(10)
    assert engine.absorbed and engine.happened().sum() == 0


QUENCH = {"model": Ising(kT=0.0), "timestep": 2.0}


def walls(sublattices, seeds=range(1, 25)):
    """Energy of a site at t = 2 after a quench to T = 0, of each seed."""
    found = []
    for seed in seeds:
        engine = lattice_engine((256, 256), sublattices=sublattices, seed=seed, **QUENCH)
        engine.advance(1)
        pairs = engine.pairs()
        found.append((pairs[0, 1] + pairs[1, 0] - pairs[0, 0] - pairs[1, 1]) / 2 / engine.n)
    return np.mean(found), np.std(found, ddof=1) / len(found) ** 0.5


def test_sublattices_follow_the_exact_events_and_fail_with_long_cycles():
    exact, error = walls(None)
    short, short_error = walls(Sublattices(block=32))
    long, long_error = walls(Sublattices(block=32, cycle=2.0))
    assert abs(short - exact) < 3.5 * np.hypot(error, short_error)
    assert abs(long - exact) > 4 * np.hypot(error, long_error)


@pytest.mark.parametrize("moves", ["flip", "exchange"])
def test_sublattices_have_the_same_bits_on_any_number_of_threads_and_in_any_slices(moves):
    def engine(threads):
        half = RandomStart(fractions=[0.5, 0.5], exact=True)
        model = Ising(kT=1.5, moves=moves)
        given = {"sublattices": Sublattices(block=32), "start": half, "timestep": 0.7}
        return lattice_engine((96, 64), model, threads=threads, **given)

    whole, many = engine(1), engine(2)
    whole.advance(5)
    many.advance(2)
    state = {name: array.copy() for name, array in many.state().items()}
    again = engine(2)
    again.restore(state)
    again.advance(3)
    assert whole.happened().sum() > 1000
    for name, array in whole.state().items():
        np.testing.assert_array_equal(array, again.state()[name], err_msg=name)
    assert moves == "flip" or whole.sites().sum() == 96 * 32


@pytest.mark.parametrize("kind", ["triangular", "fcc"])
def test_what_is_kept_of_bonds_is_as_if_it_were_made_anew(kind):
    size = (20, 18, 6)[: KINDS[kind].dimension]
    model = Ising(kT=3.0, moves="exchange")
    engine = lattice_engine(size, model, kind=kind, ends=["x"], select="classes")
    engine.advance(5)
    assert engine.happened().sum() > 300
    kept, numbers = engine.choice.of.copy(), engine.choice.numbers.copy()
    engine.restore(engine.state())
    np.testing.assert_array_equal(engine.choice.of, kept)
    np.testing.assert_array_equal(engine.choice.numbers, numbers)
