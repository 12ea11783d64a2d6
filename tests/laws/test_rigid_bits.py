"""Runs of rigid grains give the same bits on any threads, after any stop, and with any lists."""

import numpy as np
import pytest

from mesokit import Plates, RandomStart, Rectangle, SphereKind, Surface
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel
from mesokit.method.spheres.rigid.solver.jacobi import Jacobi
from tests.helpers.rigid_grains import rigid, same

MIXED = [SphereKind(1.0, spread=0.3)]
ALL = {
    "friction": 0.5, "restitution": 0.2, "rolling": 0.1, "cohesion": {"force": 0.4, "range": 0.02},
}  # fmt: skip
SOLVERS = {
    "coloured": GaussSeidel(sweeps=4),
    "random": GaussSeidel("random", sweeps=4),
    "ordered": GaussSeidel("ordered", sweeps=4),
    "jacobi": Jacobi(relaxation=0.4, sweeps=4),
}


def bed(dimension=2, solver="coloured", threads=1, skin=None, **given):
    """Grains that fall on a floor that moves along itself."""
    contact = ALL | ({"rolling": 0.0} if solver == "jacobi" else {})
    size = [10.0, 8.0] if dimension == 2 else [5.0, 5.0, 5.0]
    moving = Surface(velocity=[0.5] + [0.0] * (dimension - 1))
    return rigid(
        size, walls=[Plates("xyz"[dimension - 1], lower=moving)], number=50, kinds=MIXED, kT=0.5,
        gravity=[0.0] * (dimension - 1) + [-1.0], start=RandomStart(), contact=contact,
        timestep=0.01, solver=SOLVERS[solver], threads=threads, skin=skin, push_back=0.05, **given,
    )  # fmt: skip


def among_solids(threads=1, skin=None, **_):
    """Grains that fall on a block."""
    return rigid(
        [12, 10], walls=[Plates("y"), Rectangle(centre=[6, 2], size=[7, 3], angle=20)], number=50,
        kinds=MIXED, kT=0.5, gravity=[0.0, -1.0], start=RandomStart(), contact=ALL, timestep=0.01,
        solver=SOLVERS["coloured"], threads=threads, skin=skin,
    )  # fmt: skip


def sheared(threads=1, skin=None, **_):
    """A dense gas in a sheared box."""
    return rigid(
        [9.0, 8.0], number=60, kinds=[SphereKind(1.0, spread=0.2)], kT=0.1, start=RandomStart(),
        contact=ALL, timestep=0.01, solver=SOLVERS["coloured"], threads=threads, skin=skin,
        box={"shear_rate": 0.4},
    )  # fmt: skip


def assert_same_contacts(one, other):
    """Fail unless the contacts of two engines have the same bits."""
    first, second = one.contacts(), other.contacts()
    assert len(first.pairs) > 10
    for a, b in zip(first, second, strict=True):
        np.testing.assert_array_equal(a, b)


SYSTEMS = {
    "2D": bed, "3D": lambda **given: bed(3, **given), "solids": among_solids, "sheared": sheared,
}  # fmt: skip


@pytest.mark.parametrize("solver", list(SOLVERS))
def test_threads_change_no_bit_with_any_solver(solver):
    one, three = (bed(2, solver, threads) for threads in (1, 3))
    for engine in (one, three):
        engine.advance(150)
    assert same(one, three)
    assert len(one.state()["pairs"]) > 10


@pytest.mark.parametrize("system", ["3D", "solids", "sheared"])
def test_threads_change_no_bit(system):
    one, two = (SYSTEMS[system](threads=threads) for threads in (1, 2))
    for engine in (one, two):
        engine.advance(150)
    assert same(one, two)
    assert len(one.state()["pairs"]) > 10


@pytest.mark.parametrize("system", list(SYSTEMS))
def test_a_run_goes_on_from_any_step_to_the_same_bits(system):
    whole, parts, states = SYSTEMS[system](), [57, 1, 60, 32], []
    for steps in parts:
        states.append(whole.state())
        whole.advance(steps)
    for k, state in enumerate(states):
        again = SYSTEMS[system](threads=1 + k % 2)
        again.restore({name: array.copy() for name, array in state.items()})
        again.advance(sum(parts[k:]))
        assert same(again, whole)
        assert_same_contacts(again, whole)
        assert again.lost == whole.lost
        np.testing.assert_array_equal(again.wall_impulse, whole.wall_impulse)


@pytest.mark.parametrize("system", list(SYSTEMS))
def test_how_far_lists_go_changes_no_bit(system):
    usual = SYSTEMS[system]()
    usual.advance(150)
    for skin in (0.13, 0.5):
        other = SYSTEMS[system](skin=skin)
        other.advance(150)
        assert same(usual, other)
        assert_same_contacts(usual, other)


def test_a_random_order_is_one_of_the_seed():
    one, same_seed, another = (bed(2, "random", seed=seed) for seed in (1, 1, 2))
    another.restore(one.state())
    for engine in (one, same_seed, another):
        engine.advance(100)
    assert same(one, same_seed)
    assert not same(one, another)


def test_the_end_of_a_warm_up_changes_no_motion():
    one, two = bed(), bed()
    for engine in (one, two):
        engine.advance(100)
    two.end_warmup()
    assert not two.wall_impulse.any()
    assert not any(two.lost.values())
    for engine in (one, two):
        engine.advance(100)
    np.testing.assert_array_equal(one.positions(), two.positions())
    assert sum(one.lost.values()) > sum(two.lost.values())
