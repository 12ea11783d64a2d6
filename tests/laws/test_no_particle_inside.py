"""No particle is ever inside a solid: every shape, every rule, short and long mean free paths."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import MaxwellBoltzmann, Surface, Uniform
from tests.helpers.shapes import EVERY, SIZE, example, walls_of, with_surface
from tests.helpers.small_fluids import make_fluid

pytestmark = pytest.mark.long

RULES = ("no-slip", "slip", "diffuse")
STEPS = {2: 200, 3: 75}
LOOK = 25  # steps between looks


def runs():
    """Every shape, side and dimension with two rules or three, such that its two sides have all.

    Both timesteps come with each of them and with every rule.
    """
    for k, (name, d, side) in enumerate(EVERY):
        alone = (name, d, "inside") not in EVERY
        for j in range(3 if alone else 2):
            yield (name, d, side), RULES[(k + j) % 3], (0.1, 1.0)[(k + j) % 2]


def name_of(value):
    """A shape by its name, dimension and side."""
    return "-".join(map(str, value)) if isinstance(value, tuple) else str(value)


def walls_in(case, folder):
    """Walls of the example of a shape."""
    name, d, side = case
    return walls_of(example(name, d, side, folder), d)


def fluid_between(walls, d, rule, timestep, threads=1, seed=1):
    """A driven fluid between the walls, which has them measured."""
    walls = tuple(with_surface(wall, Surface(rule)) for wall in walls)
    push = (0.05, *(0.0,) * (d - 1))
    return make_fluid(
        SIZE[d], density=4.3, walls=walls, timestep=timestep, thermostat=MaxwellBoltzmann(),
        force=Uniform(push), measures=("walls",), threads=threads, seed=seed,
    )  # fmt: skip


@pytest.mark.parametrize(("case", "rule", "timestep"), list(runs()), ids=name_of)
def test_no_particle_is_inside(case, rule, timestep, tmp_path):
    d = case[1]
    fluid = fluid_between(walls_in(case, tmp_path), d, rule, timestep)
    while fluid.step < STEPS[d]:
        assert fluid.numbers.solids.distance(fluid.positions()).min() >= 0
        fluid.advance(LOOK)
    assert fluid.numbers.solids.distance(fluid.positions()).min() >= 0
    assert np.isfinite(fluid.velocities()).all()


def fingerprint(fluid):
    """What must be the same to the last bit."""
    fluid.advance(0)
    momentum = fluid.memory.fluid.taken.impulse.sum(axis=0)
    return fluid.positions(), fluid.velocities(), fluid.images(), momentum, fluid.memory.wall_rates


@pytest.mark.parametrize(
    ("case", "rule"), [(case, RULES[k % 3]) for k, case in enumerate(EVERY)], ids=name_of
)
def test_the_same_bits_for_any_threads_and_division_of_the_steps(case, rule, tmp_path):
    d, walls = case[1], walls_in(case, tmp_path)
    steps = STEPS[d] // 5
    reference = fluid_between(walls, d, rule, 0.3)
    reference.advance(steps)
    expected = fingerprint(reference)
    for threads, cut in ((2, steps), (3, 7)):
        fluid = fluid_between(walls, d, rule, 0.3, threads)
        while fluid.step < steps:
            fluid.advance(min(cut, steps - fluid.step))
            fluid.totals()
        for a, b in zip(fingerprint(fluid), expected, strict=True):
            np.testing.assert_array_equal(a, b)
