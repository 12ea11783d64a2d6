"""Virtual particles of the top-up rule: as many as are missing, each with numbers of its own."""

import numpy as np
import pytest
from laboratory import make_case
from numba import njit

from mesokit import AT, Plates
from mesokit.execute.cpu import CPU
from mesokit.execute.fixed_point import ROUNDER_BITS
from mesokit.execute.stages import Grid
from mesokit.execute.top_up import top_up
from mesokit.random import Counter

LENGTH, DENSITY = 400, 128.0

fill = njit(lambda *arguments: top_up(*arguments))


@pytest.fixture
def topped_up():
    """Sums (number and terms) of the lower cut cells of an empty slit, by the rule AT."""
    case = make_case(
        (LENGTH, 3), collision=AT(), density=1.0, walls=[Plates(axis="y", virtual="top-up")]
    )
    cpu = CPU(case)
    shift = (0.0, 0.5)
    grid = Grid(shift, shift, cpu.grid.cells, cpu.grid.inverse)
    fill(
        (DENSITY,), (), 0, cpu.physics, Counter(np.uint64(1), np.uint64(1)), grid, cpu.cell_arrays,
        cpu.number_of_cells, cpu.like, cpu.scales,
    )  # fmt: skip
    sums = cpu.sums[0].reshape(cpu.number_of_cells + 1, -1)[:LENGTH]
    number, own = sums[:, 0], sums[:, 3:5]
    return number, (own - number[:, None] * ROUNDER_BITS) / cpu.scales[2]


def test_cells_are_filled_to_the_mean_density(topped_up):
    assert abs(topped_up[0] - DENSITY).max() <= 1


def test_neighbouring_cells_share_no_random_numbers(topped_up):
    x = topped_up[1] / np.sqrt(DENSITY)
    for k in range(2):
        assert abs(x[:, k].var() - 1) < 0.3
        for distance in (1, 2):
            assert abs(np.corrcoef(x[distance:, k], x[:-distance, k])[0, 1]) < 4 / np.sqrt(LENGTH)
