"""The collision cells: where they lie at a step, and which of them holds a place."""

from typing import NamedTuple

import numpy as np

from mesokit.scalar.intrinsics import floor, mul_add, with_item
from mesokit.scalar.jit import scalar


class Grid(NamedTuple):
    """The collision cells of one step."""

    shift: tuple  # added to positions, in cells
    origin: tuple  # the same, plus 1 along an axis where a wall's cell comes first
    cells: tuple  # number along each axis
    inverse: tuple


@scalar
def moved_grid(grid, shift, closed):
    """The cells for this shift; a wall's first cell lies below 0 where the shift is negative."""
    origin = shift
    for k in range(len(shift)):
        below = closed[k] > 0.5 and shift[k] < 0.0
        origin = with_item(origin, k, shift[k] + (1.0 if below else 0.0))
    return Grid(shift, origin, grid.cells, grid.inverse)


@scalar
def in_cell(r, grid):
    """Position relative to the centre of its cell."""
    for k in range(len(r)):
        x = r[k] + grid.origin[k]
        r = with_item(r, k, x - floor(x) - 0.5)
    return r


@scalar
def cell_index(r, grid):
    """Number of the cell at r; x varies fastest. A place that is no number gets the spare cell."""
    index, cells = 0.0, 1.0
    for j in range(len(r)):
        k = len(r) - 1 - j
        i = floor(r[k] + grid.origin[k])
        # half a cell keeps the quotient away from whole numbers, where it might round either way
        images = floor(mul_add(i, grid.inverse[k], 0.5 * grid.inverse[k]))
        index = mul_add(index, grid.cells[k], mul_add(-grid.cells[k], images, i))
        cells *= grid.cells[k]
    return np.int32(index if (index >= 0.0) & (index < cells) else cells)
