"""Piles, slopes and chains of rigid grains beside statics, equations of motion and enumeration."""

import itertools
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import linprog

from mesokit import theory


def stands(base: int, mu: tuple[float, float], weight: float, spacing: float) -> bool:
    """Whether forces within all cones of friction balance a top grain on a ring of grains.

    Unknown are non-negative forces along the edges of a cone of each contact. Edges include the
    directions to the axis of the pile, in which the forces of a symmetric pile lie.
    """
    angle = 2 * math.pi * np.arange(base) / base
    ring = spacing / (2 * math.sin(math.pi / base))  # radius of the ring of centres, in diameters
    height = math.sqrt(1 - ring**2)
    centres = np.stack([ring * np.cos(angle), ring * np.sin(angle), 0 * angle], axis=-1)
    centres = np.vstack([centres, [0, 0, height]])
    up, columns = np.array([0.0, 0.0, 1.0]), []

    def contact(on: int, other: int | None, normal: np.ndarray, friction: float) -> None:
        """Force on one grain at its surface, and the opposite one on the other."""
        away = np.cross(normal, np.cross(centres[min(on, base - 1)] * [1, 1, 0], normal))
        if np.linalg.norm(away) < 1e-9:  # neighbours: along the vertical
            away = up - (up @ normal) * normal
        first = away / np.linalg.norm(away)
        second = np.cross(normal, first)
        for turn in np.arange(8) * math.pi / 4:
            force = normal + friction * (math.cos(turn) * first + math.sin(turn) * second)
            column = np.zeros((base + 1, 6))
            column[on] = np.concatenate([force, np.cross(-0.5 * normal, force)])
            if other is not None:
                column[other] = np.concatenate([-force, np.cross(0.5 * normal, -force)])
            columns.append(column.ravel())

    for i in range(base):
        contact(i, None, up, mu[1])
        contact(i, base, centres[i] - centres[base], mu[0])
        if spacing == 1 and (base > 2 or i == 0):
            contact(i, (i + 1) % base, centres[i] - centres[(i + 1) % base], mu[0])
    load = np.zeros((base + 1, 6))
    load[:, 2] = [1.0] * base + [weight]
    matrix = np.array(columns).T
    found = linprog(np.zeros(matrix.shape[1]), A_eq=matrix, b_eq=load.ravel(), method="highs")
    return found.status == 0


@pytest.mark.parametrize(
    ("base", "weight", "spacing"), [(2, 1.0, 1.0), (3, 1.0, 1.0), (2, 3.0, 1.2), (4, 0.5, 1.1)]
)
def test_piles_stand_from_their_friction_on(base, weight, spacing):
    grains, floor = theory.pile_friction(base, weight, spacing)
    more, less = 1 + 1e-5, 1 - 1e-5
    assert stands(base, (grains * more, floor * more), weight, spacing)
    assert not stands(base, (grains * less, 1.0), weight, spacing)
    assert not stands(base, (1.0, floor * less), weight, spacing)


def test_piles_of_three_disks_and_four_spheres():
    three, four = 2 - math.sqrt(3), math.sqrt(3) - math.sqrt(2)
    assert theory.pile_friction(2) == pytest.approx((three, three / 3))
    assert theory.pile_friction(3) == pytest.approx((four, four / 4))


def smooth_slope(angle, friction, gravity, kappa, speed, time):
    """Velocity, spin times radius and distance by the equations of motion.

    Friction is mu N tanh(slip/small): Coulomb's law without the jump.
    """

    def right(t, y):
        force = -friction * gravity * math.cos(angle) * math.tanh((y[0] - y[1]) / 1e-5)
        return [gravity * math.sin(angle) + force, -force / kappa, y[0]]

    found = solve_ivp(right, (0, time), [speed, 0.0, 0.0], "LSODA", rtol=1e-9, atol=1e-10)
    return found.y[:, -1]


@pytest.mark.parametrize("kappa", [0.4, 0.5])
@pytest.mark.parametrize(("friction", "rolls"), [(0.5, True), (0.1, False)])
def test_slope_beside_equations_of_motion(kappa, friction, rolls):
    angle = math.radians(35)
    known = theory.down_slope(angle, friction, 2.0, kappa)
    speed, spin, _ = smooth_slope(angle, friction, 2.0, kappa, 0.0, 3.0)
    assert known.rolls == rolls
    assert (3 * known.acceleration, 3 * known.spin) == pytest.approx((speed, spin), rel=3e-5)


def test_block_on_a_slope():
    """It stays up to atan(mu), and slides with g (sin - mu cos) above."""
    steep = math.atan(0.3)
    assert theory.down_slope(steep - 1e-9, 0.3, 2.0, math.inf) == (0.0, True, 0.0)
    known = theory.down_slope(0.5, 0.3, 2.0, math.inf)
    assert known == pytest.approx((2 * (math.sin(0.5) - 0.3 * math.cos(0.5)), False, 0.0))


@pytest.mark.parametrize("time", [0.5, 4.0])
def test_thrown_ball_beside_equations_of_motion(time):
    known = theory.slide_to_roll(time, 1.5, 0.3, 2.0, 0.4)
    solved = smooth_slope(0.0, 0.3, 2.0, 0.4, 1.5, time)
    assert [float(value) for value in known] == pytest.approx(solved, rel=3e-5)
    assert 0.5 < theory.end_of_sliding(1.5, 0.3, 2.0, 0.4).time < 4.0


def by_enumeration(velocity, restitution, mass):
    """Velocities after: the one set of pressing contacts that breaks no condition."""
    count = len(velocity) - 1
    least = restitution * np.maximum(-np.diff(velocity), 0.0)
    gap = np.diff(np.eye(count + 1), axis=0)
    found = []
    for chosen in itertools.product([False, True], repeat=count):
        on = np.array(chosen)
        impulse = np.zeros(count)
        delassus = gap @ np.diag(1 / mass) @ gap.T
        if on.any():
            wanted = (least - gap @ velocity)[on]
            impulse[on] = np.linalg.solve(delassus[np.ix_(on, on)], wanted)
        after = velocity + gap.T @ impulse / mass
        if impulse.min() > -1e-12 and (gap @ after - least).min() > -1e-12:
            found.append(after)
    return found


@pytest.mark.parametrize("restitution", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("seed", range(4))
def test_touching_chain_beside_all_sets_of_contacts(restitution, seed):
    rng = np.random.default_rng(seed)
    velocity, mass = rng.normal(size=7), rng.uniform(0.3, 3.0, 7)
    after = theory.touching_chain(velocity, restitution, mass)
    solutions = by_enumeration(velocity, restitution, mass)
    assert after == pytest.approx(solutions[0], abs=1e-10)
    assert mass @ after == pytest.approx(mass @ velocity)


@pytest.mark.parametrize("restitution", [0.0, 0.6, 1.0])
def test_cradle_by_the_law_of_newton(restitution):
    hit = theory.touching_chain([1.0, 0, 0, 0, 0, 0], restitution)
    others = (1 + restitution) / 6
    assert hit == pytest.approx([others - restitution, *[others] * 5])
    energy = (hit**2).sum()
    assert energy == pytest.approx(1 - (1 - restitution**2) * 5 / 6)
    apart = theory.touching_chain([-1.0, 0.5, 2.0], restitution)
    assert apart.tolist() == [-1.0, 0.5, 2.0]


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: theory.pile_friction(1), "base = 1"),
        (lambda: theory.pile_friction(6), "base = 6, spacing = 1"),
        (lambda: theory.pile_friction(2, 1.0, 0.9), "base = 2, spacing = 0.9"),
        (lambda: theory.pile_friction(2, 0.0), "weight = 0.0"),
        (lambda: theory.down_slope(0.1, 0.5, 1.0, 0.0), "kappa = 0.0"),
        (lambda: theory.slide_to_roll(-1.0, 1.0, 0.5, 1.0, 0.4), "time = -1"),
        (lambda: theory.slide_to_roll(1.0, 1.0, 0.0, 1.0, 0.4), "friction = 0.0"),
        (lambda: theory.touching_chain([1.0, 0.0], 1.1), "restitution = 1.1"),
        (lambda: theory.touching_chain([1.0, 0.0], 1.0, [1.0, 0.0]), "mass = 0"),
        (lambda: theory.touching_chain([1.0, 0.0], 1.0, [1.0]), "mass of 1 grains"),
        (lambda: theory.touching_chain([math.nan], 1.0), r"velocity = \[nan\]"),
    ],
)
def test_numbers_out_of_range_are_refused(call, said):
    with pytest.raises(ValueError, match=f"^{said}: expected "):
        call()
