"""Bring particles of one cell together in memory, and their coordinates back into the box.

Sorted particles find their cells in the cache; a few cells of disorder do no harm, so this is done
rarely. The order is that of a stable counting sort, whatever the number of threads. Molecules are
sorted as a whole, by the cell of their first bead.

In space cells come in pencils along x, 8 x 8 cells across. A strip of particles spreads by a few
cells along each axis until the next sort. In pencils it then has most of its cells in common with
the strip before it. A plane is sorted by rows, of which enough fit in the cache. So is a fluid
among solids, because in pencils more strips would have particles near a plate.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import SLIDING, fold, unfold
from mesokit.kernels.kernel import inner, kernel
from mesokit.loops.clock import SORT, START, lap
from mesokit.loops.layout import (
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
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.cpu.grid import cell_index
from mesokit.method.mpcd.engine.cpu.strips.rows import count_images, load_particle, store_particle
from mesokit.scalar.jit import by_type
from mesokit.scalar.vector import scaled


class Order(NamedTuple):
    """Memory of the sort."""

    order: Any  # (molecules,) present number of the molecule that belongs at each number
    ends: Any  # (threads, cells) where the molecules of each cell end
    spare: Any  # (particles,) floats
    whole: Any  # the same memory as whole numbers of 32 bits
    long: Any  # and of 64
    sequence: Any  # (cells,) number of each cell in the order of memory


PENCIL = 8  # cells along y and along z


def sequence_of_cells(cells: tuple[int, ...], solids: bool) -> NDArray[np.int32]:
    """Number of each cell in the order of memory; that of the spare cell is the last.

    >>> sequence_of_cells((2, 16, 1), solids=False)[[0, 2, 14, 16, 1, 32]]  # y = 0, 1, 7, 8; x = 1
    array([ 0,  1,  7, 16,  8, 32], dtype=int32)
    """
    number = np.arange(math.prod(cells) + 1, dtype=np.int32)
    if len(cells) < 3 or solids:
        return number
    along, y, z = (np.arange(n, dtype=np.int32) for n in cells)
    y, z = y[None, :], z[:, None]
    # where the pencil of (y, z) begins, and how many cells wide and high it is
    low_y, low_z = y // PENCIL * PENCIL, z // PENCIL * PENCIL
    wide, high = (np.minimum(PENCIL, cells[k] - low) for k, low in ((1, low_y), (2, low_z)))
    before = cells[0] * (cells[1] * low_z + high * low_y)
    of_row = before + (z - low_z) * wide + y - low_y
    number[:-1] = (of_row[..., None] + along * (wide * high)[..., None]).ravel()
    return number


@kernel
def sort(worker, zero, box, grid, particles, memory):
    """Bring all particles back into the box, and those of one cell together."""
    lap(worker, START)
    wrap(worker, zero, box, grid, particles)
    barrier(worker)
    order_by_cell(worker, particles, memory)
    for bead in range(beads_of(particles.filling)):
        for row in range(particles.rows):
            reorder_row(worker, particles, memory, row, bead)
        reorder(worker, particles.ident, memory.long, particles.filling, memory.order, bead)
        for k in range(len(zero)):
            reorder(worker, particles.image[k], memory.whole, particles.filling, memory.order, bead)
    lap(worker, SORT)


@inner
def wrap(worker, zero, box, grid, particles):
    """Move every molecule to its image in the primary box, count the boxes crossed, find cells.

    Spare lanes go back to zero: nothing else keeps them from running away.
    """
    filling, rows = particles.filling, particles.rows
    d, beads = len(zero), beads_of(filling)
    first, last = share(groups_in(filling), worker.thread, worker.threads)
    # Whole molecules move by the image of their first bead, so that bonds remain plain differences
    # of coordinates. A thread has whole groups, and each lane depends on its own molecule only.
    for g in range(first, last):
        for bead in range(beads):
            b = g * beads + bead
            strip = particles.data[strip_at(b, rows)]
            for i in range(lanes_in(filling, b), LANES):
                store_particle(strip, i, 0, zero + zero)
        # The first bead decides for all, so it is folded last.
        for bead in range(beads - 1, -1, -1):
            b = g * beads + bead
            places = slice(b * LANES, (b + 1) * LANES)
            strip, image = particles.data[strip_at(b, rows)], particles.image[:, places]
            leader = particles.data[strip_at(g * beads, rows)]
            for i in range(LANES):
                r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
                leading = load_particle(leader, i, 0, zero)
                r, v, crossed = fold_with(filling, box, r, v, leading)
                store_particle(strip, i, 0, r + v)
                particles.cell[b * LANES + i] = cell_index(r, grid)
                count_images(image, i, crossed)


@by_type
def fold_with(filling, box, r, v, leader):
    """Position and velocity in the image in which the leader is in the box, and the boxes crossed.

    Under shear every bead is folded by itself, for velocities of one cell are those of one image.
    """
    alone = filling.instance_class is Singles or box.instance_class in SLIDING
    if alone:
        return lambda filling, box, r, v, leader: fold(box, r, v, scaled(0.0, r))

    def with_leader(filling, box, r, v, leader):
        _, _, crossed = fold(box, leader, v, scaled(0.0, r))
        return unfold(box, r, v, scaled(-1.0, crossed)) + (crossed,)

    return with_leader


@inner
def order_by_cell(worker, particles, memory):
    """`order[j]` becomes the present number of the molecule that belongs at number j."""
    cell, filling, ends, thread = particles.cell, particles.filling, memory.ends, worker.thread
    first, last = share(filling.molecules, thread, worker.threads)
    ends[thread] = 0
    # Counting sort. Each thread counts the molecules of its share of memory, by cell.
    for i in range(first, last):
        ends[thread, memory.sequence[cell[place_of_bead(filling, i, 0)]]] += 1
    barrier(worker)
    # From counts to the place of each thread's first molecule of each cell, cell by cell and in a
    # cell thread by thread. Shares of threads are in the order of memory, so the sort is stable for
    # any number of threads. The barrier is there because other threads read these counts first.
    first_cell, last_cell = share(ends.shape[1], thread, worker.threads)
    total = 0
    for t in range(worker.threads):
        for c in range(first_cell):
            total += ends[t, c]
    barrier(worker)
    for c in range(first_cell, last_cell):
        for t in range(worker.threads):
            here = ends[t, c]
            ends[t, c] = total
            total += here
    barrier(worker)
    # No two threads have a place in common, so all write to `order` at once.
    for i in range(first, last):
        c = memory.sequence[cell[place_of_bead(filling, i, 0)]]
        memory.order[ends[thread, c]] = i
        ends[thread, c] += 1
    barrier(worker)


@inner
def reorder_row(worker, particles, memory, row, bead):
    """Put one row of the blocks in the new order, through a spare array, for one bead of each."""
    data, filling, rows, spare = particles.data, particles.filling, particles.rows, memory.spare
    first, last = share(filling.molecules, worker.thread, worker.threads)
    # Not in place: other threads still read rows here until the barrier.
    for j in range(first, last):
        i = place_of_bead(filling, memory.order[j], bead)
        spare[j] = data[place(i, rows, row)]
    barrier(worker)
    for j in range(first, last):
        data[place(place_of_bead(filling, j, bead), rows, row)] = spare[j]
    barrier(worker)


@inner
def reorder(worker, values, spare, filling, order, bead):
    """Put a plain array in the new order, through a spare one, for one bead of each molecule."""
    first, last = share(filling.molecules, worker.thread, worker.threads)
    for j in range(first, last):
        spare[j] = values[place_of_bead(filling, order[j], bead)]
    barrier(worker)
    for j in range(first, last):
        values[place_of_bead(filling, j, bead)] = spare[j]
    barrier(worker)
