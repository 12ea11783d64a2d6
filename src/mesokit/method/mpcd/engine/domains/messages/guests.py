"""Particles in cells that this rank does not know: it notes what they add, and asks for their cell.

They are few: those that went far since they were last given away, beads of long molecules, and
those that cross an end of the box whose images slide.
"""

import numpy as np

from mesokit.loops.layout import LANES, SCRATCH_ROW, strip_at
from mesokit.method.mpcd.engine.cpu.grid import cell_in_box
from mesokit.method.mpcd.engine.cpu.strips.rows import load_particle, load_scratch
from mesokit.method.mpcd.engine.domains.messages.shared import FAR, FAULTS, FULL, shares
from mesokit.scalar.jit import by_type, optional, scalar, seldom

NOBODY = -1


@by_type
def note_guests(team, s, fluid, cell, terms_rows, lanes, terms, tallied):
    """Note the particles of strip s, which has just been added up, whose cells are not known."""
    if not shares(fluid):
        return lambda team, s, fluid, cell, terms_rows, lanes, terms, tallied: None
    return _note


def _note(team, s, fluid, cell, terms_rows, lanes, terms, tallied):
    cells = fluid.cells
    width = cells.shared.guest_terms.shape[2]
    sums, spare = cells.sums[team.thread], np.uint64(cells.number) * np.uint64(width)
    if sums[spare] != 0:
        _note_lanes(team, s, cells, cell, terms_rows, lanes, terms, tallied)
        for k in range(width):
            sums[spare + np.uint64(k)] = 0


@seldom
def _note_lanes(team, s, cells, cell, terms_rows, lanes, terms, tallied):
    shared, thread = cells.shared, team.thread
    rows = len(terms)
    for i in range(lanes):
        if cell[i] == cells.number:
            n = shared.guests[thread, 0]
            if n == shared.guest_place.shape[1]:
                shared.noted[FAULTS] |= FULL
                return
            shared.guests[thread, 0] = n + 1
            shared.guest_place[thread, n] = s * LANES + i
            row = terms_rows[rows * SCRATCH_ROW :]
            shared.guest_terms[thread, n, 0] = optional(load_scratch(row, i, tallied), 1)
            for k in range(rows):
                shared.guest_terms[thread, n, 1 + k] = terms_rows[k * SCRATCH_ROW + i]


@scalar
def owner_of(shared, place):
    """The partner whose cell that is, and its number there; NOBODY if it is no partner's."""
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
    return NOBODY, np.int64(0)


@scalar
def find_owners(team, now, physics, fluid):
    """Whose cells the guests of this thread are in."""
    shared, particles, t = fluid.cells.shared, fluid.particles, team.thread
    for n in range(shared.guests[t, 0]):
        place = shared.guest_place[t, n]
        strip = particles.data[strip_at(place // LANES, particles.rows)]
        r = load_particle(strip, place % LANES, 0, physics.zero)
        owner, number = owner_of(shared, cell_in_box(r, now.grid))
        shared.guest_owner[t, n], shared.guest_cell[t, n] = owner, number
        if owner == NOBODY:
            shared.noted[FAULTS] |= FAR
