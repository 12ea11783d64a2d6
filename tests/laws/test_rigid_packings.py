"""Beds, outflow and collapse of rigid grains: hundreds of grains, statistical laws."""

import numpy as np
import pytest

from mesokit import Plates, RandomStart, Rectangle, SphereKind, theory
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel
from tests.helpers.rigid_grains import at_rest, from_walls, impulses, net_impulse, rigid

pytestmark = pytest.mark.long

MIXED = [SphereKind(1.0, spread=0.2)]
DOWN = [0.0, -1.0]


def fallen(size, number, friction, steps, seed=1, tolerance=1e-5):
    """A bed that has fallen into a bin."""
    engine = rigid(
        size, walls=[Plates("x"), Plates("y")], number=number, kinds=MIXED, gravity=DOWN, seed=seed,
        start=RandomStart(), contact={"friction": friction}, timestep=0.005,
        solver=GaussSeidel(sweeps=100, tolerance=tolerance),
    )  # fmt: skip
    engine.advance(steps)
    return engine


@pytest.mark.parametrize(("friction", "least", "most"), [(0.0, 3.88, 4.0), (0.5, 3.05, 3.45)])
def test_contacts_of_a_poured_bed(friction, least, most):
    """Isostatic without friction; between d + 1 and 2 d with it (an independent program: 3.28)."""
    engine = fallen([25, 50], 500, friction, 9000)
    pairs, found = impulses(engine)
    forces = np.linalg.norm(found, axis=1) / engine.timestep
    on, at_walls = forces > 1e-6, np.linalg.norm(from_walls(engine), axis=2) > 1e-9
    touching = np.bincount(pairs[on].ravel(), minlength=engine.n) + at_walls.sum(axis=1)
    held = touching >= 2
    assert held.mean() > 0.97
    z = (touching[held].sum() + at_walls[held].sum()) / held.sum()
    assert least < z < most + 0.02
    # forces balance on each grain, and all weight is on the walls
    left = net_impulse(engine) / engine.timestep + engine.masses()[:, None] * np.array(DOWN)
    assert np.abs(left[held]).max() < 1e-3
    weight = engine.masses().sum()
    carried = from_walls(engine).sum(axis=0)[:, 1] / engine.timestep / weight
    assert carried.sum() == pytest.approx(1.0, abs=1e-2)
    assert (abs(carried[2] - 1) < 1e-3) == (friction == 0.0)  # sides bear a part by friction
    # more small forces than large ones, and none far above the mean
    size = forces[on] / forces[on].mean()
    assert 0.5 < (size > 1).mean() * np.e < 1.6
    assert (size > 6).mean() < 0.01


def rate(opening, number=500, wide=22, floor=20.0):
    """Grains that leave a bin per time while a tenth to a half of them leave."""
    side = 0.5 * (wide - opening)
    walls = [
        Plates("x"), Plates("y"),
        Rectangle(centre=[0.5 * side - 0.5, floor - 0.5], size=[side + 1, 1]),
        Rectangle(centre=[wide - 0.5 * side + 0.5, floor - 0.5], size=[side + 1, 1]),
        Rectangle(centre=[0.5 * wide, floor - 0.5], size=[opening + 1, 1], opens=18.0),
    ]  # fmt: skip
    rng = np.random.default_rng(1)
    row, column = np.divmod(np.arange(number), 16)
    places = np.stack(
        [1.2 + 1.3 * column + rng.uniform(-0.02, 0.02, number), floor + 1 + 1.3 * row], 1
    )
    engine = rigid(
        [wide, 64], walls=walls, given=at_rest(places, velocities=rng.normal(0, 0.7, (number, 2))),
        kinds=MIXED, gravity=DOWN, contact={"friction": 0.5}, timestep=0.005,
        solver=GaussSeidel(sweeps=60, tolerance=1e-4),
    )  # fmt: skip
    engine.advance(3600)
    assert (engine.positions()[:, 1] > floor).all()
    times, left = [], []
    while not left or (left[-1] < 0.5 * number and engine.time < 120):
        engine.advance(50)
        times.append(engine.time)
        left.append((engine.positions()[:, 1] < floor - 1).sum())
    times, left = np.array(times), np.array(left)
    during = left > 0.1 * number
    return np.polyfit(times[during], left[during], 1)[0]


def test_grains_leave_a_bin_by_the_law_of_beverloo():
    """Rates^(2/3) are a line, which is 0 at some grain sizes (known: 8.95, 24.7)."""
    openings = np.array([6.0, 10.0])
    rates = np.array([rate(opening) for opening in openings])
    assert rates == pytest.approx([8.95, 24.7], rel=0.2)
    slope, zero = np.polyfit(openings, theory.beverloo_line(rates, 2), 1)
    assert 0.8 < -zero / slope < 2.8


def test_a_column_spreads_by_its_height():
    length = 16.0
    column = fallen([length, 40], 200, 0.5, 5000, tolerance=1e-4)
    places = column.positions()
    ratio = (np.sort(places[:, 1])[-8:].mean() + 0.5) / length
    heap = rigid(
        [70, 40], walls=[Plates("x"), Plates("y")], given=at_rest(places), kinds=MIXED,
        gravity=DOWN, contact={"friction": 0.5}, timestep=0.005, solver=GaussSeidel(sweeps=100),
    )  # fmt: skip
    np.testing.assert_array_equal(heap.diameters(), column.diameters())
    heap.advance(6000)
    x = np.sort(heap.positions()[:, 0])
    gaps = np.flatnonzero(np.diff(x) > 1.2)
    end = (x[gaps[0]] if len(gaps) else x[-1]) + 0.5
    assert (end - length) / length == pytest.approx(float(theory.run_out(ratio)), rel=0.25)
