"""Virtual particles of walls, all of a cell at once.

If a rule needs only number, momentum and energy of a cell's particles, these need not be drawn one
by one. The solid part of a cut cell holds a Poisson number N of them; their
momentum is that of one particle N times as heavy, and the energy of their motion about their mean
is kT/2 times a chi-square number of d (N - 1) degrees of freedom. The part that is solid follows
from a plane for each cut cell and offset of the grid: tables give its normal and its height,
which moves with the shift.
"""

import math
from typing import NamedTuple

import numpy as np

from mesokit.geometry.protocol import surface_flow
from mesokit.geometry.solids.clearance import offset_of, offsets_along
from mesokit.geometry.solids.cut_cube import share_and_depth
from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, SCRATCH_ROW, record_length, share, sums_length
from mesokit.method.mpcd.collision.protocol import collide, contribute
from mesokit.method.mpcd.engine.cpu.bounce import body_takes
from mesokit.method.mpcd.engine.cpu.grid import in_cell
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_WALLS
from mesokit.method.mpcd.engine.cpu.physics import momentum_scale, of_walls
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import (
    many_energy_term,
    many_tally,
    needs_energy,
)
from mesokit.method.mpcd.engine.cpu.strips.rows import load_scratch, load_values, store_scratch
from mesokit.method.mpcd.engine.virtual.gradient import flow_at
from mesokit.method.mpcd.engine.virtual.particles import MOST
from mesokit.scalar.fixed_point import ROUNDER_BITS, rounded
from mesokit.scalar.gamma import gamma_number, likely
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.poisson import MOST_MEAN, MOST_NUMBER, none_found, one_more
from mesokit.scalar.random import FIRST_VIRTUAL, VIRTUAL_NUMBER, VIRTUAL_VELOCITY, normals, words
from mesokit.scalar.vector import added, added_scaled, dot, scaled

ROWS = 14  # of the scratch memory of a batch of cells
# The first four are followed by as many rows as there are axes.
PLACE, THERMAL, MEAN, DEPTH, NUMBER, CHANCE, LEFT, INNER, HEIGHT = 0, 3, 6, 7, 8, 9, 10, 11, 12


@scalar
def cut_batch(virtual, start, count, solid, grid, work, zero):
    """Mean number of particles in the solid of each cell, their mean depth, and their mean place.

    The place is in the image of the cell next to the term, which may lie beyond an end of the box.
    """
    cells, d, moved, many = virtual.per_cell, len(zero), zero, offsets_along(solid, zero)
    entries = len(cells.heights)
    for k in range(d):  # the displacement of the grid from the middle of its interval of offsets
        within = grid.origin[k] * many
        moved = with_item(moved, k, (within - floor(within) - 0.5) / many)
    # Tables have a row for each axis and the batch any start in them, so rows are copied first. The
    # last loop then is one over vectors.
    for k in range(d):
        for i in range(count):
            work[(PLACE + k) * SCRATCH_ROW + i] = cells.places[k * entries + start + i]
        for i in range(count):  # of which the room is needed later
            work[(THERMAL + k) * SCRATCH_ROW + i] = cells.normals[k * entries + start + i]
    for i in range(count):
        work[HEIGHT * SCRATCH_ROW + i] = cells.heights[start + i]
    # Plane and cell are shifted against each other by the grid shift of the step, in cells. The
    # height of the middle over the plane changes, the normal does not.
    for i in range(LANES):
        middle = load_scratch(work, PLACE * SCRATCH_ROW + i, zero)
        n = load_scratch(work, THERMAL * SCRATCH_ROW + i, zero)
        height = work[HEIGHT * SCRATCH_ROW + i] - dot(n, moved)
        part, depth = share_and_depth(height, n)
        # all fluid or all solid: then no particle of the fluid is there
        cut = (part > 0.0) & (part < 1.0)
        middle = added_scaled(middle, -1.0, moved)
        store_scratch(work, PLACE * SCRATCH_ROW + i, added_scaled(middle, -(height + depth), n))
        work[MEAN * SCRATCH_ROW + i] = virtual.density * part if cut else 0.0
        work[DEPTH * SCRATCH_ROW + i] = depth


@scalar
def count_batch(numbers, counter, work):
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
            a, _, _, _ = words(counter, VIRTUAL_NUMBER, numbers[i], draw)
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
    zero = physics.zero
    (m,), with_energy = physics.masses, needs_energy(physics.energy)
    spread = math.sqrt(physics.kT / m)
    for i in range(LANES):
        a, b, c, e = words(counter, VIRTUAL_VELOCITY, numbers[i], 0)
        store_scratch(work, THERMAL * SCRATCH_ROW + i, scaled(spread, normals(zero, a, b, c, e)))
    for i in range(LANES if with_energy else 0):
        _, _, a, b = words(counter, VIRTUAL_NUMBER, numbers[i], 0)
        freedom = max(len(zero) * (work[NUMBER * SCRATCH_ROW + i] - 1.0), 0.0)
        value, sure = likely(a, b, freedom)
        work[INNER * SCRATCH_ROW + i] = value if sure else -1.0


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
        count_batch(numbers, now.counter, work)
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
    solid, cells, zero = physics.solid, virtual.per_cell, physics.zero
    d, work, entry, i = len(zero), cells.work[at.thread], at.entry, at.lane
    number = np.int64(work[NUMBER * SCRATCH_ROW + i])
    r = load_scratch(work, PLACE * SCRATCH_ROW + i, zero)
    term, piece = cells.terms[entry], cells.pieces[entry]
    u = surface_flow(solid, term, r)
    if piece >= 0:
        u = added(u, flow_at(virtual.rates, piece, -work[DEPTH * SCRATCH_ROW + i], zero))
    (m,), thermal = physics.masses, load_scratch(work, THERMAL * SCRATCH_ROW + i, zero)
    mass = m * number
    v = added_scaled(u, 1.0 / math.sqrt(float(number)), thermal)
    inner = 0.0
    if needs_energy(physics.energy):
        inner = work[INNER * SCRATCH_ROW + i]
        if inner < 0.0:
            inner = gamma_number(float(d * (number - 1)), now.counter, VIRTUAL_NUMBER, at.key)
        inner *= 2.0 * physics.kT
    key = (FIRST_VIRTUAL + at.key * MOST, 0)
    kept, own = contribute(physics.rule, now.counter, key, mass, v, in_cell(r, now.grid))
    width = sums_length(len(physics.terms))
    m_v_squared = inner
    for k in range(d):
        m_v_squared += mass * v[k] * v[k]
    terms = scaled(mass, v) + many_energy_term(physics.energy, m_v_squared) + own
    tallied = many_tally(physics.energy, number, m_v_squared)
    start = np.uint64(virtual.cells[entry] * width)
    sums[start] += tallied
    whole = rounded(terms, physics.scales)
    for k in range(len(whole)):  # each is of `number` particles, which are rounded one by one else
        place = start + np.uint64(k + 1)
        sums[place] += whole[k] + np.int64(number - 1) * np.int64(ROUNDER_BITS)
    for k in range(d):
        cells.state[at.thread, at.number, k] = v[k]
        cells.state[at.thread, at.number, d + k] = kept[k]
        cells.state[at.thread, at.number, 2 * d + k] = r[k]
    cells.state[at.thread, at.number, 3 * d] = mass
    cells.entry[at.thread, at.number] = entry


def recoil_per_cell(worker, now, physics, fluid, walls):
    """Add the impulse that walls take by the collision in the cells that they cut."""
    if now.flags & MEASURE_WALLS:
        _recoil(worker, now, of_walls(physics), fluid, walls.virtual)


@stage
def _recoil(worker, now, physics, fluid, virtual):
    solid, cells, zero = physics.solid, virtual.per_cell, physics.zero
    d, thread, scale = len(zero), worker.thread, momentum_scale(physics)
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
        after = collide(physics.rule, needed, kept, in_cell(r, now.grid))
        given = scaled(cells.state[thread, i, 3 * d], added_scaled(after, -1.0, v))
        body_takes(impulse, solid, cells.terms[entry], r, given, scale)
