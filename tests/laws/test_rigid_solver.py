"""Sweeps over contacts of rigid grains: how far one spreads forces, how fast errors fall."""

import math

import numpy as np
import pytest

from mesokit import Plates, SphereKind, theory
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel
from mesokit.method.spheres.rigid.solver.jacobi import Jacobi
from tests.helpers.rigid_grains import at_rest, exact, impulses, pushes, rigid

SMOOTH = {"friction": 0.0}
UNEQUAL = [SphereKind(1.0, mass=1.0, spread=1e-12)]  # as dense as equal ones cannot be
DEEP = 1e-3  # overlap of neighbours in rings, so that waves open no contact


def solver(order, sweeps):
    """So many sweeps in each step."""
    if order == "jacobi":
        return Jacobi(sweeps=sweeps, tolerance=0)
    return GaussSeidel(order, sweeps=sweeps, tolerance=0)


def ring(n, order, sweeps, velocities=None, timestep=1.0):
    """A periodic row of grains whose contacts have an impulse of 1 from the step before."""
    places = [[(i + 0.25) * (1 - DEEP), 2.0] for i in range(n)]
    given = {} if velocities is None else {"velocities": velocities}
    engine = rigid(
        [n * (1 - DEEP), 4.0], given=at_rest(places, **given), contact=SMOOTH, timestep=timestep,
        solver=solver(order, sweeps),
    )  # fmt: skip
    prestress(engine, [[i, (i + 1) % n] for i in range(n)], np.ones(n))
    return engine


def prestress(engine, pairs, sizes):
    """Let the last step have had these impulses (m,) along the lines of centres of pairs (m, 2)."""
    state, (pairs, order) = engine.state(), np.unique(np.sort(pairs, 1), axis=0, return_index=True)
    sizes = np.array(sizes)[order]
    r = engine.positions()
    apart = r[pairs[:, 0]] - r[pairs[:, 1]]
    apart -= engine.box * np.rint(apart / engine.box)
    springs = np.zeros((len(pairs), 3))
    normals = apart / np.linalg.norm(apart, axis=1)[:, None]
    springs[:, : engine.dimension] = sizes[:, None] * normals
    engine.restore(state | {"pairs": pairs, "springs": springs})


# --- how far one sweep spreads ------------------------------------------------------------------

SPACE = 50  # contacts between changes
FAR = np.arange(SPACE) - SPACE // 2


def spread(order, steps):
    """Mean force at each distance from a contact whose force was higher by 1 before one sweep."""
    n = 40 * SPACE
    engine = ring(n, order, 1)
    bump, found = 1e-3, []
    first = engine.state()
    pairs, springs = first["pairs"], first["springs"].copy()
    chain = np.where(pairs[:, 1] - pairs[:, 0] == 1, pairs[:, 0], n - 1)  # contact i: i and i + 1
    # the seam at grain 0 is halfway between two bumps
    springs[chain % SPACE == SPACE // 2] *= 1 + bump
    for step in range(steps):
        engine.restore(first | {"springs": springs, "step": np.array(step)})
        engine.advance(1)
        kept, now = impulses(engine)
        assert len(kept) == n
        forces = np.empty(n)
        forces[chain] = np.linalg.norm(now, axis=1)
        found.append(((forces - 1) / bump).reshape(-1, SPACE))
    return np.concatenate(found)


@pytest.mark.parametrize(
    ("order", "near"),
    [
        ("jacobi", {-1: 1 / 2, 0: 0, 1: 1 / 2, 2: 0}),
        ("ordered", {-2: 0, -1: 1 / 2, 0: 1 / 4, 1: 1 / 8, 2: 1 / 16}),
    ],
)
def test_a_sweep_spreads_forces_by_its_order(order, near):
    kernel = spread(order, 1)[5:-5].mean(axis=0)
    assert kernel.sum() == pytest.approx(1.0, abs=1e-6)
    assert kernel @ FAR**2 / 2 == pytest.approx(theory.sweep_spread(order), abs=1e-6)
    found = kernel[np.array(list(near)) + SPACE // 2]
    assert found == pytest.approx(list(near.values()), abs=1e-6)


def test_a_sweep_in_random_order_spreads_forces_as_walks_back_do():
    parts = spread("random", 150).reshape(50, -1, SPACE).mean(axis=1)
    waves = np.linspace(0.3, 3.0, 10)

    def checked(values, known):
        error = values.std(axis=0, ddof=1) / math.sqrt(len(values))
        assert np.abs((values.mean(axis=0) - known) / error).max() < 4
        return error

    error = checked(parts @ FAR**2 / 2, theory.sweep_spread("random"))
    assert error < 0.01
    checked(parts @ np.cos(np.outer(FAR, waves)), theory.sweep_factor(waves, "random"))
    checked(parts @ np.sin(np.outer(FAR, waves)), 0.0)  # the same to both sides


# --- how fast errors fall -----------------------------------------------------------------------


def column(n, order, sweeps):
    """A column in its first step, in which forces begin from none; errors over the weight."""
    engine = rigid(
        [8, n + 4], walls=[Plates("y")], given=at_rest([[4.0, 0.5 + i] for i in range(n)]),
        gravity=[0.0, -1.0], timestep=1e-3, contact=SMOOTH, solver=solver(order, sweeps),
    )  # fmt: skip
    engine.advance(1)
    expected = n - 1 - np.arange(n - 1.0)
    found = np.zeros(n - 1)
    found[impulses(engine)[0][:, 0]] = pushes(engine)
    return np.abs(found - expected).max() / n


@pytest.mark.parametrize(("n", "known"), [(8, 448), (16, 1778)])
def test_forces_of_a_column_are_good_to_a_millionth_after_some_square_of_its_height(n, known):
    """`known`: sweeps in random order that an independent program took."""
    few, more = round(0.8 * known), round(1.2 * known)
    errors = [column(n, "random", sweeps) for sweeps in (few, more)]
    rate = math.log(errors[0] / errors[1]) / (more - few)
    needed = few + math.log(errors[0] / 1e-6) / rate
    assert needed == pytest.approx(known, rel=0.03)
    assert needed == pytest.approx(6.93 * n * n, rel=0.03)


@pytest.mark.parametrize("order", ["ordered", "coloured"])
def test_the_slowest_error_of_a_row_falls_by_a_cosine(order):
    # grains that close up on one another evenly: forces are a parabola, 0 beyond both ends
    n = 15  # contacts
    speeds = -0.1 * (np.arange(n + 1) - 0.5 * n)
    errors = []
    for sweeps in (150, 250):
        places = [[4.0 + i, 4.0] for i in range(n + 1)]
        engine = rigid(
            [n + 8, 8], given=at_rest(places, velocities=np.stack([speeds, 0 * speeds], 1)),
            contact=SMOOTH, timestep=1e-3, solver=solver(order, sweeps),
        )  # fmt: skip
        engine.advance(1)
        errors.append(np.abs(engine.velocities()[:, 0]).max())
    measured = math.log(errors[1] / errors[0])
    expected = 2 * 100 * math.log(math.cos(theory.slowest_wave(n)))
    assert measured == pytest.approx(expected, rel=1e-6)


def stack(dimension, side, sweeps):
    """Close-packed layers on a floor, as many as grains are in a row: the largest net force over
    the weight in the first step."""
    apart, along = math.sqrt(0.75) if dimension == 2 else math.sqrt(0.5), "xyz"[dimension - 1]
    layers = np.indices((side,) * dimension).reshape(dimension, -1).T.astype(float)
    places = layers + 0.25 + 0.5 * (layers[:, -1:] % 2)  # a layer lies in the hollows of the last
    places[:, -1] = 0.5 + apart * layers[:, -1]
    engine = rigid(
        [side] * (dimension - 1) + [side + 4], walls=[Plates(along)], given=at_rest(places),
        gravity=[0.0] * (dimension - 1) + [-1.0], timestep=1e-3, contact=SMOOTH,
        solver=solver("random", sweeps),
    )  # fmt: skip
    engine.advance(1)
    return np.abs(engine.velocities()).max() / engine.timestep


@pytest.mark.parametrize("dimension", [2, 3])
def test_sweeps_of_a_packing_go_as_its_number_of_grains_to_the_power_of_two_over_d(dimension):
    """Those in which the slowest error decays by e."""
    needed = []
    for side in (6, 12):
        few, more = 4 * side**2, 6 * side**2
        errors = [stack(dimension, side, sweeps) for sweeps in (few, more)]
        needed.append((more - few) / math.log(errors[0] / errors[1]))
    power = math.log(needed[1] / needed[0]) / math.log(2**dimension)
    assert power == pytest.approx(2 / dimension, rel=0.05)


# --- rigid chains are elastic -------------------------------------------------------------------


@pytest.mark.parametrize("order", ["random", "coloured"])
@pytest.mark.parametrize(("n", "sweeps"), [(64, 5), (192, 20)])
def test_a_rigid_chain_swings_as_an_elastic_one(order, n, sweeps):
    """A standing wave; forces of a step begin with those of the last one."""
    k = 2 * math.pi / n
    wave = np.cos(k * (np.arange(n) + 0.25))
    velocities = np.stack([1e-6 * wave, 0 * wave], 1)
    engine = ring(n, order, sweeps, velocities)
    known = theory.rigid_chain_wave(k, sweeps, 1.0, order)
    period = 2 * math.pi / known.frequency
    found = []
    for _ in range(round(3 * period)):
        engine.advance(1)
        found.append(engine.velocities()[:, 0] @ wave / (wave @ wave) / 1e-6)
    t = np.arange(1, len(found) + 1)
    frequency, decay = swing(t, np.array(found), known.frequency, known.decay)
    assert frequency == pytest.approx(known.frequency, rel=0.02)
    assert decay == pytest.approx(known.decay, rel=0.03)
    long = theory.rigid_chain(sweeps, 1.0, 1.0, 1.0, order)
    assert frequency == pytest.approx(long.speed * k, rel=0.04)


def swing(t, found, frequency, decay):
    """Frequency and decay of a wave exp(-decay t) cos(frequency t + phase), fitted."""
    from scipy.optimize import curve_fit

    def model(t, a, b, w, g):
        return np.exp(-g * t) * (a * np.cos(w * t) + b * np.sin(w * t))

    return curve_fit(model, t, found, p0=(1.0, 0.0, frequency, decay))[0][2:]


# --- all contacts at once -----------------------------------------------------------------------


def triangular(relaxation, sweeps, side=8):
    """Residual velocity after sweeps over all contacts at once, in a periodic triangular lattice
    that is under pressure but for a little noise."""
    squeeze = 1 - DEEP
    rows, columns = np.divmod(np.arange(side * side), side)
    places = np.stack([(columns + 0.5 * (rows % 2) + 0.3), (rows + 0.3) * math.sqrt(3) / 2], 1)
    size = [side * squeeze, side * math.sqrt(3) / 2 * squeeze]
    engine = rigid(
        size, given=at_rest(places * squeeze), contact=SMOOTH, timestep=1e-3, kinds=UNEQUAL,
        solver=Jacobi(relaxation=relaxation, sweeps=sweeps, tolerance=0),
    )  # fmt: skip
    up = ((rows + 1) % side) * side
    right = (columns + rows % 2) % side
    ahead = rows * side + (columns + 1) % side
    me = np.arange(side * side)
    pairs = np.concatenate(
        [np.stack([me, other], 1) for other in (ahead, up + right, up + (right - 1) % side)]
    )
    noise = np.random.default_rng(1).normal(0, 1e-9, len(pairs))
    prestress(engine, pairs, 1 + noise)
    engine.advance(1)
    return np.linalg.norm(engine.velocities())


@pytest.mark.parametrize("relaxation", [1.0, 0.75, 0.6])
def test_errors_double_where_all_contacts_of_a_triangular_lattice_change_at_once(relaxation):
    late = [triangular(relaxation, sweeps) for sweeps in (16, 22)]
    growth = (late[1] / late[0]) ** (1 / 6)
    factor = theory.parallel_factor("triangular", relaxation)
    if relaxation > theory.largest_relaxation("triangular"):
        assert growth == pytest.approx(abs(factor), rel=0.01)
    else:
        assert growth < 1.0


def test_contacts_one_by_one_settle_there():
    n = 32
    alternate = 1e-6 * (-1.0) ** np.arange(n)
    left = []
    for order, sweeps in (("jacobi", 6), ("jacobi", 7), ("coloured", 7)):
        engine = ring(n, order, sweeps, np.stack([alternate, np.zeros(n)], 1))
        engine.advance(1)
        left.append(engine.velocities()[:, 0])
    assert left[0] == pytest.approx(alternate, abs=1e-12)
    assert left[1] == pytest.approx(-alternate, abs=1e-12)  # the sign changes for ever
    assert left[2] == pytest.approx(0 * alternate, abs=1e-12)


def test_sweeps_end_at_the_tolerance():
    errors, sweeps = [], []
    for tolerance in (1e-3, 1e-5, 1e-7):
        engine = rigid(
            [8, 20], walls=[Plates("y")], given=at_rest([[4.0, 0.5 + i] for i in range(12)]),
            gravity=[0.0, -1.0], timestep=1e-3, contact=SMOOTH, solver=exact(tolerance=tolerance),
        )  # fmt: skip
        engine.advance(1)
        done, ratio, mean, _ = engine.system.last_solved()
        assert ratio <= tolerance
        assert mean == pytest.approx(1e-3 * 6.5, rel=0.2)
        sweeps.append(done)
        errors.append(np.abs(pushes(engine) - (11 - np.arange(11))).max())
    falls = 2 * math.log(math.cos(theory.slowest_wave(12, column=True)))
    assert np.diff(sweeps) == pytest.approx(math.log(1e-2) / falls, rel=0.1)
    assert errors[0] > 50 * errors[1] > 50 * 50 * errors[2]
