"""Birds into cells: a counting sort that threads share.

Which of the birds of a cell comes first depends on the threads; nothing that is computed does.
"""

import numpy as np

from mesokit.kernels.kernel import inner
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.flock.engine.memory import HEADING
from mesokit.scalar.fixed_point import fixed
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar

_LOW = np.uint64(0xFFFFFFFF)
LOOK = 12  # birds in a cell that cost as much to look at as one costs otherwise


@scalar
def spot(axes, k, x):
    """A place along axis k as a whole number of 32 bits."""
    return np.int32(fixed(x, axes.scale[k]))


@scalar
def cell_along(axes, k, place):
    """The cell along axis k of a place as a whole number."""
    inside = np.uint64(np.int64(place)) & _LOW
    cell = np.int64((inside * np.uint64(axes.cells[k])) >> axes.bits[k])
    return min(cell, axes.cells[k] - 1)  # a place at a closed end may be rounded up to the length


@inner
def sort(worker, axes, birds, seen, cells, side):
    """Sort birds from `side` to the other side, and copy what they see of one another."""
    n, number = birds.numbers.shape[1], len(cells.starts) - 1
    first, last = share(n, worker.thread, worker.threads)
    count(axes, birds.places, cells, worker.thread, side, first, last)
    barrier(worker)
    add_up(worker, cells, number)
    barrier(worker)
    share_out(worker, cells, number)
    barrier(worker)
    scatter(axes, birds, seen, cells.homes, cells.counts[worker.thread], side, first, last)
    barrier(worker)


@inner
def count(axes, places, cells, thread, side, first, last):
    """The cells of birds, and how many are in each."""
    counts = cells.counts[thread]
    counts[:] = 0
    # Cells follow from places as 32-bit integers, as the sums do. So a bird cannot lie in one cell
    # by its place and in another by its copy.
    for i in range(first, last):
        cell = 0
        for j in range(len(axes.size)):
            k = len(axes.size) - 1 - j
            cell = cell * axes.cells[k] + cell_along(axes, k, spot(axes, k, places[side, k, i]))
        cells.homes[i] = cell
        counts[cell] += np.int32(1)


@scalar
def looks(birds):
    """About how much work the birds of a cell are, if those around it hold as many."""
    return birds * (LOOK + birds)


@inner
def add_up(worker, cells, number):
    """Birds and work in the cells of this thread."""
    first, last = share(number, worker.thread, worker.threads)
    birds = work = 0
    # From here on threads share cells instead of birds: totals of each share, from which all
    # offsets follow.
    for cell in range(first, last):
        here = 0
        for thread in range(worker.threads):
            here += cells.counts[thread, cell]
        birds += here
        work += looks(here)
    cells.totals[worker.thread, 0], cells.totals[worker.thread, 1] = birds, work


@inner
def share_out(worker, cells, number):
    """Find the first place of the birds of each cell and thread."""
    first, last = share(number, worker.thread, worker.threads)
    place = work = 0
    # Where this share of cells begins: after the birds in the shares of threads before. Then each
    # count becomes the first place of a thread's birds in a cell, so that `scatter` needs no locks.
    for thread in range(worker.thread):
        place += cells.totals[thread, 0]
        work += cells.totals[thread, 1]
    for cell in range(first, last):
        cells.starts[cell], cells.work[cell] = place, work
        begin = place
        for thread in range(worker.threads):
            here = cells.counts[thread, cell]
            cells.counts[thread, cell] = place
            place += here
        work += looks(place - begin)
    if worker.thread == worker.threads - 1:
        cells.starts[number], cells.work[number] = place, work


@inner
def scatter(axes, birds, seen, homes, ahead, side, first, last):
    """Copy birds to where they belong."""
    other = 1 - side
    for i in range(first, last):
        cell = homes[i]
        j = ahead[cell]
        ahead[cell] = j + 1
        birds.numbers[other, j] = birds.numbers[side, i]
        for k in range(len(axes.size)):
            x, u = birds.places[side, k, i], birds.headings[side, k, i]
            birds.places[other, k, j] = x
            birds.headings[other, k, j] = u
            birds.images[other, k, j] = birds.images[side, k, i]
            seen.places[k, j] = spot(axes, k, x)
            seen.headings[k, j] = np.int32(fixed(u, HEADING))


@scalar
def cells_of(worker, cells):
    """The cells that a thread looks at: about the same work for each."""
    work, ends = cells.work, (0, 0)
    # Bisection in the running sum of work. The end of a thread is the start of the next one, by the
    # same search, so every cell has exactly one thread.
    for k in range(2):
        wanted = work[len(work) - 1] * (worker.thread + k) // worker.threads
        ends = with_item(ends, k, np.searchsorted(work, wanted))
    return ends
