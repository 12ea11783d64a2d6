"""Bring particles of one cell together in memory, and their coordinates back into the box.

Sorted particles find their cells in the cache; a few cells of disorder do no harm, so this is done
rarely. The order is that of a stable counting sort, whatever the number of threads.
"""

import numpy as np

from mesokit.box import fold
from mesokit.execute.cache import inner, kernel
from mesokit.execute.layout import LANES, place, share, strip_of
from mesokit.execute.rows import load, store
from mesokit.execute.stages import cell_index
from mesokit.execute.team import wait
from mesokit.scalar import scaled


@inner
def wrap(thread, threads, box, grid, data, cell, image, count, strips, rows, like):
    """Move every particle to its image in the primary box, count the boxes crossed, find cells.

    Spare lanes go back to zero: nothing else keeps them from running away.
    """
    d = len(like)
    first, last = share(strips, thread, threads)
    for b in range(first, last):
        strip = strip_of(data, b, rows)
        for i in range(min(LANES, count - b * LANES), LANES):
            store(strip, i, 0, like + like)
        for i in range(LANES):
            r, v = load(strip, i, 0, like), load(strip, i, d, like)
            r, v, crossed = fold(box, r, v, scaled(0.0, like))
            store(strip, i, 0, r + v)
            cell[b * LANES + i] = cell_index(r, grid)
            for k in range(d):
                image[k, b * LANES + i] += np.int32(crossed[k])


@inner
def order_by_cell(thread, threads, gate, cell, count, ends, order):
    """`order[j]` becomes the present place of the particle that belongs at place j."""
    first, last = share(count, thread, threads)
    ends[thread] = 0
    for i in range(first, last):
        ends[thread, cell[i]] += 1
    wait(gate, threads)
    # from counts to the place of each thread's first particle of each cell
    first_cell, last_cell = share(ends.shape[1], thread, threads)
    total = 0
    for t in range(threads):
        for c in range(first_cell):
            total += ends[t, c]
    wait(gate, threads)
    for c in range(first_cell, last_cell):
        for t in range(threads):
            here = ends[t, c]
            ends[t, c] = total
            total += here
    wait(gate, threads)
    for i in range(first, last):
        c = cell[i]
        order[ends[thread, c]] = i
        ends[thread, c] += 1
    wait(gate, threads)


@inner
def reorder_row(thread, threads, gate, data, rows, row, order, count, spare):
    """Put one row of the blocks in the new order, through a spare array."""
    first, last = share(count, thread, threads)
    for j in range(first, last):
        i = order[j]
        spare[j] = data[place(i, rows, row)]
    wait(gate, threads)
    for j in range(first, last):
        data[place(j, rows, row)] = spare[j]
    wait(gate, threads)


@inner
def reorder(thread, threads, gate, values, order, count, spare):
    """Put a plain array in the new order, through a spare one."""
    first, last = share(count, thread, threads)
    for j in range(first, last):
        spare[j] = values[order[j]]
    wait(gate, threads)
    values[first:last] = spare[first:last]
    wait(gate, threads)


@kernel
def sort(
    thread, threads, gate, box, grid, data, cell, ident, image, count, strips, rows, order, ends,
    spare, whole, like,
):  # fmt: skip
    """Wrap and sort; `spare` and `whole` are float64 and int32 scratch of a place per particle."""
    wrap(thread, threads, box, grid, data, cell, image, count, strips, rows, like)
    wait(gate, threads)
    order_by_cell(thread, threads, gate, cell, count, ends, order)
    for row in range(rows):
        reorder_row(thread, threads, gate, data, rows, row, order, count, spare)
    reorder(thread, threads, gate, ident, order, count, whole)
    for k in range(len(like)):
        reorder(thread, threads, gate, image[k], order, count, whole)
