"""Cells of a box: which one a place is in, and which ones are around it.

`grid` has `cells` (d,), their number along each axis, and `inverse` (d,), their number per length;
`box` has `size` (d,) and `inverse` (d,), one over each length, 0 along axes that walls close.
"""

from typing import NamedTuple

from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import elementwise, scalar

NOWHERE = -1  # no cell, beyond a wall


class Grid(NamedTuple):
    """Cells and nothing else."""

    cells: tuple[int, ...]
    inverse: tuple[float, ...]


@scalar
def cell_along(grid, k, x):
    """Number of the cell along an axis of a coordinate in the box."""
    return min(max(int(floor(x * grid.inverse[k])), 0), grid.cells[k] - 1)


@elementwise
def cells_along(grid, r):
    """Numbers of the cell along each axis of a place in the box."""
    return "cell_along(grid, {k}, r[{k}])"


@scalar
def cell_of(grid, r):
    """Number of the cell of a place in the box."""
    cell, stride = 0, 1
    for k in range(len(r)):
        cell += cell_along(grid, k, r[k]) * stride
        stride *= grid.cells[k]
    return cell


@scalar
def cell_after(grid, box, k, here, offset):
    """Number along an axis of the cell so many after another, across the end of a periodic box.

    NOWHERE where there is none, or where few cells have a smaller offset that leads to the same.
    """
    cell, cells = here + offset, grid.cells[k]
    if 0 <= cell < cells:
        return cell
    if box.inverse[k] <= 0.0 or cells <= 2 * abs(offset):
        return NOWHERE
    return cell - cells if offset > 0 else cell + cells


@scalar
def row_around(grid, box, r, here, slide, n):
    """The nth of the 3^(d-1) rows of cells along x at and around a place in the box.

    Returns the number of its first cell, NOWHERE for none, and the number along x of the cell of
    the place there. `here`: numbers of the cell of r along each axis. `slide`: displacement along x
    of the images above, 0 without shear. With `cell_after` along x, every bead within the length of
    a cell, images included, is in one of these cells, and no cell comes twice.
    """
    middle, row, stride = here[0], 0, grid.cells[0]
    # Rows come first and x last: across an end along y images are displaced along x, and the place
    # with them.
    for k in range(1, len(r)):
        offset = n % 3 - 1
        n //= 3
        there = cell_after(grid, box, k, here[k], offset)
        if there == NOWHERE:
            return NOWHERE, middle
        if k == 1 and there != here[k] + offset:
            x = r[0] - offset * slide
            middle = cell_along(grid, 0, x - floor(x * box.inverse[0]) * box.size[0])
        row += there * stride
        stride *= grid.cells[k]
    return row, middle


@scalar
def runs_around(grid, box, starts, row, here, wide):
    """Where particles sorted by cells lie that are in cells up to `wide` before and after one.

    `row`: first cell of a row along x, `here`: the cell in it; starts (cells + 1,): where each
    begins. Returns two spans of memory, the second one of the cells across an end of the box.
    """
    low, high, cells = here - wide, here + wide, grid.cells[0]
    middle = starts[row + max(low, 0)], starts[row + min(high, cells - 1) + 1]
    other = (0, 0)
    if box.inverse[0] > 0.0 and low < 0:
        other = starts[row + low + cells], starts[row + cells]
    elif box.inverse[0] > 0.0 and high >= cells:
        other = starts[row], starts[row + high - cells + 1]
    return middle, other
