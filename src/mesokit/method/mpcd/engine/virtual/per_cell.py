"""Virtual particles of walls, all of a cell at once.

If a rule needs only number, momentum and energy of a cell's particles, these need not be drawn one
by one. The solid part of a cut cell holds a Poisson number N of them; their
momentum is that of one particle N times as heavy, and the energy of their motion about their mean
is kT/2 times a chi-square number of d (N - 1) degrees of freedom. The part that is solid follows
from a plane for each cut cell and offset of the grid: tables give its normal and its height,
which moves with the shift.
"""

from typing import NamedTuple

import numpy as np

from mesokit.geometry.solids.clearance import offset_of
from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, SCRATCH_ROW, record_length, share, sums_length
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_WALLS
from mesokit.method.mpcd.engine.cpu.physics import of_walls
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import needs_energy
from mesokit.method.mpcd.engine.cpu.strips.rows import (
    add_values,
    load_scratch,
    load_values,
    store_scratch,
)
from mesokit.method.mpcd.engine.virtual.of_cell import (
    brought_together,
    cut_at,
    likely_energy,
    mean_velocity,
    moved_from_middle,
    take_gain,
    velocity_in_solid,
    velocity_of_gas,
)
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.poisson import MOST_MEAN, MOST_NUMBER, none_found, one_more
from mesokit.scalar.random import VIRTUAL_NUMBER, words

ROWS = 14  # of the scratch memory of a batch of cells
# The first four are followed by as many rows as there are axes.
PLACE, THERMAL, MEAN, DEPTH, NUMBER, CHANCE, LEFT, INNER, HEIGHT = 0, 3, 6, 7, 8, 9, 10, 11, 12


@scalar
def cut_batch(virtual, start, count, solid, grid, work, zero):
    """Mean number of particles in the solid of each cell, their mean depth, and their mean place.

    The place is in the image of the cell next to the term, which may lie beyond an end of the box.
    """
    cells, d = virtual.per_cell, len(zero)
    entries, moved = len(cells.heights), moved_from_middle(solid, grid, zero)
    # Tables have a row for each axis and the batch any start in them, so rows are copied first. The
    # last loop then is one over vectors.
    for k in range(d):
        for i in range(count):
            work[(PLACE + k) * SCRATCH_ROW + i] = cells.places[k * entries + start + i]
        for i in range(count):  # of which the room is needed later
            work[(THERMAL + k) * SCRATCH_ROW + i] = cells.normals[k * entries + start + i]
    for i in range(count):
        work[HEIGHT * SCRATCH_ROW + i] = cells.heights[start + i]
    for i in range(LANES):
        middle = load_scratch(work, PLACE * SCRATCH_ROW + i, zero)
        n = load_scratch(work, THERMAL * SCRATCH_ROW + i, zero)
        height = work[HEIGHT * SCRATCH_ROW + i]
        mean, depth, place = cut_at(virtual.density, height, n, middle, moved)
        store_scratch(work, PLACE * SCRATCH_ROW + i, place)
        work[MEAN * SCRATCH_ROW + i] = mean
        work[DEPTH * SCRATCH_ROW + i] = depth


@scalar
def count_batch(numbers, counter, purpose, work):
    """Numbers of particles: Poisson, for all cells of a batch at once."""
    most = 0.0
    for i in range(LANES):
        most = max(most, work[MEAN * SCRATCH_ROW + i])
        work[NUMBER * SCRATCH_ROW + i] = 0.0
    draw = 0
    # Inversion, for all lanes in step: chances of 0, 1, 2, ... are taken off a uniform number until
    # it is negative. Means above MOST_MEAN are drawn in parts, whose sum is Poisson again. Lanes
    # that are done go on without effect, so a number depends on its cell only.
    while most > 0.0:
        for i in range(LANES):
            a, _, _, _ = words(counter, purpose, numbers[i], draw)
            mean = min(work[MEAN * SCRATCH_ROW + i], MOST_MEAN)
            chance, left = none_found(a, mean)
            work[CHANCE * SCRATCH_ROW + i] = chance
            work[LEFT * SCRATCH_ROW + i] = left
        going, number = np.int64(1), 0.0
        while going != 0 and number < MOST_NUMBER:
            going, number = np.int64(0), number + 1.0
            for i in range(LANES):
                left = work[LEFT * SCRATCH_ROW + i]
                mean = min(work[MEAN * SCRATCH_ROW + i], MOST_MEAN)
                work[NUMBER * SCRATCH_ROW + i] += 1.0 if left > 0.0 else 0.0
                chance, left = one_more(number, mean, work[CHANCE * SCRATCH_ROW + i], left)
                work[CHANCE * SCRATCH_ROW + i] = chance
                work[LEFT * SCRATCH_ROW + i] = left
                going |= np.int64(left > 0.0)
        for i in range(LANES):
            work[MEAN * SCRATCH_ROW + i] -= min(work[MEAN * SCRATCH_ROW + i], MOST_MEAN)
        most -= MOST_MEAN
        draw += 1


@scalar
def draw_batch(physics, numbers, counter, work):
    """Thermal velocity of one particle, and energy of all about their mean; -1 where in doubt."""
    (m,), with_energy = physics.masses, needs_energy(physics.energy)
    for i in range(LANES):
        thermal = velocity_of_gas(physics, m, counter, numbers[i])
        store_scratch(work, THERMAL * SCRATCH_ROW + i, thermal)
    for i in range(LANES if with_energy else 0):
        number = work[NUMBER * SCRATCH_ROW + i]
        work[INNER * SCRATCH_ROW + i] = likely_energy(counter, numbers[i], number, physics.zero)


def fill_cells(worker, now, physics, fluid, walls):
    """Virtual particles in every cut cell, from batches of cells."""
    _fill(worker, now, of_walls(physics), fluid.cells.sums[worker.thread], walls.virtual)


@stage
def _fill(worker, now, physics, sums, virtual):
    cells, offset = virtual.per_cell, offset_of(physics.solid, now.grid)
    work, zero = cells.work[worker.thread], physics.zero
    first = virtual.starts[offset]
    begin, end = share(virtual.starts[offset + 1] - first, worker.thread, worker.threads)
    filled = 0
    # Batches of cut cells: depth of the cut, numbers and thermal velocities as vectors, then cells
    # with particles one by one. Random words follow from the number of the cell in the whole box. A
    # thread adds to its own sums, so shares change no bit.
    for start in range(begin, end, LANES):
        count = min(LANES, end - start)
        cut_batch(virtual, first + start, count, physics.solid, now.grid, work, zero)
        for i in range(count, LANES):
            work[MEAN * SCRATCH_ROW + i] = 0.0
        numbers = virtual.keys[first + start : first + start + LANES]
        count_batch(numbers, now.counter, VIRTUAL_NUMBER, work)
        draw_batch(physics, numbers, now.counter, work)
        for i in range(count):
            if work[NUMBER * SCRATCH_ROW + i] > 0.5:
                at = Place(worker.thread, filled, first + start + i, numbers[i], i)
                place_particles(virtual, at, physics, now, sums)
                filled += 1
    cells.filled[worker.thread] = filled


class Place(NamedTuple):
    """A cut cell: its thread, its number there, its entry in the tables, its number in the whole
    box, and its lane."""

    thread: int
    number: int
    entry: int
    key: int
    lane: int


@scalar
def place_particles(virtual, at, physics, now, sums):
    """The virtual particles of a lane of the batch into their cell."""
    cells, zero = virtual.per_cell, physics.zero
    d, work, entry, i = len(zero), cells.work[at.thread], at.entry, at.lane
    number = np.int64(work[NUMBER * SCRATCH_ROW + i])
    r, term = load_scratch(work, PLACE * SCRATCH_ROW + i, zero), cells.terms[entry]
    above, piece = -work[DEPTH * SCRATCH_ROW + i], cells.pieces[entry]
    u = velocity_in_solid(virtual, physics.solid, term, piece, above, r)
    v = mean_velocity(u, load_scratch(work, THERMAL * SCRATCH_ROW + i, zero), number)
    inner = work[INNER * SCRATCH_ROW + i]
    found = brought_together(physics, now, at.key, number, r, v, inner)
    start = np.uint64(virtual.cells[entry] * sums_length(len(physics.terms)))
    sums[start] += found.tallied
    add_values(sums, start + np.uint64(1), found.terms)
    for k in range(d):
        cells.state[at.thread, at.number, k] = v[k]
        cells.state[at.thread, at.number, d + k] = found.kept[k]
        cells.state[at.thread, at.number, 2 * d + k] = r[k]
    cells.state[at.thread, at.number, 3 * d] = found.mass
    cells.entry[at.thread, at.number] = entry


def recoil_per_cell(worker, now, physics, fluid, walls):
    """Add the impulse that walls take by the collision in the cells that they cut."""
    if now.flags & MEASURE_WALLS:
        _recoil(worker, now, of_walls(physics), fluid, walls.virtual)


@stage
def _recoil(worker, now, physics, fluid, virtual):
    cells, zero = virtual.per_cell, physics.zero
    d, thread = len(zero), worker.thread
    coefficients, impulse = fluid.cells.coefficients, fluid.taken.impulse[thread]
    # Momentum that virtual particles gain by the collision at t + dt, which walls take as an
    # impulse. A thread has the cells that it filled; impulses are added as integers.
    for i in range(cells.filled[thread]):
        v, kept, r = zero, zero, zero
        for k in range(d):
            v = with_item(v, k, cells.state[thread, i, k])
            kept = with_item(kept, k, cells.state[thread, i, d + k])
            r = with_item(r, k, cells.state[thread, i, 2 * d + k])
        entry = cells.entry[thread, i]
        record = np.uint64(virtual.cells[entry] * record_length(len(physics.coefficients)))
        needed = load_values(coefficients, record, physics.coefficients)
        particles = cells.state[thread, i, 3 * d], v, kept
        take_gain(physics, now.grid, needed, particles, r, cells.terms[entry], impulse)
