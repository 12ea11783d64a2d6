"""Bring particles of one cell together in memory, and their coordinates back into the box.

Sorted particles find their cells in the cache; a few cells of disorder do no harm, so this is done
rarely. The order is that of a stable counting sort, whatever the number of threads.
"""

import numpy as np

from mesokit.box import fold
from mesokit.execute.layout import LANES, ROW, kernel, load, share, store
from mesokit.execute.stages import cell_index
from mesokit.scalar import scaled


@kernel
def wrap(thread, threads, box, grid, data, cell, image, blocks, rows, like):
    """Move every particle to its image in the primary box, count the boxes crossed, find cells."""
    d = len(like)
    first, last = share(blocks, thread, threads)
    for b in range(first, last):
        block = data[b * rows * ROW : (b + 1) * rows * ROW]
        for i in range(LANES):
            r, v = load(block, i, 0, like), load(block, i, d, like)
            r, v, crossed = fold(box, r, v, scaled(0.0, like))
            store(block, i, 0, r + v)
            cell[b * LANES + i] = cell_index(r, grid)
            for k in range(d):
                image[k, b * LANES + i] += np.int32(crossed[k])


@kernel
def count_cells(thread, threads, cell, count, ends):
    """How many of a thread's particles lie in each cell."""
    ends[thread] = 0
    first, last = share(count, thread, threads)
    for i in range(first, last):
        ends[thread, cell[i]] += 1


@kernel
def first_places(ends):
    """From counts (threads, cells) to the place of each thread's first particle of each cell."""
    total = 0
    for c in range(ends.shape[1]):
        for t in range(ends.shape[0]):
            here = ends[t, c]
            ends[t, c] = total
            total += here


@kernel
def order_by_cell(thread, threads, cell, count, ends, order):
    """`order[j]` becomes the present place of the particle that belongs at place j."""
    first, last = share(count, thread, threads)
    for i in range(first, last):
        c = cell[i]
        order[ends[thread, c]] = i
        ends[thread, c] += 1


@kernel
def pick_row(thread, threads, data, rows, row, order, count, spare):
    """Copy one row of the blocks, in the new order, to a spare array."""
    first, last = share(count, thread, threads)
    for j in range(first, last):
        i = order[j]
        spare[j] = data[(i // LANES * rows + row) * ROW + i % LANES]


@kernel
def put_row(thread, threads, data, rows, row, count, spare):
    """Copy the spare array back to one row of the blocks."""
    first, last = share(count, thread, threads)
    for j in range(first, last):
        data[(j // LANES * rows + row) * ROW + j % LANES] = spare[j]


@kernel
def pick(thread, threads, values, order, count, spare):
    """Copy a plain array, in the new order, to a spare one."""
    first, last = share(count, thread, threads)
    for j in range(first, last):
        spare[j] = values[order[j]]


@kernel
def put(thread, threads, values, count, spare):
    """Copy the spare array back."""
    first, last = share(count, thread, threads)
    values[first:last] = spare[first:last]
