"""The gradient, over neighbouring cells, of one of the sums that a collision rule adds up.

Without such a rule there is no field, and nothing of this is compiled.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, share, sums_length
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import untangled
from mesokit.method.mpcd.engine.domains.messages.mpi import finish
from mesokit.method.mpcd.engine.domains.messages.shared import (
    FIELD_WORDS,
    receive_rows,
    send_rows,
    shares,
)
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.fixed_point import from_fixed
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.pointer import element

FIELDS = 3  # tag of messages


class NeighbourSums(NamedTuple):
    """A sum in every cell of the step, with how the cells lie.

    `term` is its place among the terms of a cell, `values` one number for each cell, an array or
    its address, `cells` their number along each axis (x varies fastest), `closed` 1 for each axis
    along which walls end them.
    """

    term: int
    values: Any
    cells: tuple
    closed: tuple


@where(fluid=lambda fluid: len(field_of(field_of(fluid, "cells"), "neighbour_sums")))
def fill_neighbour_sums(worker, physics, fluid):
    """Store the sum of every cell if a rule needs its gradient; ends with a barrier."""
    cells = fluid.cells
    term, width = cells.neighbour_sums.term, sums_length(len(physics.terms))
    batches = (cells.number + LANES - 1) // LANES
    first, last = share(batches, worker.thread, worker.threads)
    # The integer sums of all threads as one float for each cell. Shares are those of `collide`,
    # whole batches. Gradients read neighbouring cells of other threads: hence the barrier after
    # this.
    for cell in range(first * LANES, min(last * LANES, cells.number)):
        number, total = np.int64(0), np.int64(0)
        for t in range(cells.sums.shape[0]):
            number += untangled(physics.energy, cells.sums[t, cell * width])[0]
            total += cells.sums[t, cell * width + 1 + term]
        cells.neighbour_sums.values[cell] = from_fixed(total, number, physics.scales[term])
    share_field(worker, fluid)
    barrier(worker)


@where(fluid=shares)
@stage
def share_field(worker, fluid):
    """Exchange the sums of cells at the borders of ranks, for gradients in neighbouring cells."""
    barrier(worker)
    # The first thread sends the sums of own cells that lie in halos of partners (`given`), and
    # stores those of the cells in its own halo (`mine`): gradients need them before the collision.
    if worker.thread == 0:
        shared, values = fluid.cells.shared, fluid.cells.neighbour_sums.values
        for j in range(len(shared.given)):
            shared.field_out[j, 0] = values[shared.given[j]]
        n = receive_rows(shared, 0, shared.field_in, shared.starts, FIELDS)
        for p in range(len(shared.ranks)):
            first, number = (
                shared.given_starts[p],
                shared.given_starts[p + 1] - shared.given_starts[p],
            )
            n = send_rows(shared, n, shared.field_out, first, number, p, FIELDS, FIELD_WORDS)
        finish(shared.post, n)
        for j in range(len(shared.mine)):
            values[shared.mine[j]] = shared.field_in[j, 0]
    barrier(worker)


@scalar
def next_along(i, step, cells, closed):
    """The next place along an axis: round the box, or the same where a wall ends it."""
    j = i + step
    outside = j < 0 or j >= cells
    round_the_box = j - step * cells
    return (i if closed != 0 else round_the_box) if outside else j


@by_type
def gradient_at(field, cell):
    """The gradient at a cell, per cell of length; () where no rule needs it.

    Differences of neighbours along an axis, weighted across it by 1/6, 4/6, 1/6: the error of
    leading order is then the same in every direction.
    """
    if len(field) == 0:
        return lambda field, cell: ()
    return _gradient_2d if len(field_of(field, "cells")) == 2 else _gradient_3d


def _gradient_2d(field, cell):
    values, nx, ny = field.values, field.cells[0], field.cells[1]
    cell = min(cell, nx * ny - 1)  # lanes beyond the last cell are not used
    x, y = cell % nx, cell // nx
    gx = gy = 0.0
    # Central differences along each axis in three parallel rows, weighted across by 1/6, 4/6, 1/6,
    # over the distance of two cells. At a wall the cell stands for its missing neighbour.
    for step in range(-1, 2):
        weight = 1.0 / 3.0 if step == 0 else 1.0 / 12.0
        row = next_along(y, step, ny, field.closed[1]) * nx
        east = next_along(x, 1, nx, field.closed[0])
        west = next_along(x, -1, nx, field.closed[0])
        gx += weight * (element(values, row + east) - element(values, row + west))
        column = next_along(x, step, nx, field.closed[0])
        north = next_along(y, 1, ny, field.closed[1]) * nx
        south = next_along(y, -1, ny, field.closed[1]) * nx
        gy += weight * (element(values, north + column) - element(values, south + column))
    return gx, gy


def _gradient_3d(field, cell):
    values, nx, ny, nz = field.values, field.cells[0], field.cells[1], field.cells[2]
    cell = min(cell, nx * ny * nz - 1)
    x, y, z = cell % nx, cell // nx % ny, cell // (nx * ny)
    gx = gy = gz = 0.0
    # The same over 27 cells: the sign of the offset makes the difference, both other axes the
    # weight.
    for k in range(-1, 2):
        up = next_along(z, k, nz, field.closed[2]) * ny
        for j in range(-1, 2):
            row = (up + next_along(y, j, ny, field.closed[1])) * nx
            for i in range(-1, 2):
                value = element(values, row + next_along(x, i, nx, field.closed[0]))
                gx += float(i) * _weight(j) * _weight(k) * value
                gy += float(j) * _weight(i) * _weight(k) * value
                gz += float(k) * _weight(i) * _weight(j) * value
    return 0.5 * gx, 0.5 * gy, 0.5 * gz


@scalar
def _weight(step):
    return 4.0 / 6.0 if step == 0 else 1.0 / 6.0
