"""What one thread does for virtual particles that are drawn one by one (see `virtual.one_by_one`).

A thread has a cut cell. Where walls are measured, each particle leaves a record at the next free
place: their order is that in which threads came, and no bit depends on it.
"""

import numpy as np

from mesokit.loops.layout import record_length, sums_length
from mesokit.method.mpcd.collision.protocol import collide
from mesokit.method.mpcd.engine.cpu.grid import cell_index, in_cell
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_WALLS
from mesokit.method.mpcd.engine.cpu.strips.terms import brought, number_in_cell
from mesokit.method.mpcd.engine.cuda.kernels.virtual import cut_cell
from mesokit.method.mpcd.engine.virtual.of_cell import velocity_of_gas
from mesokit.method.mpcd.engine.virtual.one_by_one import (
    TRIES,
    drawn_place,
    number_missing,
    take_particle,
)
from mesokit.method.mpcd.engine.virtual.particles import MOST
from mesokit.scalar.jit import optional, scalar, seldom
from mesokit.scalar.pointer import add_words, put_reals, real, reals, take_number, whole, word
from mesokit.scalar.poisson import poisson_number
from mesokit.scalar.random import FIRST_VIRTUAL, VIRTUAL_NUMBER, VIRTUAL_POSITION, words
from mesokit.scalar.vector import added, scaled


@scalar
def fill_cell_one_by_one(i, physics, now, fluid, walls):
    """Fill a cut cell, whose number of particles is that of an ideal gas."""
    entry = cut_cell(i, physics.solid, now.grid, walls)
    if entry >= 0:
        key = word(walls.keys, entry)
        # As many places as a cell full of fluid has particles; those in solid are kept.
        for j in range(poisson_number(walls.density, now.counter, VIRTUAL_NUMBER, key)):
            number = FIRST_VIRTUAL + key * MOST + j
            bring_virtual((entry, key, number), j, physics, now, fluid, walls)


@scalar
def top_up_cell(i, physics, now, fluid, walls):
    """Top up a cut cell to the mean density."""
    entry = cut_cell(i, physics.solid, now.grid, walls)
    if entry >= 0:
        key = word(walls.keys, entry)
        present = number_in_cell(physics, fluid.sums, word(walls.cells, entry))
        # Particles of the fluid were counted before. Those of this loop lie in this cell.
        for j in range(number_missing(walls, now.counter, key, present)):
            number, missing, attempt = FIRST_VIRTUAL + key * MOST + j, True, 0
            while missing and attempt < TRIES:
                draw = j * TRIES + attempt
                missing = not bring_virtual((entry, key, number), draw, physics, now, fluid, walls)
                attempt += 1


@seldom
def bring_virtual(particle, draw, physics, now, fluid, walls):
    """Add a virtual particle to the sums of its cell, if a place drawn there is solid; whether so.

    `particle` has the entry and the key of the cell, and its own number. What it has before the
    collision is taken from the wall.
    """
    entry, key, number = particle
    drawn = words(now.counter, VIRTUAL_POSITION, key, draw)
    found = drawn_place(walls, entry, physics, now.grid, drawn)
    if not found.in_solid:
        return False
    r, term, m = found.r, found.term, found.mass
    v = added(found.u, velocity_of_gas(physics, m, now.counter, number))
    kept, terms, counted = brought(physics, now, number, m, r, v)
    start = np.int64(cell_index(r, now.grid)) * sums_length(len(physics.terms))
    add_words(fluid.sums, start, (np.int64(optional(counted, 1)),) + terms)
    if now.flags & MEASURE_WALLS:
        take_particle(physics, fluid.impulse, term, r, scaled(-m, v))
        place = take_number(walls.held, 0, 1)
        if place < walls.room:
            record = (m, float(term)) + kept + r
            put_reals(walls.records, place * record_of_particle(physics.zero), record)
    return True


@scalar
def record_of_particle(zero):
    """Numbers that a virtual particle leaves: mass, surface, velocity that it keeps, place."""
    return 2 + 2 * len(zero)


@scalar
def recoil_particle(thread, physics, now, fluid, walls, threads):
    """Give the wall what virtual particles have after the collision, every `threads`th of them."""
    zero = physics.zero
    for j in range(thread, min(whole(walls.held, 0), walls.room), threads):
        start = j * record_of_particle(zero)
        m, term = real(walls.records, start), np.int64(real(walls.records, start + 1))
        kept = reals(walls.records, start + 2, zero)
        r = reals(walls.records, start + 2 + len(zero), zero)
        record = np.int64(cell_index(r, now.grid)) * record_length(len(physics.coefficients))
        needed = reals(fluid.coefficients, record, physics.coefficients)
        after = collide(physics.rule, needed, kept, in_cell(r, now.grid))
        take_particle(physics, fluid.impulse, term, r, scaled(m, after))
