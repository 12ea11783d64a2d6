"""Bring particles of one cell together in memory, and their coordinates back into the box.

Sorted particles find their cells in the cache; a few cells of disorder do no harm, so this is done
rarely. The order is that of a stable counting sort, whatever the number of threads. Molecules are
sorted as a whole, by the cell of their first bead.
"""

from mesokit.box import SLIDING, fold, unfold
from mesokit.execute.cache import inner, kernel
from mesokit.execute.layout import (
    LANES,
    Singles,
    beads_of,
    groups_in,
    lanes_in,
    place,
    place_of_bead,
    share,
    strip_at,
)
from mesokit.execute.rows import count_images, load, store
from mesokit.execute.stages import cell_index
from mesokit.execute.team import wait
from mesokit.scalar import by_type, scaled


@inner
def wrap(thread, threads, box, grid, data, cell, image, filling, rows, like):
    """Move every molecule to its image in the primary box, count the boxes crossed, find cells.

    Spare lanes go back to zero: nothing else keeps them from running away.
    """
    d = len(like)
    first, last = share(groups_in(filling), thread, threads)
    for g in range(first, last):
        for bead in range(beads_of(filling)):
            b = g * beads_of(filling) + bead
            strip = data[strip_at(b, rows)]
            for i in range(lanes_in(filling, b), LANES):
                store(strip, i, 0, like + like)
        for bead in range(beads_of(filling) - 1, -1, -1):  # the first, which decides, at the end
            b = g * beads_of(filling) + bead
            strip, boxes = data[strip_at(b, rows)], image[:, b * LANES : (b + 1) * LANES]
            leader = data[strip_at(g * beads_of(filling), rows)]
            for i in range(LANES):
                r, v = load(strip, i, 0, like), load(strip, i, d, like)
                leading = load(leader, i, 0, like)
                r, v, crossed = fold_with(filling, box, r, v, leading)
                store(strip, i, 0, r + v)
                cell[b * LANES + i] = cell_index(r, grid)
                count_images(boxes, i, crossed)


@by_type
def fold_with(filling, box, r, v, leader):
    """Position and velocity in the image in which the leader is in the box, and the boxes crossed.

    Under shear every bead is folded by itself, for velocities of one cell are those of one image.
    """
    alone = filling.instance_class is Singles or box.instance_class in SLIDING
    return _by_itself if alone else _with_leader


def _by_itself(filling, box, r, v, leader):
    return fold(box, r, v, scaled(0.0, r))


def _with_leader(filling, box, r, v, leader):
    _, _, crossed = fold(box, leader, v, scaled(0.0, r))
    return unfold(box, r, v, scaled(-1.0, crossed)) + (crossed,)


@inner
def order_by_cell(thread, threads, gate, cell, filling, ends, order):
    """`order[j]` becomes the present number of the molecule that belongs at number j."""
    first, last = share(filling.molecules, thread, threads)
    ends[thread] = 0
    for i in range(first, last):
        ends[thread, cell[place_of_bead(filling, i, 0)]] += 1
    wait(gate, threads)
    # from counts to the place of each thread's first molecule of each cell
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
        c = cell[place_of_bead(filling, i, 0)]
        order[ends[thread, c]] = i
        ends[thread, c] += 1
    wait(gate, threads)


@inner
def reorder_row(thread, threads, gate, data, rows, row, order, filling, bead, spare):
    """Put one row of the blocks in the new order, through a spare array, for one bead of each."""
    first, last = share(filling.molecules, thread, threads)
    for j in range(first, last):
        i = place_of_bead(filling, order[j], bead)
        spare[j] = data[place(i, rows, row)]
    wait(gate, threads)
    for j in range(first, last):
        data[place(place_of_bead(filling, j, bead), rows, row)] = spare[j]
    wait(gate, threads)


@inner
def reorder(thread, threads, gate, values, order, filling, bead, spare):
    """Put a plain array in the new order, through a spare one, for one bead of each molecule."""
    first, last = share(filling.molecules, thread, threads)
    for j in range(first, last):
        spare[j] = values[place_of_bead(filling, order[j], bead)]
    wait(gate, threads)
    for j in range(first, last):
        values[place_of_bead(filling, j, bead)] = spare[j]
    wait(gate, threads)


@kernel
def sort(
    thread, threads, gate, box, grid, data, cell, ident, image, filling, rows, order, ends, spare,
    whole, like,
):  # fmt: skip
    """Wrap and sort; `spare` and `whole` are float64 and int32 scratch of a place per particle."""
    wrap(thread, threads, box, grid, data, cell, image, filling, rows, like)
    wait(gate, threads)
    order_by_cell(thread, threads, gate, cell, filling, ends, order)
    for bead in range(beads_of(filling)):
        for row in range(rows):
            reorder_row(thread, threads, gate, data, rows, row, order, filling, bead, spare)
        reorder(thread, threads, gate, ident, order, filling, bead, whole)
        for k in range(len(like)):
            reorder(thread, threads, gate, image[k], order, filling, bead, whole)
