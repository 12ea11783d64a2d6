"""The collision cells: where they lie at a step, and which of them holds a place."""

from typing import NamedTuple

import numpy as np

from mesokit.scalar.intrinsics import floor, mul_add, with_item
from mesokit.scalar.jit import by_type, scalar


class Grid(NamedTuple):
    """The collision cells of one step."""

    shift: tuple  # added to positions, in cells
    origin: tuple  # the same, plus 1 along an axis where a wall's cell comes first
    cells: tuple  # number along each axis
    inverse: tuple


class Part(NamedTuple):
    """The cells of one step that a rank holds, a block of those of the box: its own and some around
    them."""

    shift: tuple
    origin: tuple
    cells: tuple  # number along each axis in the whole box
    inverse: tuple
    first: tuple  # the first held cell along each axis; below 0 across an end of the box
    known: tuple  # number of held cells along each axis


@scalar
def moved_grid(grid, shift, closed):
    """The cells for this shift; a wall's first cell lies below 0 where the shift is negative."""
    origin = shift
    for k in range(len(shift)):
        below = closed[k] > 0.5 and shift[k] < 0.0
        origin = with_item(origin, k, shift[k] + (1.0 if below else 0.0))
    return placed(grid, shift, origin)


@by_type
def placed(grid, shift, origin):
    """The same cells with another shift."""
    if grid.instance_class is Grid:
        return lambda grid, shift, origin: Grid(shift, origin, grid.cells, grid.inverse)
    return lambda grid, shift, origin: Part(
        shift, origin, grid.cells, grid.inverse, grid.first, grid.known
    )


@scalar
def in_cell(r, grid):
    """Position relative to the centre of its cell."""
    for k in range(len(r)):
        x = r[k] + grid.origin[k]
        r = with_item(r, k, x - floor(x) - 0.5)
    return r


@scalar
def cell_in_box(r, grid):
    """Place along each axis, in the whole box, of the cell at r."""
    for k in range(len(r)):
        i = floor(r[k] + grid.origin[k])
        images = floor((i + 0.5) * grid.inverse[k])
        r = with_item(r, k, i - images * grid.cells[k])
    return r


@scalar
def in_block(limits, place):
    """Whether a cell, by its place along each axis, lies in the block with these limits."""
    inside = True
    for k in range(len(place)):
        inside &= (limits[0][k] <= place[k]) & (place[k] < limits[1][k])
    return inside


@by_type
def cell_index(r, grid):
    """Number of the cell at r; x varies fastest. A place that is no number gets the spare cell, and
    so does a place in a cell that a rank does not hold."""
    return _in_box if grid.instance_class is Grid else _in_part


def _in_box(r, grid):
    index, cells = 0.0, 1.0
    for j in range(len(r)):
        k = len(r) - 1 - j
        i = floor(r[k] + grid.origin[k])
        # half a cell keeps the quotient away from whole numbers, where it might round either way
        images = floor(mul_add(i, grid.inverse[k], 0.5 * grid.inverse[k]))
        index = mul_add(index, grid.cells[k], mul_add(-grid.cells[k], images, i))
        cells *= grid.cells[k]
    return np.int32(index if (index >= 0.0) & (index < cells) else cells)


def _in_part(r, grid):
    index, cells, known = 0.0, 1.0, True
    for j in range(len(r)):
        k = len(r) - 1 - j
        i = floor(r[k] + grid.origin[k]) - grid.first[k]
        images = floor(mul_add(i, grid.inverse[k], 0.5 * grid.inverse[k]))
        i = mul_add(-grid.cells[k], images, i)
        index = mul_add(index, grid.known[k], i)
        known &= (i >= 0.0) & (i < grid.known[k])
        cells *= grid.known[k]
    return np.int32(index if known else cells)
