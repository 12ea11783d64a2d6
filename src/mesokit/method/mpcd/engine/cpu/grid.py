"""The collision cells: where they lie at a step, and which of them holds a place."""

from typing import NamedTuple

import numpy as np

from mesokit.scalar.intrinsics import floor, mul_add, with_item
from mesokit.scalar.jit import by_type, elementwise, scalar


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
    return _from_middle(grid.origin, r)


@elementwise
def _from_middle(origin, r):
    return "r[{k}] + origin[{k}] - floor(r[{k}] + origin[{k}]) - 0.5"


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
    index, cells = _joined_index(grid.cells, _cell_along(grid, r))
    return np.int32(index if (index >= 0.0) & (index < cells) else cells)


@elementwise
def _cell_along(grid, r):
    return "_cell_on_axis(r[{k}] + grid.origin[{k}], grid.cells[{k}], grid.inverse[{k}])"


@scalar
def _cell_on_axis(x, cells, inverse):
    """The cell of a coordinate in cells, in the primary box."""
    i = floor(x)
    # half a cell keeps the quotient away from whole numbers, where it might round either way
    return mul_add(-cells, floor(mul_add(i, inverse, 0.5 * inverse)), i)


@by_type
def _joined_index(cells, place):
    """The number of a cell from its place along each axis, and the number of all; axes are written
    out, for compilers of cards keep loops over them."""
    if len(place) == 2:
        return lambda cells, place: (
            mul_add(place[1], cells[0], place[0]),
            cells[0] * cells[1],
        )
    return lambda cells, place: (
        mul_add(mul_add(place[2], cells[1], place[1]), cells[0], place[0]),
        cells[2] * cells[1] * cells[0],
    )


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
