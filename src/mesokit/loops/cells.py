"""Cells of a box: which one a place is in, and which ones are around it.

`grid` has `cells` (d,), their number along each axis, and `inverse` (d,), their number per length;
`box` has `size` (d,) and `inverse` (d,), one over each length, 0 along axes that walls close.
"""

from typing import NamedTuple

from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import scalar

NOWHERE = -1  # no cell, beyond a wall


class Grid(NamedTuple):
    """Cells and nothing else."""

    cells: tuple[int, ...]
    inverse: tuple[float, ...]


@scalar
def cell_along(grid, k, x):
    """Number of the cell along an axis of a coordinate in the box."""
    return min(max(int(floor(x * grid.inverse[k])), 0), grid.cells[k] - 1)


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
def cell_around(grid, box, r, slide, n):
    """Number of the nth of the 3^d cells at and around a place in the box; NOWHERE for none.

    `slide`: displacement along x of the images above, 0 without shear. Every bead within the length
    of a cell, images included, is in one of these cells, and no cell comes twice.
    """
    x, along_x, cell, stride = r[0], n % 3 - 1, 0, grid.cells[0]
    # x comes last: across an end along y images are displaced along x, and the place with them.
    for k in range(1, len(r)):
        n //= 3
        here, offset = cell_along(grid, k, r[k]), n % 3 - 1
        there = cell_after(grid, box, k, here, offset)
        if there == NOWHERE:
            return NOWHERE
        if k == 1 and there != here + offset:
            x -= offset * slide
            x -= floor(x * box.inverse[0]) * box.size[0]
        cell += there * stride
        stride *= grid.cells[k]
    there = cell_after(grid, box, 0, cell_along(grid, 0, x), along_x)
    return cell + there if there != NOWHERE else NOWHERE


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
