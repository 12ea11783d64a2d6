"""One or a few rigid grains, in closed form: columns, slopes, bounces, piles and rows."""

import math

import numpy as np
import pytest

from mesokit import Plates, SphereKind, Surface, SurfaceContact, theory
from tests.helpers.rigid_grains import at_rest, exact, from_walls, pushes, rigid

KAPPA = {2: 1 / 2, 3: 2 / 5}  # moment of inertia over m r^2
G = 1.0


def on_floor(dimension, angle=0.0, lower=None, speed=0.0, timestep=0.01, **contact):
    """A grain on a floor along x that is inclined by an angle, and goes down along it."""
    others = [5.0] * (dimension - 2)
    none = [0.0] * (dimension - 2)
    return rigid(
        [60.0, *others, 5.0],
        walls=[Plates("xyz"[dimension - 1], **({} if lower is None else {"lower": lower}))],
        given=at_rest([[5.0, *(0.5 * x for x in others), 0.5]], velocities=[[speed, *none, 0.0]]),
        gravity=[G * math.sin(angle), *none, -G * math.cos(angle)],
        contact=contact, timestep=timestep, solver=exact(),
    )  # fmt: skip


def surface_speed(engine):
    """How fast the surface at the floor moves back along x by the spin."""
    spins = engine.spins()
    return 0.5 * (-spins[0] if spins.ndim == 1 else spins[0, 1])


# --- a column -----------------------------------------------------------------------------------


@pytest.mark.parametrize("order", ["coloured", "ordered", "random"])
def test_each_grain_of_a_column_carries_those_above(order):
    n = 20
    engine = rigid(
        [8, 30], walls=[Plates("y")], given=at_rest([[4.0, 0.5 + i] for i in range(n)]),
        gravity=[0.0, -G], timestep=0.01, contact={"friction": 0.5},
        solver=exact(order, sweeps=100_000),
    )  # fmt: skip
    engine.advance(50)
    assert pushes(engine) == pytest.approx(G * (n - 1 - np.arange(n - 1)), rel=1e-6)
    floor = from_walls(engine)[0, 0, 1] / engine.timestep
    assert floor == pytest.approx(n * G, rel=1e-6)
    # what walls have taken is the weight times the time, less the momentum gained
    taken = engine.wall_impulse[0] - engine.totals()[1]
    assert taken == pytest.approx([0.0, -n * G * engine.time], abs=1e-9 * n * engine.time)


# --- friction on a floor ------------------------------------------------------------------------


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("over", [0.5, 0.98, 1.02, 2.0])
def test_a_grain_rolls_down_a_slope_or_slides(dimension, over):
    kappa, friction = KAPPA[dimension], 0.2
    angle = math.atan(over * friction * (1 + 1 / kappa))
    expected = theory.down_slope(angle, friction, G, kappa)
    engine = on_floor(dimension, angle, friction=friction)
    engine.advance(200)
    t = engine.time
    assert expected.rolls == (over < 1)
    assert engine.velocities()[0, 0] == pytest.approx(expected.acceleration * t, rel=1e-9)
    assert surface_speed(engine) == pytest.approx(expected.spin * t, rel=1e-9)
    assert np.abs(engine.velocities()[0, 1:]).max() < 1e-12


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("belt", [0.0, 2.0])
def test_what_slides_on_a_floor_ends_in_rolling(dimension, belt):
    # on a belt all is as on a floor at rest, seen from the belt, with a spin of none
    kappa, friction, slip = KAPPA[dimension], 0.2, 1.0 - belt
    lower = Surface(velocity=[belt, *[0.0] * (dimension - 1)])
    engine = on_floor(dimension, lower=lower, speed=1.0, friction=friction)
    speeds, spins, times = [], [], []
    for _ in range(60):
        engine.advance(5)
        times.append(engine.time)
        speeds.append(engine.velocities()[0, 0])
        spins.append(surface_speed(engine))
    known = theory.slide_to_roll(times, abs(slip), friction, G, kappa)
    sign = math.copysign(1.0, slip)
    assert speeds == pytest.approx(belt + sign * known.speed, abs=1e-9)
    assert spins == pytest.approx(sign * known.spin, abs=1e-9)
    assert theory.end_of_sliding(abs(slip), friction, G, kappa).time < 0.6 * times[-1]


@pytest.mark.parametrize(
    ("lower", "friction"),
    [
        (Surface(), 0.5),
        (Surface(contact=SurfaceContact(friction=0.1)), 0.1),
        (Surface(rule="slip"), 0.0),
    ],
)
def test_a_wall_has_a_friction_of_its_own(lower, friction):
    engine = on_floor(2, lower=lower, speed=5.0, friction=0.5)
    engine.advance(200)
    assert engine.velocities()[0, 0] == pytest.approx(5.0 - friction * G * engine.time, abs=1e-9)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("over", [0.9, 1.1, 2.0])
def test_resistance_to_rolling_holds_up_to_its_coefficient(dimension, over):
    # (1 + kappa) a = g (sin - mu_r cos); none where tan < mu_r
    rolling = 0.25
    angle = math.atan(over * rolling)
    engine = on_floor(dimension, angle, friction=5.0, rolling=rolling)
    engine.advance(200)
    pull = G * (math.sin(angle) - rolling * math.cos(angle)) / (1 + KAPPA[dimension])
    expected = max(pull, 0.0) * engine.time
    assert engine.velocities()[0, 0] == pytest.approx(expected, abs=1e-9)
    assert surface_speed(engine) == pytest.approx(expected, abs=1e-9)


# --- bounces ------------------------------------------------------------------------------------


def error_of_fifth_apex(timestep, restitution=0.8, bounces=5):
    """Of the height after some bounces over that of an exact fall, less 1."""
    first = math.sqrt(2 / G)  # of the fall from height 1
    ends = first * (1 + 2 * sum(restitution**k for k in range(1, bounces)))
    apex = ends + first * restitution**bounces
    engine = rigid(
        [4.0, 4.0], walls=[Plates("y")], given=at_rest([[2.0, 1.5]]), gravity=[0.0, -G],
        timestep=timestep, contact={"friction": 0.0, "restitution": restitution},
    )  # fmt: skip
    engine.advance(round(apex / timestep))
    height = engine.positions()[0, 1] - 0.5
    speed = engine.velocities()[0, 1]
    # in flight y + v^2/2g + v dt/2 is kept exactly
    height += 0.5 * speed**2 / G + 0.5 * speed * timestep
    return height / restitution ** (2 * bounces) - 1


def test_bounces_fall_by_the_square_of_the_restitution_to_first_order_in_the_step():
    coarse, fine = abs(error_of_fifth_apex(1e-3)), abs(error_of_fifth_apex(1e-4))
    assert coarse < 0.01
    assert fine < coarse / 5


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_two_collide_by_the_law_of_newton(restitution):
    kinds = [SphereKind(1.0, mass=1.0), SphereKind(2.0, mass=3.0)]
    engine = rigid(
        [20.0, 12.0], given=at_rest([[5.0, 6.0], [6.523, 6.0]], velocities=[[1.0, 0], [-0.2, 0]]),
        number=2, kinds=kinds, contact={"restitution": restitution}, timestep=0.01,
    )  # fmt: skip
    engine.advance(50)
    common, closing = (1.0 - 3 * 0.2) / 4, 1.2
    expected = [common - restitution * closing * 3 / 4, common + restitution * closing / 4]
    assert engine.velocities()[:, 0] == pytest.approx(expected, abs=1e-12)
    lost = 0.5 * 0.75 * closing**2 * (1 - restitution**2)
    assert engine.lost["impact"] == pytest.approx(lost, abs=1e-10)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("spins", [(30.0, 15.0), (-20.0, 0.0), (0.4, -0.2), (0.0, 0.1)])
def test_two_rough_ones_slip_or_stick(dimension, spins):
    # impulse along the surface: what ends the slip, m_n slip/(1 + 1/kappa), at most 2 mu m_n v
    friction, mass, kappa = 0.1, 0.75, KAPPA[dimension]
    kinds = [SphereKind(1.0, mass=1.0), SphereKind(2.0, mass=3.0)]
    places, velocities = [[5.0, 6.0], [6.505, 6.0]], [[0.75, 0.0], [-0.25, 0.0]]
    turned = np.array(spins)
    if dimension == 3:
        places, velocities = (
            [[*row, z] for row in rows] for rows, z in ((places, 6.0), (velocities, 0.0))
        )
        turned = np.outer(spins, [0.0, 0.0, 1.0])
    engine = rigid(
        [12.0] * dimension, given=at_rest(places, velocities=velocities, spins=turned),
        kinds=kinds, number=2, contact={"restitution": 1.0, "friction": friction}, timestep=0.01,
        solver=exact(),
    )  # fmt: skip
    engine.advance(5)
    slip = 0.5 * spins[0] + 1.0 * spins[1]
    drag = math.copysign(min(abs(slip) * mass / (1 + 1 / kappa), 2 * friction * mass), slip)
    change = engine.spins().reshape(2, -1)[:, -1] - np.array(spins)
    levers = np.array([0.5, 1.0]) / (kappa * np.array([0.25, 3.0]))
    assert change == pytest.approx(-drag * levers, abs=1e-9)
    assert engine.velocities()[:, 1] == pytest.approx([-drag, drag / 3], abs=1e-9)
    assert engine.velocities()[:, 0] == pytest.approx([-0.75, 0.25], abs=1e-9)


# --- rows ---------------------------------------------------------------------------------------


def row_of(gap, restitution, n=5):
    places = [[3.0 + 0.5 * gap + (1 + gap) * i, 4.0] for i in range(n)]
    velocities = [[1.0, 0.0]] + [[0.0, 0.0]] * (n - 1)
    engine = rigid(
        [24.0, 8.0], given=at_rest(places, velocities=velocities), timestep=0.003,
        contact={"friction": 0.0, "restitution": restitution}, solver=exact(),
    )  # fmt: skip
    engine.advance(400)
    return engine.velocities()[:, 0]


def test_of_a_row_with_gaps_only_the_last_moves_on():
    assert row_of(0.1, 1.0) == pytest.approx([0, 0, 0, 0, 1.0], abs=1e-6)


@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
def test_a_touching_row_is_hit_in_all_contacts_at_once(restitution):
    # a known artefact of Newton's law for contacts at the same time
    expected = theory.touching_chain([1.0, 0, 0, 0, 0], restitution)
    assert row_of(0.0, restitution) == pytest.approx(expected, abs=1e-6)


# --- piles --------------------------------------------------------------------------------------


def speed_of_pile(dimension, friction, floor):
    """The largest speed in the smallest pile after a while."""
    if dimension == 2:
        places = [[6.0, 0.5], [7.0, 0.5], [6.5, 0.5 + math.sqrt(3) / 2]]
    else:
        angles = 2 * math.pi * np.arange(3) / 3
        base = np.stack([np.cos(angles), np.sin(angles), 0 * angles], 1) / math.sqrt(3)
        places = np.array([6.0, 6.0, 0.5]) + [*base, [0, 0, math.sqrt(2 / 3)]]
    lower = Surface(contact=SurfaceContact(friction=floor))
    engine = rigid(
        [12.0] * (dimension - 1) + [5.0], walls=[Plates("xyz"[dimension - 1], lower=lower)],
        given=at_rest(places), gravity=[0.0] * (dimension - 1) + [-G], timestep=0.01,
        contact={"friction": friction}, solver=exact(tolerance=1e-10),
    )  # fmt: skip
    engine.advance(100)
    return float(np.abs(engine.velocities()).max())


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_smallest_pile_stands_at_its_friction_and_not_below(dimension):
    least = theory.pile_friction(dimension)  # of a base of two disks, or three spheres
    stands = speed_of_pile(dimension, 1.01 * least.grains, 1.01 * least.floor)
    sinks = speed_of_pile(dimension, 0.99 * least.grains, 1.01 * least.floor)
    slides = speed_of_pile(dimension, 1.01 * least.grains, 0.99 * least.floor)
    assert stands < 1e-6
    assert sinks > 1e-3
    assert slides > 1e-3
