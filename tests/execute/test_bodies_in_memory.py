"""Mechanics of bodies one by one: inertia, turns, reflections, the noise of gas, and gaps."""

import numpy as np
import pytest
from scipy import linalg

from mesokit import Plates
from mesokit.kernels.kernel import kernel
from mesokit.method.mpcd.body.inertia import _grid, _inside, solid_of
from mesokit.method.mpcd.engine.bodies import linear, state
from mesokit.method.mpcd.engine.bodies.dipoles import turn_of_shell
from mesokit.method.mpcd.engine.bodies.forces import nearest_places
from mesokit.method.mpcd.engine.bodies.gas import mean_in_ball
from mesokit.method.mpcd.engine.bodies.hits import add_hit
from mesokit.method.mpcd.engine.bodies.linear import solve_noise, solve_reflection
from mesokit.method.mpcd.engine.bodies.motion import turn_freely
from mesokit.method.mpcd.engine.bodies.state import load, rotated
from tests.helpers.bodies import PLANAR, SHAPES, SPATIAL, body
from tests.helpers.small_fluids import make_fluid

ZERO = (0.0, 0.0, 0.0)


@pytest.mark.parametrize(("name", "d"), SHAPES)
def test_volume_and_inertia_are_those_of_many_small_cubes(name, d):
    region = body(name, d).region()
    solid, parts = solid_of(region, d == 2), [part for (part,) in region]
    own = [state.primitive.PRIMITIVES[part.code].integrals(part.numbers, d) for part in parts]
    places, step = _grid(parts, own, d)
    inside = np.pad(places[_inside(parts, places) > 0], ((0, 0), (0, 3 - d)))
    away = inside - inside.mean(axis=0)
    second = step**d * away.T @ away
    moments = np.trace(second) * np.eye(3) - second
    assert solid.volume == pytest.approx(step**d * len(inside), rel=0.04)
    np.testing.assert_allclose(solid.moments, moments, atol=0.04 * np.trace(moments))
    shift = places - inside.mean(axis=0)[:d]
    reached = np.linalg.norm(shift[_inside(parts, places) > 0], axis=1).max()
    assert reached <= solid.radius < reached + 2 * step * np.sqrt(d) + 0.35 * (name == "union")


@pytest.fixture(scope="module")
def spatial():
    """One body of each shape in 3D, at places of their own; of a kind that laws are tested with."""
    kinds = [body(name, 3, number=1, density=30) for name in SPATIAL]
    walls = [Plates(axis="z")]
    return make_fluid((40, 20, 20), density=1, bodies=kinds, walls=walls).bodies


@kernel
def turn(bodies, i, time):
    turn_freely(bodies, i, time)


@pytest.mark.parametrize("i", range(1, len(SPATIAL)))
def test_a_free_turn_keeps_energy_and_angular_momentum_and_is_reversible(spatial, i):
    rows = spatial.state_of.rows
    first = np.array([0.3, -0.5, 0.2])
    rows[i, state.SPIN : state.SPIN + 3] = first
    start = spatial.orientations[i].copy()

    def conserved():
        own, inertia = spatial.in_own_frame(spatial.spins)[i], spatial.inertia(i)
        q = tuple(spatial.orientations[i])
        return own @ inertia @ own, np.array(rotate(q, tuple(inertia @ own)))

    energy, momentum = conserved()
    for _ in range(200):
        turn(spatial.state_of, i, 0.1)
    later, momentum_later = conserved()
    assert later == pytest.approx(energy, rel=1e-12)
    np.testing.assert_allclose(momentum_later, momentum, rtol=0, atol=1e-11 * abs(momentum).max())
    assert abs(spatial.orientations[i] - start).max() > 0.1
    for _ in range(200):
        turn(spatial.state_of, i, -0.1)
    np.testing.assert_allclose(spatial.orientations[i], start, atol=1e-10)


@kernel
def rotate(q, a):
    return rotated(q, a)


@kernel
def hit(bodies, sums, i, m, s, normal, g, physics):
    add_hit(bodies, sums, i, m, s, normal, g, physics)


@kernel
def solve(bodies, i, sums, scales, work, noise):
    if noise:
        solve_noise(bodies, i, sums, 3, scales, work)
    else:
        solve_reflection(bodies, i, sums, 3, scales, work)


def lever_matrix(s):
    """B of the velocity V + Omega x s."""
    x, y, z = s
    return np.hstack([np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]]])


@pytest.mark.parametrize("noise", [False, True], ids=["reflection", "noise"])
def test_solutions_are_those_of_linear_algebra(spatial, noise):
    """2 (1 + M^-1 G)^-1 M^-1 P, and [1 + (1 - M^-1 G)^(1/2)]^-1 M^-1 P."""
    i, bodies = 1, spatial.state_of
    random, memory = np.random.default_rng(3), spatial.memory
    sums = np.zeros(state.SUMS, np.int64)
    g_sum, p_sum = np.zeros((6, 6)), np.zeros(6)
    for _ in range(40):
        s, g = random.normal(size=3), random.normal(size=3)
        normal = s / np.linalg.norm(s)
        hit(bodies, sums, i, 1.0, tuple(s), tuple(normal), tuple(g), memory.physics)
        g_sum += lever_matrix(s).T @ lever_matrix(s)
        p_sum += lever_matrix(s).T @ g
    bodies.rows[i, state.END_TURN : state.END_TURN + 4] = spatial.orientations[i]
    q = tuple(spatial.orientations[i])
    turned = np.array([rotate(q, tuple(axis)) for axis in np.eye(3)]).T
    whole = linalg.block_diag(spatial.masses[i] * np.eye(3), turned @ spatial.inertia(i) @ turned.T)
    work = np.zeros(state.WORK)
    scales = bodies.mass_scale, memory.physics.scales[0]
    solve(bodies, i, sums, scales, work, noise)
    if noise:
        inner = np.eye(6) + linalg.sqrtm(np.eye(6) - np.linalg.solve(whole, g_sum)).real
        expected = np.linalg.solve(inner, np.linalg.solve(whole, p_sum))
    else:
        expected = 2 * np.linalg.solve(whole + g_sum, p_sum)
    found = work[linear.X : linear.X + 6] / np.repeat([1.0, bodies.lever], 3)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * abs(expected).max())
    if not noise:  # energy: sum (v - B dU) . ... = 0 for v' = v - 2 (g - B dU / 2)
        change = expected @ whole @ expected / 2
        assert change == pytest.approx(p_sum @ expected - expected @ g_sum @ expected / 2, rel=1e-9)


@kernel
def turn_shell(sums, torque, zero):
    return turn_of_shell(sums, torque, zero)


def test_the_turn_of_a_shell_takes_a_torque_and_no_momentum():
    random = np.random.default_rng(7)
    s, m, torque = random.normal(size=(30, 3)) + [1, 0, 2], 2.0**30, np.array([2.0, -1.0, 0.5])
    x, y, z = s.T
    each = [x**0, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z]
    sums = np.array([np.rint(m * one.sum()) for one in each], np.int64)
    middle, w = turn_shell(sums, tuple(m * torque), ZERO)
    impulses = np.cross(w, s - np.array(middle))
    np.testing.assert_allclose(impulses.sum(axis=0), 0, atol=1e-6)
    np.testing.assert_allclose(np.cross(s, impulses).sum(axis=0), torque, atol=1e-6)


@kernel
def nearest(bodies, a, x, q, b, other, p):
    return nearest_places(bodies, a, x, q, b, other, p)


def test_the_nearest_places_of_two_parts_are_nearest(spatial):
    """Of all parts with all others: no sampled place of one is nearer to the other."""
    bodies, random = spatial.state_of, np.random.default_rng(5)
    turns = random.normal(size=(2, 4))
    q, p = (tuple(turn / np.linalg.norm(turn)) for turn in turns)
    parts, least = len(bodies.part_code), []
    for a in range(parts):
        for b in range(parts):
            mine, theirs = nearest(bodies, a, ZERO, q, b, (6.5, 2.0, -1.0), p)
            gap = np.linalg.norm(np.subtract(mine, theirs))
            back, forth = nearest(bodies, b, (6.5, 2.0, -1.0), p, a, ZERO, q)
            assert np.linalg.norm(np.subtract(back, forth)) == pytest.approx(gap, abs=1e-6)
            least.append(gap)
    assert min(least) > 0.1 and len(least) == parts * parts


def test_all_shapes_are_tested():
    from mesokit.method.mpcd.body import BODIES

    assert {kind for kind, _ in (PLANAR | SPATIAL).values()} | {
        kind for kind, _ in PLANAR.values()
    } == set(BODIES)


@kernel
def means_in_ball(radius, middles, zero, means):
    for n in range(len(means)):
        means[n], _ = mean_in_ball(1.0, radius, load(middles, n, 0, zero))


@pytest.mark.parametrize("radius", [2.0, 3.0])
@pytest.mark.parametrize("d", [2, 3])
def test_a_plane_cuts_as_much_of_cells_as_the_sphere(d, radius):
    """On the mean over places of the grid; without its depth 3 to 8 % too much."""
    side = np.arange(-5.0, 6.0)
    shifts = np.random.default_rng(3).random((8, 1, d))
    cells = np.stack(np.meshgrid(*[side] * d), axis=-1).reshape(-1, d)
    middles = (cells + shifts).reshape(-1, d)
    middles = middles[abs(np.linalg.norm(middles, axis=1) - radius) < 0.5 * np.sqrt(d)]
    within = (np.arange(10) + 0.5) / 10 - 0.5
    points = np.stack(np.meshgrid(*[within] * d), axis=-1).reshape(-1, d)
    inside = np.linalg.norm(middles[:, None] + points, axis=2) < radius
    exact, means = inside.mean(axis=1), np.zeros(len(middles))
    means_in_ball(radius, middles, (0.0,) * d, means)
    cut = exact < 1.0
    assert means[cut].sum() == pytest.approx(exact[cut].sum(), rel=0.005)
