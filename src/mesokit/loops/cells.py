"""Cells and lists of neighbours: what all methods that look for pairs share."""

import math

from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import scalar

NOWHERE = -1  # no cell, beyond a wall


@scalar
def cell_along(lists, k, x):
    """Number of the cell along an axis of a coordinate in the box."""
    return min(max(int(floor(x * lists.inverse[k])), 0), lists.cells[k] - 1)


@scalar
def cell_of(lists, r):
    """Number of the cell of a place in the box."""
    cell, stride = 0, 1
    for k in range(len(r)):
        cell += cell_along(lists, k, r[k]) * stride
        stride *= lists.cells[k]
    return cell


@scalar
def cell_after(lists, box, k, here, offset):
    """The cell so many after another along an axis, across the end of a box that repeats; NOWHERE
    for none."""
    cell = here + offset
    if 0 <= cell < lists.cells[k]:
        return cell
    if box.inverse[k] <= 0.0:
        return NOWHERE
    return cell - lists.cells[k] if offset > 0 else cell + lists.cells[k]


@scalar
def next_along(lists, box, k, x):
    """The cells before, at and after x along an axis, NOWHERE for none, and the boxes crossed."""
    cells, here = lists.cells[k], cell_along(lists, k, x)
    if cells == 1:
        return (NOWHERE, here, NOWHERE), (0.0, 0.0, 0.0)
    before, after, back, on = here - 1, here + 1, 0.0, 0.0
    repeats = box.inverse[k] > 0.0
    if before < 0:
        before, back = (cells - 1 if repeats else NOWHERE), -1.0
    if after >= cells:
        after, on = (0 if repeats else NOWHERE), 1.0
    return (before, here, after), (back, 0.0, on)


@scalar
def outdated(farthest, slip, skin):
    """Whether lists may miss a pair: two particles may have approached by more than the skin.

    `farthest` is the square of the longest displacement since the lists were made, `slip` the
    displacement of images along x meanwhile.
    """
    return 2.0 * math.sqrt(farthest) + slip > skin
