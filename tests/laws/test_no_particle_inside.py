"""No particle is ever inside a solid: every shape, every rule, short and long mean free paths."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import make_fluid
from shapes import EVERY, SIZE, example, walls_of, with_surface

from mesokit import MaxwellBoltzmann, Surface, Uniform

pytestmark = pytest.mark.long

RULES = ("no-slip", "slip", "diffuse")
STEPS = {2: 200, 3: 75}
LOOK = 25  # steps between looks


@pytest.fixture(scope="module", params=EVERY, ids=lambda case: "-".join(map(str, case)))
def walled(request, tmp_path_factory):
    """Dimension and walls of every shape, on both sides."""
    name, d, side = request.param
    return d, walls_of(example(name, d, side, tmp_path_factory.getbasetemp()), d)


def fluid_between(walls, d, rule, timestep, threads=1, seed=1):
    """A driven fluid between the walls, which has them measured."""
    walls = tuple(with_surface(wall, Surface(rule)) for wall in walls)
    push = (0.05, *(0.0,) * (d - 1))
    return make_fluid(
        SIZE[d], density=4.3, walls=walls, timestep=timestep, thermostat=MaxwellBoltzmann(),
        force=Uniform(push), measures=("walls",), threads=threads, seed=seed,
    )  # fmt: skip


@pytest.mark.parametrize("timestep", [0.1, 1.0])
@pytest.mark.parametrize("rule", RULES)
def test_nobody_is_inside(walled, rule, timestep):
    d, walls = walled
    fluid = fluid_between(walls, d, rule, timestep)
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


@pytest.mark.parametrize("rule", RULES)
def test_the_same_bits_for_any_threads_and_division_of_the_steps(walled, rule):
    d, walls = walled
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
