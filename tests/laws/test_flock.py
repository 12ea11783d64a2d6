"""Flocks: lone birds, crowds, order of 300 birds, walls, cohesion; the same bits in every way."""

import math

import numpy as np
import pytest
from scipy import stats
from scipy.spatial import cKDTree

from mesokit import (
    AngularNoise,
    Case,
    Cohesion,
    Flock,
    MeanSquareDisplacement,
    NumberFluctuations,
    Plates,
    PolarOrder,
    Simulation,
    Surface,
    VectorialNoise,
    theory,
)
from mesokit.method.flock.engine.flocks import Flocks
from mesokit.method.flock.engine.memory import CHUNK
from tests.helpers.flocks import ANY_WALLS, SLIP, case

UNLIKELY = 1e-4


def begun(*size, threads=1, **given):
    return Simulation(case(size, **given), threads=threads).engine


def order(engine):
    return float(np.linalg.norm(engine.headings().mean(axis=0)))


def mean_and_error(values, blocks=20):
    means = np.reshape(values, (blocks, -1)).mean(axis=1)
    return means.mean(), means.std(ddof=1) / math.sqrt(blocks)


# --- one step -----------------------------------------------------------------------------------


def sums_of(places, headings, size, radius):
    """Sums of the headings in reach, and how many there are, by a tree."""
    tree = cKDTree(places, boxsize=size)
    pairs = tree.query_pairs(radius, output_type="ndarray")
    total, number = headings.copy(), np.ones(len(places))
    for a, b in (pairs.T, pairs.T[::-1]):
        np.add.at(total, a, headings[b])
        np.add.at(number, a, 1)
    return total, number


@pytest.mark.parametrize("order", ["synchronous", "original"])
@pytest.mark.parametrize("size", [(7.3, 9.1), (5.2, 4.1, 6.7)], ids=["2D", "3D"])
def test_without_noise_a_step_is_the_mean_of_all_in_reach(size, order):
    engine = begun(*size, density=3, speed=0.4, radius=1.3, noise=AngularNoise(0), order=order)
    engine.advance(1)
    places, headings = engine.positions(), engine.headings()
    total, _ = sums_of(places, headings, engine.box, 1.3)
    engine.advance(1)
    expected = total / np.linalg.norm(total, axis=1, keepdims=True)
    np.testing.assert_allclose(engine.headings(), expected, atol=1e-5)
    flight = engine.headings() if order == "synchronous" else headings
    way = (engine.positions() - places - 0.4 * flight) / engine.box
    np.testing.assert_allclose(way, np.rint(way), atol=1e-12)


@pytest.mark.parametrize("strength", [1.0, 5.0])
def test_angular_noise_is_uniform_in_2D(strength):
    engine = begun(9, 9, density=40, noise=AngularNoise(strength))
    total, _ = sums_of(engine.positions(), engine.headings(), engine.box, 1.0)
    engine.advance(1)
    found = engine.headings()
    mean = np.arctan2(total[:, 1], total[:, 0])
    turn = np.angle(np.exp(1j * (np.arctan2(found[:, 1], found[:, 0]) - mean)))
    assert stats.kstest(turn / strength + 0.5, "uniform").pvalue > UNLIKELY


def test_angular_noise_is_uniform_in_a_cap_in_3D():
    engine = begun(6, 6, 6, density=15, noise=AngularNoise(2.0))
    total, _ = sums_of(engine.positions(), engine.headings(), engine.box, 1.0)
    engine.advance(1)
    mean, found = total / np.linalg.norm(total, axis=1, keepdims=True), engine.headings()
    cosine = (mean * found).sum(axis=1)
    lowest = 1 - 2.0 / math.pi
    assert stats.kstest((cosine - lowest) / (1 - lowest), "uniform").pvalue > UNLIKELY
    across = found - cosine[:, None] * mean  # no direction about the mean is better than another
    one = np.cross(mean, [0.0, 0.0, 1.0])
    other = np.cross(mean, one)
    angle = np.arctan2((across * other).sum(axis=1), (across * one).sum(axis=1))
    assert stats.kstest(angle / (2 * math.pi) + 0.5, "uniform").pvalue > UNLIKELY


@pytest.mark.parametrize("size", [(9, 9), (5, 5, 5)], ids=["2D", "3D"])
def test_vectorial_noise_has_the_length_of_the_number_in_reach(size):
    """All fly along x: then the new heading is that of x + strength xi, whatever the number."""
    strength = 0.6
    noise = VectorialNoise(strength)
    engine = begun(*size, density=30, noise=noise, start={"headings": "aligned"})
    engine.advance(1)
    cosine = engine.headings()[:, 0]
    assert cosine.min() >= math.sqrt(1 - strength**2) - 1e-6  # no vector of this length does more
    expected = theory.vectorial_memory(strength, len(size))
    assert abs(cosine.mean() - expected) < 4 * cosine.std() / math.sqrt(engine.n)


# --- laws ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("size", "noise"),
    [
        ((20, 20), AngularNoise(2.0)), ((20, 20), VectorialNoise(0.7)),
        ((12, 12, 12), AngularNoise(2.0)), ((12, 12, 12), VectorialNoise(0.7)),
    ],
)  # fmt: skip
def test_lone_birds_walk_with_memory(size, noise):
    """Many birds that do not see one another: as one alone (Taylor 1921)."""
    engine = begun(*size, number=20_000, radius=1e-6, speed=0.3, noise=noise)
    start = engine.positions(unwrapped=True)
    memory = noise.memory(len(size))
    for steps in (1, 4, 25):
        engine.advance(steps - engine.step)
        square = ((engine.positions(unwrapped=True) - start) ** 2).sum(axis=1)
        expected = theory.msd_persistent_walk(steps, 0.3, memory)
        assert abs(square.mean() - expected) < max(4 * square.std() / math.sqrt(engine.n), 1e-12)


@pytest.mark.parametrize("noise", [AngularNoise(2.0), AngularNoise(6.0), VectorialNoise(0.7)])
def test_lone_birds_turn_to_neither_side(noise):
    """A million turns: sines have no mean."""
    engine = begun(20, 20, number=20_000, radius=1e-6, noise=noise)
    sines, before = [], engine.headings()
    for _ in range(50):
        engine.advance(1)
        after = engine.headings()
        sines.append(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
        before = after
    assert abs(np.mean(sines)) < 4 * np.std(sines) / 1000


def test_the_observable_of_a_lone_bird_knows_the_walk():
    observe = [MeanSquareDisplacement(every=1, max_lag=30)]
    given = case((9, 9), steps=20_000, number=1, noise=AngularNoise(3.0), observe=observe)
    simulation = Simulation(given)
    simulation.run()
    result = simulation["mean-square-displacement"]
    np.testing.assert_allclose(result.value[1:], result.expected[1:], rtol=0.08)
    walk = theory.persistent_diffusion(0.5, 1.0, theory.angular_memory(3.0, 2), 2)
    assert result["diffusion"].expected == walk
    assert result["diffusion"].measured == pytest.approx(walk, rel=0.1)


@pytest.mark.parametrize("strength", [2.0, 4.0])
@pytest.mark.parametrize("size", [(2, 2), (2, 2, 2)], ids=["2D", "3D"])
def test_birds_that_all_see_one_another(size, strength):
    given = case(
        size, steps=1000, number=400, radius=2.0, noise=AngularNoise(strength),
        observe=[PolarOrder(every=1)],
    )  # fmt: skip
    simulation = Simulation(given)
    simulation.engine.advance(20)
    simulation.run()
    found = simulation["polar-order"]["mean square"]
    memory = theory.angular_memory(strength, len(size))
    assert found.expected == pytest.approx(memory**2 + (1 - memory**2) / 400)
    assert 0 < found.error < 0.005 * found.expected
    assert abs(found.deviation) < 4


@pytest.mark.parametrize("strength", [0.45, 0.8])
@pytest.mark.parametrize("size", [(2, 2), (2, 2, 2)], ids=["2D", "3D"])
def test_birds_with_vectorial_noise_that_all_see_one_another(size, strength):
    """Mean field, with the first order in 1/N: far beyond the errors from infinitely many."""
    given = case(
        size, steps=4000, number=400, radius=2.0, noise=VectorialNoise(strength),
        start={"headings": "aligned"}, observe=[PolarOrder(every=1)],
    )  # fmt: skip
    simulation = Simulation(given)
    simulation.engine.advance(50)
    simulation.run()
    known = theory.vectorial_order(strength, 400, len(size))
    mean, square = (simulation["polar-order"][name] for name in ("mean polar", "mean square"))
    assert (mean.expected, square.expected) == (known.mean, known.mean_square)
    for found in (mean, square):
        assert abs(found.deviation) < 4
        assert 0 < found.error < (1e-3 if strength < 0.5 else 0.08) * found.expected
    assert abs(mean.measured - known.many) > 3 * mean.error


@pytest.mark.parametrize("size", [(12, 12), (6, 6, 6)], ids=["2D", "3D"])
def test_birds_that_do_not_heed_others_are_at_random(size):
    observe = [PolarOrder(every=1), NumberFluctuations(every=10, sides=[1, 1.5, 2, 3])]
    noise = AngularNoise(2 * math.pi)
    simulation = Simulation(case(size, steps=4000, number=300, noise=noise, observe=observe))
    simulation.run()
    for name in ("mean polar", "mean square", "binder"):
        assert abs(simulation["polar-order"][name].deviation) < 4
    fluctuations = simulation["number-fluctuations"]
    assert np.abs(fluctuations.deviation).max() < 4.5
    assert abs(fluctuations["exponent"].deviation) < 4


# order of 300 birds of speed 0.03 at a density of 4, each from 60 000 steps of another program
ORDER = {0.5: (0.9861, 1e-4), 2.0: (0.7911, 9e-4), 3.0: (0.5544, 17e-4), 5.0: (0.0719, 3e-4)}


@pytest.mark.parametrize("strength", ORDER)
def test_order_of_300_birds(strength):
    """Vicsek et al. (1995), figure 2, birds that move along their new headings."""
    side = math.sqrt(300 / 4)
    engine = begun(side, side, number=300, speed=0.03, noise=AngularNoise(strength))
    engine.advance(2000)
    values = []
    for _ in range(4000):
        engine.advance(5)
        values.append(order(engine))
    mean, error = mean_and_error(values)
    expected, other = ORDER[strength]
    assert abs(mean - expected) < 4 * math.hypot(error, other)
    assert error < 0.01


def test_without_noise_all_agree():
    engine = begun(6, 6, density=4, noise=AngularNoise(0))
    engine.advance(300)
    assert order(engine) > 1 - 1e-9


def test_no_direction_is_better_than_another():
    """Fourfold order of the mean heading, which cells or the box could bring, is 0."""
    found = []
    for seed in range(60):
        engine = begun(8, 8, density=3, noise=AngularNoise(1.5), seed=seed)
        engine.advance(100)
        x, y = engine.headings().mean(axis=0)
        found.append(math.cos(4 * math.atan2(y, x)))
    assert abs(np.mean(found)) < 3.5 * math.sqrt(0.5 / len(found))


def test_vectorial_noise_orders_below_its_threshold_alone():
    """Gregoire and Chate (2004): far below all fly one way, far above nobody does."""
    low, high = (begun(24, 24, density=2, noise=VectorialNoise(s)) for s in (0.4, 0.8))
    for engine in (low, high):
        engine.advance(1500)
    assert order(low) > 0.85
    assert order(high) < 0.12


def test_giant_number_fluctuations():
    """Toner and Tu (1995): with order the exponent is 0.8, not 1/2."""
    given = case(
        (48, 48), steps=3000, density=2, noise=AngularNoise(1.57),
        observe=[NumberFluctuations(every=10, sides=[1.5, 3, 6, 12])],
    )  # fmt: skip
    simulation = Simulation(given)
    simulation.engine.advance(1000)
    simulation.run()
    found = simulation["number-fluctuations"]["exponent"]
    assert found.error < 0.05
    assert 0.72 < found.measured < 0.9


@pytest.mark.parametrize(("strength", "expected", "why"), [
    (0.4, 0.8, "approximate: large ordered flocks (Toner and Tu 1995), polar order 0.9"),
    (3.2, math.nan, "no theory for this flock, polar order 0."),
    (5.6, 0.489, "approximate: disordered flocks, polar order 0.0"),
])  # fmt: skip
def test_fluctuations_are_compared_with_the_theory_of_their_phase(strength, expected, why):
    """That of order only where birds fly together, that at random only where they do not."""
    observe = [NumberFluctuations(every=10, sides=[1, 2, 4])]
    given = case((16, 16), steps=400, density=2, noise=AngularNoise(strength), observe=observe)
    simulation = Simulation(given)
    simulation.engine.advance(300)
    simulation.run()
    found = simulation["number-fluctuations"]["exponent"]
    assert found.expected == pytest.approx(expected, abs=1e-3, nan_ok=True)
    assert found.note.startswith(why)
    accumulator = observe[0].accumulator(given)
    kept = simulation.accumulators["number-fluctuations"].state()
    accumulator.restore({k: v for k, v in kept.items() if k.startswith("blocks")})  # of before
    assert math.isnan(accumulator.result()["exponent"].expected)
    assert accumulator.result()["exponent"].measured == found.measured


# --- cohesion -----------------------------------------------------------------------------------


@pytest.mark.parametrize("way", [(1.0, 0.0), (0.6, 0.8), (0.6, 0.0, 0.8)])
@pytest.mark.parametrize(("distance", "pull"), [(0.1, None), (0.3, -1 / 6), (0.5, 0), (0.9, 1)])
def test_two_birds_and_the_force_between_them(way, distance, pull):
    """Gregoire, Chate and Tu (2003): the sum of the headings, and f along the way to the other."""
    d, way = len(way), np.array(way)
    places = np.full((2, d), 0.05) + np.outer([0, distance], way)  # across the end of the box too
    places -= 0.1
    headings = np.eye(d)[[0, 1]]
    cohesion = Cohesion(strength=1.5)
    given = case((4,) * d, number=2, noise=AngularNoise(0), cohesion=cohesion, speed=1e-3)
    engine = Simulation(given, positions=places, velocities=headings).engine
    engine.advance(1)
    if pull is None:  # in the core nothing else counts
        expected = np.array([-way, way])
    else:
        expected = headings.sum(axis=0) + 1.5 * pull * np.array([way, -way])
        expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    np.testing.assert_allclose(engine.headings(), expected, atol=1e-5)


def test_cohesion_holds_a_flock_together():
    """Without it birds fly apart; with it they keep a distance and stay."""
    rng = np.random.default_rng(3)
    places = 15 + rng.uniform(-1.2, 1.2, (60, 2))
    spread = {}
    for name, cohesion in (("alone", None), ("together", Cohesion(strength=5.0))):
        given = case((30, 30), number=60, speed=0.05, noise=AngularNoise(1.0), cohesion=cohesion)
        engine = Simulation(given, positions=places, velocities=rng.normal(size=(60, 2))).engine
        engine.advance(2000)
        r = engine.positions(unwrapped=True)
        spread[name] = np.linalg.norm(r - r.mean(axis=0), axis=1).mean()
        nearest = cKDTree(r).query(r, k=2)[0][:, 1]
    assert spread["together"] < 3 < 8 < spread["alone"]
    assert np.median(nearest) > 0.2 - 0.05  # the core, less a step into it


# --- walls --------------------------------------------------------------------------------------


def test_a_flight_to_a_mirror_and_to_one_that_turns_back():
    for rule, heading in (("slip", (0.6, -0.8)), ("no-slip", (-0.6, -0.8))):
        upper = Surface(rule=rule)
        given = case(
            (10, 10), number=1, noise=AngularNoise(0), speed=2.0,
            walls=[Plates("y", lower=SLIP, upper=upper)],
        )  # fmt: skip
        engine = Simulation(given, positions=[[1.0, 9.2]], velocities=[[0.6, 0.8]]).engine
        engine.advance(1)  # half of the way up, half of it back
        np.testing.assert_allclose(engine.headings()[0], heading, atol=1e-12)
        x = 2.2 if rule == "slip" else 1.0
        np.testing.assert_allclose(engine.positions()[0], [x, 9.2], atol=1e-8)


def test_no_bird_is_ever_in_a_wall_and_none_sees_across_the_box_there():
    given = case((20, 20), density=4, speed=0.7, walls=ANY_WALLS)
    engine = Simulation(given).engine
    for _ in range(100):
        engine.advance(3)
        assert engine.solids.distance(engine.positions()).min() > 0
    assert np.allclose(np.linalg.norm(engine.headings(), axis=1), 1)
    lonely = case((10, 10), number=2, noise=AngularNoise(0), walls=[Plates("y")])
    ends = [[5.0, 0.2], [5.0, 9.8]]
    engine = Simulation(lonely, positions=ends, velocities=[[1, 0], [0.8, -0.6]]).engine
    engine.advance(1)
    np.testing.assert_allclose(engine.headings(), [[1, 0], [0.8, -0.6]], atol=1e-6)


# --- the same bits ------------------------------------------------------------------------------

NEARLY = 1.9 - 1e-6, 1.9 + 1e-6


def test_a_crowd_in_one_cell_has_the_same_bits():
    """More birds near than are looked at together."""
    made = case((4, 4), number=900, radius=1.9, noise=VectorialNoise(0.4))
    one, other = Flocks(made), Flocks(made, side=1.95)
    assert one.physics.axes.cells == (1, 1)
    start = Simulation(made).engine.state()
    for engine in (one, other):
        engine.restore(start)
        engine.advance(1)
    seen = np.empty(one.n)
    seen[one.flock.birds.numbers[one.current]] = one.flock.seen.sums[2]
    # single precision knows the reach to some 1e-7
    least, most = (sums_of(start["places"], start["headings"], one.box, r)[1] for r in NEARLY)
    assert least.max() > 2 * CHUNK
    assert ((seen >= least) & (seen <= most)).all()
    np.testing.assert_array_equal(one.headings(), other.headings())


def test_a_run_begins_where_another_ended(tmp_path):
    whole = Simulation(case((12, 12), steps=60, density=5), output=tmp_path / "whole", threads=1)
    whole.run()
    again = case((12, 12), density=5)
    later = Case(
        run=again.run, box=again.box,
        flock=Flock(density=5, start={"run": str(tmp_path / "whole")}),
    )  # fmt: skip
    engine = Simulation(later).engine
    np.testing.assert_array_equal(engine.headings(), whole.engine.headings())
    np.testing.assert_allclose(engine.positions(), whole.engine.positions(), atol=1e-12)


def test_starts():
    engine = begun(9, 7, density=50)
    for k, length in enumerate((9, 7)):
        assert stats.kstest(engine.positions()[:, k] / length, "uniform").pvalue > UNLIKELY
    angle = np.arctan2(*engine.headings().T)
    assert stats.kstest(angle / (2 * math.pi) + 0.5, "uniform").pvalue > UNLIKELY
    aligned = begun(5, 5, 5, density=5, start={"headings": "aligned"})
    np.testing.assert_array_equal(aligned.headings(), np.tile([1.0, 0, 0], (aligned.n, 1)))
    assert not np.isin(begun(9, 7, density=50, seed=2).positions(), engine.positions()).any()
