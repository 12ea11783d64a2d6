"""What one thread does for virtual particles that are drawn all of a cell at once.

As on the processor (see `virtual.per_cell`), a cut cell after the other: a thread has one. What its
collision gives the wall is found from a record that the thread leaves in the memory of the device.
"""

import numpy as np

from mesokit.geometry.solids.clearance import offset_of
from mesokit.loops.layout import record_length, sums_length
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_WALLS
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import needs_energy
from mesokit.method.mpcd.engine.virtual.gradient import EVERY, follow_piece
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
from mesokit.scalar.jit import elementwise, scalar
from mesokit.scalar.pointer import add_words, put_real, put_reals, real, reals, word
from mesokit.scalar.poisson import poisson_number
from mesokit.scalar.random import VIRTUAL_NUMBER


@scalar
def cut_cell(i, solid, grid, walls):
    """The entry in the tables of the ith cell that is cut at this offset of the grid, or -1."""
    offset = offset_of(solid, grid)
    entry = word(walls.starts, offset) + i
    return entry if entry < word(walls.starts, offset + 1) else -1


@scalar
def fill_cell(i, physics, now, fluid, walls):
    """The virtual particles of a cut cell, and what they bring to its sums."""
    entry = cut_cell(i, physics.solid, now.grid, walls)
    if entry >= 0:
        planes, zero, key = walls.planes, physics.zero, word(walls.keys, entry)
        n = _column(planes.normals, planes.entries, entry, zero)
        middle = _column(planes.places, planes.entries, entry, zero)
        moved = moved_from_middle(physics.solid, now.grid, zero)
        height = real(planes.heights, entry)
        mean, depth, r = cut_at(walls.density, height, n, middle, moved)
        number = np.int64(poisson_number(mean, now.counter, VIRTUAL_NUMBER, key))
        if number > 0:
            place_in_cell(i, physics, now, fluid, walls, (entry, key, number), depth, r)
        elif now.flags & MEASURE_WALLS:
            put_real(walls.records, i * record_of_cell(zero), 0.0)


@elementwise
def _column(values, entries, entry, pattern):
    return "real(values, {k} * entries + entry)"


@scalar
def record_of_cell(zero):
    """Numbers that a cell leaves: mass, or 0 where it has no particle, velocity, velocity kept for
    the collision, and place."""
    return 1 + 3 * len(zero)


@scalar
def place_in_cell(i, physics, now, fluid, walls, filled, depth, r):
    """Add virtual particles at a mean depth and place; `filled`: entry and key of the cell, and
    their number."""
    entry, key, number = filled
    planes, zero, (m,) = walls.planes, physics.zero, physics.masses
    term, piece = word(planes.terms, entry), word(planes.pieces, entry)
    u = velocity_in_solid(walls, physics.solid, term, piece, -depth, r)
    v = mean_velocity(u, velocity_of_gas(physics, m, now.counter, key), number)
    inner = 0.0
    if needs_energy(physics.energy):
        inner = likely_energy(now.counter, key, float(number), zero)
    found = brought_together(physics, now, key, number, r, v, inner)
    start = word(walls.cells, entry) * sums_length(len(physics.terms))
    add_words(fluid.sums, start, (found.tallied,) + found.terms)
    if now.flags & MEASURE_WALLS:
        record = (found.mass,) + v + found.kept + r
        put_reals(walls.records, i * record_of_cell(zero), record)


@scalar
def recoil_cell(i, physics, now, fluid, walls):
    """Add the impulse that the wall takes by the collision in the ith cell that it cuts."""
    entry = cut_cell(i, physics.solid, now.grid, walls)
    if entry >= 0:
        zero, start = physics.zero, i * record_of_cell(physics.zero)
        d, mass = len(zero), real(walls.records, start)
        if mass > 0.0:
            v = reals(walls.records, start + 1, zero)
            kept = reals(walls.records, start + 1 + d, zero)
            r = reals(walls.records, start + 1 + 2 * d, zero)
            record = word(walls.cells, entry) * record_length(len(physics.coefficients))
            needed = reals(fluid.coefficients, record, physics.coefficients)
            term = word(walls.planes.terms, entry)
            take_gain(physics, now.grid, needed, (mass, v, kept), r, term, fluid.impulse)


@scalar
def follow(i, physics, now, fluid, walls):
    """Update the flow at the ith of the pieces of surface that have their turn at this step."""
    e = np.int64(now.counter.step) % EVERY + EVERY * i
    if e < walls.number_of_pieces:
        follow_piece(walls, e, physics, now.grid, fluid.sums)
