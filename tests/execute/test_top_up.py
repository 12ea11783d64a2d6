"""Virtual particles of the top-up rule: as many as are missing, each with numbers of its own."""

import numpy as np
import pytest
from numba import njit

from mesokit import AT, Plates
from mesokit.loops.threads import Worker
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.engine.cpu.groups import Now
from mesokit.method.mpcd.engine.virtual.one_by_one import top_up_walls
from mesokit.scalar.fixed_point import ROUNDER_BITS
from mesokit.scalar.random import Counter
from tests.helpers.small_fluids import make_case

LENGTH, DENSITY = 400, 128.0

fill = njit(lambda *arguments: top_up_walls(*arguments))


@pytest.fixture
def topped_up():
    """Sums (number and terms) of the lower cut cells of an empty slit, by the rule AT."""
    case = make_case(
        (LENGTH, 3), collision=AT(), density=DENSITY, walls=[Plates(axis="y", virtual="top-up")]
    )
    cpu = CPU(case)
    memory, number = cpu.memory, cpu.numbers.number_of_cells
    grid = memory.grid._replace(shift=(0.0, 0.5), origin=(0.0, 0.5))
    now = Now(Counter(np.uint64(1), np.uint64(1)), memory.box, memory.grid, grid, 0)
    alone = Worker(0, 1, np.zeros(1, np.int64), np.zeros(1, np.int64))
    fill(alone, now, memory.physics, memory.fluid, memory.walls)
    sums = memory.fluid.cells.sums[0].reshape(number + 1, -1)[:LENGTH]
    number, own = sums[:, 0], sums[:, 3:5]
    return number, (own - number[:, None] * ROUNDER_BITS) / memory.physics.scales[2]


def test_cells_are_filled_to_the_mean_density(topped_up):
    assert abs(topped_up[0] - DENSITY).max() <= 1


def test_neighbouring_cells_share_no_random_numbers(topped_up):
    x = topped_up[1] / np.sqrt(DENSITY)
    for k in range(2):
        assert abs(x[:, k].var() - 1) < 0.3
        for distance in (1, 2):
            assert abs(np.corrcoef(x[distance:, k], x[:-distance, k])[0, 1]) < 4 / np.sqrt(LENGTH)
