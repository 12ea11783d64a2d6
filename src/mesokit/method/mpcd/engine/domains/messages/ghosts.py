"""Ghosts: particles of this rank in cells beyond its halo.

Their terms are noted one by one and sent to the owners of their cells. They are few: fast particles
since the last migration, beads of long molecules, and particles that cross an end of the box whose
images slide.
"""

import numpy as np

from mesokit.loops.layout import LANES, SCRATCH_ROW, strip_at
from mesokit.method.mpcd.engine.cpu.grid import cell_in_box
from mesokit.method.mpcd.engine.cpu.strips.rows import load_particle, load_scratch
from mesokit.method.mpcd.engine.domains.messages.shared import FAR, FAULTS, FULL, shares
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import optional, scalar, seldom

NO_OWNER = -1


@where(fluid=shares)
def note_ghosts(worker, s, fluid, cell, terms_rows, lanes, terms, tallied):
    """Note the ghosts of strip s, whose terms have just been added to the sums."""
    cells = fluid.cells
    width = cells.shared.ghost_terms.shape[2]
    # Ghosts have the spare cell behind all held cells, which collects their terms. Its count is 0
    # for nearly all strips, so that the loop over lanes is seldom needed.
    sums, spare = cells.sums[worker.thread], np.uint64(cells.number) * np.uint64(width)
    if sums[spare] != 0:
        _note_lanes(worker, s, cells, cell, terms_rows, lanes, terms, tallied)
        for k in range(width):
            sums[spare + np.uint64(k)] = 0


@seldom
def _note_lanes(worker, s, cells, cell, terms_rows, lanes, terms, tallied):
    shared, thread = cells.shared, worker.thread
    rows = len(terms)
    for i in range(lanes):
        if cell[i] == cells.number:
            n = shared.ghosts[thread, 0]
            if n == shared.ghost_place.shape[1]:
                shared.noted[FAULTS] |= FULL
                return
            shared.ghosts[thread, 0] = n + 1
            shared.ghost_place[thread, n] = s * LANES + i
            row = terms_rows[rows * SCRATCH_ROW :]
            shared.ghost_terms[thread, n, 0] = optional(load_scratch(row, i, tallied), 1)
            for k in range(rows):
                shared.ghost_terms[thread, n, 1 + k] = terms_rows[k * SCRATCH_ROW + i]


@where(fluid=shares)
def note_ghost(worker, fluid, lane, terms, tallied):
    """Note the particle in a lane, counted through the strips, if it is a ghost.

    What the spare cell has of it is cleared by `note_ghosts`.
    """
    cells, thread = fluid.cells, worker.thread
    if fluid.particles.cell[lane] == cells.number:
        shared = cells.shared
        n = shared.ghosts[thread, 0]
        if n == shared.ghost_place.shape[1]:
            shared.noted[FAULTS] |= FULL
        else:
            shared.ghosts[thread, 0] = n + 1
            shared.ghost_place[thread, n] = lane
            shared.ghost_terms[thread, n, 0] = tallied
            for k in range(len(terms)):
                shared.ghost_terms[thread, n, 1 + k] = terms[k]


@scalar
def owner_of(shared, place):
    """The partner that owns a cell, and its number there; NO_OWNER if no partner owns it."""
    # Blocks do not overlap, so the first partner that has the cell is its owner. Its region may
    # begin below 0, across an end of the box; numbers there count from the first cell of it.
    for p in range(shared.blocks.shape[0]):
        inside, number, stride = True, np.int64(0), np.int64(1)
        for k in range(len(place)):
            i = np.int64(place[k])
            inside &= shared.blocks[p, 0, k] <= i < shared.blocks[p, 1, k]
            local = i - shared.regions[p, 0, k]
            local -= shared.cells[k] if local >= shared.cells[k] else 0
            number += local * stride
            stride *= shared.regions[p, 1, k]
        if inside:
            return p, number
    return NO_OWNER, np.int64(0)


@scalar
def find_owners(worker, now, physics, fluid):
    """Find the owners of the cells of this thread's ghosts."""
    shared, particles, t = fluid.cells.shared, fluid.particles, worker.thread
    for n in range(shared.ghosts[t, 0]):
        place = shared.ghost_place[t, n]
        strip = particles.data[strip_at(place // LANES, particles.rows)]
        r = load_particle(strip, place % LANES, 0, physics.zero)
        owner, number = owner_of(shared, cell_in_box(r, now.grid))
        shared.ghost_owner[t, n], shared.ghost_cell[t, n] = owner, number
        if owner == NO_OWNER:
            shared.noted[FAULTS] |= FAR
