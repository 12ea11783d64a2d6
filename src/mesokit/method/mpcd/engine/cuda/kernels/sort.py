"""What one thread does in a sort: particles of one cell come together in memory, or molecules whose
first beads are in one.

A counting sort: counts of cells by atomic additions, their sums in chunks, one thread a chunk, and
each row gathered into a spare one. The order within a cell is that in which threads came: no bit
depends on it, since all that is random follows from the numbers of particles.
"""

import numpy as np

from mesokit.method.mpcd.engine.cpu.grid import cell_index
from mesokit.method.mpcd.engine.cuda.kernels.rows import from_rows
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import put_real, put_whole, raise_to, real, take_number, whole

CHUNK = 128  # counts that one thread adds up


@scalar
def count_in_cell(i, zero, grid, r, counts, rank):
    """Count a particle in its cell; `rank` becomes the number of those before it there."""
    cell = np.int64(cell_index(from_rows(r, i, zero), grid))
    put_whole(rank, i, take_number(counts, cell, 1))


@scalar
def most_in_cell(chunk, counts, cells, most):
    """The largest of a chunk of counts."""
    here = 0
    for cell in range(chunk * CHUNK, min((chunk + 1) * CHUNK, cells)):
        here = max(here, whole(counts, cell))
    raise_to(most, 0, here)


@scalar
def add_up_chunk(chunk, values, number, sums):
    """Each value of a chunk becomes the sum of those before it there; `sums` has that of all."""
    total = 0
    for k in range(chunk * CHUNK, min((chunk + 1) * CHUNK, number)):
        here = whole(values, k)
        put_whole(values, k, total)
        total += here
    put_whole(sums, chunk, total)


@scalar
def lift_by_chunk(k, values, sums):
    """Add to a value the sum of all chunks before its own."""
    put_whole(values, k, whole(values, k) + whole(sums, k // CHUNK))


@scalar
def place_in_order(i, zero, grid, r, starts, rank, order):
    """`order[j]` becomes the present number of the molecule that belongs at number j."""
    cell = np.int64(cell_index(from_rows(r, i, zero), grid))
    put_whole(order, whole(starts, cell) + whole(rank, i), i)


@scalar
def gather_reals(j, row, order, molecules, spare):
    """A row of float64 numbers in the new order."""
    put_real(spare, j, real(row, place_before(j, order, molecules)))


@scalar
def gather_wholes(j, row, order, molecules, spare):
    """A row of int32 numbers in the new order."""
    put_whole(spare, j, whole(row, place_before(j, order, molecules)))


@scalar
def place_before(j, order, molecules):
    """The present place of the particle that belongs at place j."""
    first = j // molecules * molecules if j >= molecules else 0  # place of that bead of the first
    return first + whole(order, j - first)
