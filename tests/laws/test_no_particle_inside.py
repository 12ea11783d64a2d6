"""No particle is ever inside a solid: every shape, every rule, short and long mean free paths."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers.shapes import EVERY, fluid_between, walls_in

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


@pytest.mark.parametrize(("case", "rule", "timestep"), list(runs()), ids=name_of)
def test_no_particle_is_inside(case, rule, timestep, tmp_path):
    d = case[1]
    fluid = fluid_between(walls_in(case, tmp_path), d, rule, timestep)
    while fluid.step < STEPS[d]:
        assert fluid.numbers.solids.distance(fluid.positions()).min() >= 0
        fluid.advance(LOOK)
    assert fluid.numbers.solids.distance(fluid.positions()).min() >= 0
    assert np.isfinite(fluid.velocities()).all()
