"""Spheres sorted by cells in memory, and neighbour lists."""

import numpy as np

from mesokit.kernels.kernel import kernel
from mesokit.loops.cells import cell_after, cell_along, cell_of, runs_around
from mesokit.loops.layout import share
from mesokit.method.spheres.common.contacts.geometry import row, shortest
from mesokit.method.spheres.common.contacts.groups import IN_ALL, NEVER, Box, SlidBox
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import generic, scalar
from mesokit.scalar.vector import dot

GROUP = 8  # lists are filled up to whole groups, for which loops over vectors need no rest


@kernel
def sort(grid, place, cell, begins, order):
    """The order of memory in which spheres of one cell lie together, and where each cell begins."""
    begins[:] = 0
    # Counting sort: numbers of each cell; their running sum, where cells end; then a place for each
    # sphere, the last one first, by which ends become begins. Spheres of a cell keep their order.
    for i in range(len(cell)):
        cell[i] = cell_of(grid, row(place, i))
        begins[cell[i]] += 1
    for c in range(1, len(begins)):
        begins[c] += begins[c - 1]
    for i in range(len(cell) - 1, -1, -1):
        begins[cell[i]] -= 1
        order[begins[cell[i]]] = i


@kernel
def make_lists(worker, grid, begins, columns, bodies, box, lists, scratch):
    """List all spheres within reach and skin of each sphere.

    A list without enough room is cut off, but `count` has its full length. `columns` (4, n): places
    again, coordinate by coordinate; `scratch` (threads, n): memory of these loops.
    """
    first, last = share(len(bodies.number), worker.thread, worker.threads)
    beside = scratch[worker.thread]
    # Cells around sphere i that its reach and the skin can touch. Cells along x lie one after
    # another in memory: a row of cells is one span, or two across an end of the box. Sums of forces
    # are integers, so the order of a list changes no bit.
    for i in range(first, last):
        found = 0
        y, z = bodies.place[i, 1], bodies.place[i, 2]
        x_cell = cell_along(grid, 0, bodies.place[i, 0])
        y_cell, z_cell = cell_along(grid, 1, y), cell_along(grid, 2, z)
        for c in range(-grid.wide[2], grid.wide[2] + 1):
            z_there = cell_after(grid, box, 2, z_cell, c)
            up = off(grid, 2, z, z_cell, c)
            for b in range(-grid.wide[1], grid.wide[1] + 1):
                y_there = cell_after(grid, box, 1, y_cell, b)
                side = off(grid, 1, y, y_cell, b)
                if min(y_there, z_there) >= 0 and up * up + side * side <= grid.farthest:
                    line = grid.cells[0] * (y_there + grid.cells[1] * z_there)
                    boxes = (y_cell + b - y_there) // grid.cells[1]
                    middle = seen_from(box, grid, bodies.place[i, 0], x_cell, boxes)
                    for span in runs_around(grid, box, begins, line, middle, grid.wide[0]):
                        found = list_span(columns, box, lists, i, span, found, beside)
        if lists.once != NEVER:
            lists.own[i] = own_first(lists, i, found, 0 if lists.once == IN_ALL else first)
        # Lists are filled up with the sphere itself.
        lists.count[i] = (found + GROUP - 1) // GROUP * GROUP
        for s in range(found, min(lists.count[i], lists.near.shape[1])):
            lists.near[i, s] = np.int32(i)
        for k in range(3):
            lists.made_at[i, k] = bodies.place[i, k]


@generic
def seen_from(box, grid, x, x_cell, boxes):
    """Cell along x of a place, as seen from a number of images above: these may have slid."""


seen_from.register(Box)(lambda box, grid, x, x_cell, boxes: x_cell)


@seen_from.register(SlidBox)
def _(box, grid, x, x_cell, boxes):
    if boxes == 0:
        return x_cell
    there = x - float(boxes) * box.offset
    there -= floor(there * box.inverse[0]) * box.size[0]
    return cell_along(grid, 0, there if there < box.size[0] else 0.0)


@scalar
def off(grid, k, x, here, offset):
    """Distance along an axis from x to the cell that is `offset` cells after that of x."""
    if offset == 0:
        return 0.0
    edge = float(here + offset + (0 if offset > 0 else 1)) / grid.inverse[k]
    return max(edge - x if offset > 0 else x - edge, 0.0)


@scalar
def list_span(columns, box, lists, i, span, found, beside):
    """Add those between two places in memory; how many are listed then.

    First all distances, in a loop over vectors, and then the choice, in one without branches.
    """
    begin, end = span
    x, y, z = columns[0, i], columns[1, i], columns[2, i]
    whole = begin + ((end - begin + GROUP - 1) & -GROUP)
    xs, ys, zs = columns[0, begin:whole], columns[1, begin:whole], columns[2, begin:whole]
    beyond, reaches = columns[3, i] + lists.skin, columns[3, begin:whole]
    # All squared distances of a span, up to a whole vector beyond its end.
    for k in range(np.uint64(whole - begin)):
        separation = shortest(box, (x - xs[k], y - ys[k], z - zs[k]))
        far = beyond + reaches[k]
        beside[k] = 1 if dot(separation, separation) <= far * far else 0
    if begin <= i < end:
        beside[i - begin] = 0
    last_place = lists.near.shape[1] - 1
    # Each candidate is written at the end of the list, which grows only if it is near. A full list
    # overwrites its last place and `found` goes on: the caller allocates longer lists.
    for k in range(np.uint64(end - begin)):
        lists.near[i, np.uint64(min(found, last_place))] = np.int32(np.uint64(begin) + k)
        found += beside[k]
    return found


@scalar
def own_first(lists, i, found, first):
    """Put those in front that are not found from the sphere before in memory, of those from number
    `first` on; how many they are."""
    own, room = 0, lists.near.shape[1]
    # Partition in place: pairs that this sphere treats come first. A pair within a thread is
    # treated once, from the sphere before in memory; a pair of two threads is treated by each.
    for s in range(min(found, room)):
        j, other = lists.near[i, s], lists.near[i, own]
        mine = not first <= j < i
        lists.near[i, s] = other if mine else j
        lists.near[i, own] = j if mine else other
        own += mine
    return own
