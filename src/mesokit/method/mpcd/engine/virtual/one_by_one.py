"""Virtual particles of walls one by one, for mixtures and rules that need more than sums.

Each cut cell draws as many places as the fluid would have particles there, a Poisson number, and
keeps those that lie in a solid: their number is then that of an ideal gas in the solid part of the
cell, whatever its shape. What a gas at the surface's velocity lacks, the fluid's own profile gives
(see `gradient`).
"""

from typing import NamedTuple

import numpy as np

from mesokit.geometry.protocol import homed, nearest_surface, unit_cell
from mesokit.geometry.solids.clearance import offset_of
from mesokit.loops.layout import LANES, ROW, share, strip_at
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.cpu.bounce import body_takes
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_WALLS
from mesokit.method.mpcd.engine.cpu.physics import field_of, momentum_scale
from mesokit.method.mpcd.engine.cpu.stages import add_strip, bin_strip, collide_strip, gather_strip
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import tally
from mesokit.method.mpcd.engine.cpu.strips.rows import lane_mass, load_particle, store_particle
from mesokit.method.mpcd.engine.cpu.strips.terms import number_in_cell
from mesokit.method.mpcd.engine.virtual.of_cell import velocity_in_solid, velocity_of_gas
from mesokit.method.mpcd.engine.virtual.particles import KINDS, MOST
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import by_type, elementwise, scalar, seldom
from mesokit.scalar.pointer import element, integer, numbers_in
from mesokit.scalar.poisson import poisson_number
from mesokit.scalar.random import (
    FIRST_VIRTUAL,
    VIRTUAL_NUMBER,
    VIRTUAL_POSITION,
    unit_open,
    words,
)
from mesokit.scalar.vector import added, first, scaled

TRIES = 32  # to find a place in the solid part of a cell that is to be topped up


def fill_one_by_one(worker, now, physics, fluid, walls):
    """Fill all cut cells, whose number of particles is that of an ideal gas."""
    virtual, solid, counter = walls.virtual, physics.solid, now.counter
    offset = offset_of(solid, now.grid)
    start = virtual.starts[offset]
    begin, end = share(virtual.starts[offset + 1] - start, worker.thread, worker.threads)
    count = 0
    # Each cut cell draws as many places as a cell full of fluid has particles, and keeps those in
    # solid: the rest is again Poisson. Numbers and places follow from the cell's number in the
    # whole box, so neither threads nor ranks matter.
    for entry in range(start + begin, start + end):
        key = virtual.keys[entry]
        for j in range(poisson_number(virtual.density, counter, VIRTUAL_NUMBER, key)):
            drawn = words(counter, VIRTUAL_POSITION, key, j)
            at = Candidate(worker.thread, count, entry, FIRST_VIRTUAL + key * MOST + j)
            count += place_one(virtual, at, physics, now.grid, drawn, fluid.particles.rows)
    draw_velocities(virtual, count, worker, now, physics, fluid)


class Drawn(NamedTuple):
    """A place drawn in a cut cell: whether it is in a solid, and then the place, the mean velocity
    there, the surface, and the mass of a particle. The place is in the image of the cell."""

    in_solid: bool
    r: tuple
    u: tuple
    term: int
    mass: float


@scalar
def drawn_place(virtual, entry, physics, grid, drawn):
    """The place in a cut cell that follows from random words; tables are arrays or addresses."""
    solid, zero = physics.solid, physics.zero
    a, b, c, e = drawn
    corner = numbers_in(virtual.corners, entry, len(zero), 0, zero)
    within = first((unit_open(a), unit_open(b), unit_open(c)), zero)
    r = _in_cell(corner, grid.origin, within)
    x = homed(solid, r)
    clear, term, foot = nearest_surface(solid, x)
    if clear >= 0.0:
        return Drawn(False, r, zero, term, 0.0)
    piece = integer(virtual.pieces, unit_cell(solid, foot))
    u = velocity_in_solid(virtual, solid, term, piece, clear, x)
    return Drawn(True, r, u, term, drawn_mass(physics.masses, virtual, e))


@elementwise
def _in_cell(corner, origin, within):
    return "corner[{k}] + within[{k}] - origin[{k}]"


@by_type
def drawn_mass(masses, virtual, word):
    """Mass of a virtual particle: that of all, or one of a mixture's, by a random word."""
    if len(masses) == 1:
        return lambda masses, virtual, word: masses[0]

    def of_some(masses, virtual, word):
        return element(virtual.masses, np.int64((word * np.uint64(KINDS)) >> np.uint64(32)))

    return of_some


@scalar
def number_missing(virtual, counter, key, present):
    """How many particles are missing from a cell that holds so many of the fluid."""
    a, _, _, _ = words(counter, VIRTUAL_NUMBER, key, 0)
    return int(virtual.density + unit_open(a)) - present


@scalar
def take_particle(physics, impulse, term, r, momentum):
    """Add the momentum of a virtual particle at r, which is part of the wall in which it lies."""
    x = homed(physics.solid, r)
    body_takes(impulse, physics.solid, term, x, momentum, momentum_scale(physics))


class Candidate(NamedTuple):
    """A possible virtual particle: thread, number of those held, cut cell and particle number."""

    thread: int
    held: int
    entry: int
    number: int


@seldom
def place_one(virtual, at, physics, grid, drawn, rows):
    """Note a virtual particle at a place drawn in a cell, with the mean velocity of the gas there,
    if that is solid; 1 if it is, else 0."""
    found = drawn_place(virtual, at.entry, physics, grid, drawn)
    if not found.in_solid or at.held >= virtual.term.shape[1]:
        return 0
    strip, lane = virtual.data[at.thread][strip_at(at.held // LANES, rows)], at.held % LANES
    store_particle(strip, lane, 0, found.r + found.u)
    if len(physics.masses) == 0:
        strip[2 * len(physics.zero) * ROW + lane] = found.mass
    virtual.number[at.thread, at.held] = at.number
    virtual.term[at.thread, at.held] = found.term
    return 1


@scalar
def draw_velocities(virtual, count, worker, now, physics, fluid):
    """Thermal velocities about the mean, cells, and what the particles add to the sums."""
    thread, zero, rows = worker.thread, physics.zero, fluid.particles.rows
    terms, sums = fluid.scratch.terms[thread], fluid.cells.sums[thread]
    d = len(zero)
    virtual.filled[thread] = count
    # The virtual particles of a thread lie in strips like those of the fluid, and pass the same
    # stages. What they bring into the collision is subtracted from what walls take; `recoil` adds
    # what they have after it.
    for s in range((count + LANES - 1) // LANES):
        strip, lanes = virtual.data[thread][strip_at(s, rows)], min(LANES, count - s * LANES)
        here = virtual.cell[thread, s * LANES : (s + 1) * LANES]
        numbers = virtual.number[thread, s * LANES : (s + 1) * LANES]
        for i in range(LANES):
            r, u = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
            m = max(lane_mass(physics.masses, strip, i, 2 * d), 1e-300)
            thermal = velocity_of_gas(physics, m, now.counter, numbers[i])
            store_particle(strip, i, 0, r + added(u, thermal))
        if now.flags & MEASURE_WALLS:
            take_momentum(virtual, worker, physics, s, strip, fluid.taken.impulse[thread], -1.0)
        bin_strip(physics, now, strip, here, numbers, terms)
        tallied = tally(physics.energy, 0.0, zero)
        add_strip(here, terms, sums, lanes, physics.terms, tallied, ())


@scalar
def take_momentum(virtual, worker, physics, s, strip, impulse, sign):
    """Add the momentum of virtual particles, as part of the wall in which they lie."""
    zero, thread = physics.zero, worker.thread
    d = len(zero)
    for i in range(min(LANES, virtual.filled[thread] - s * LANES)):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        m, term = lane_mass(physics.masses, strip, i, 2 * d), virtual.term[thread, s * LANES + i]
        take_particle(physics, impulse, term, r, scaled(sign * m, v))


def recoil_one_by_one(worker, now, physics, fluid, walls):
    """Add the impulse that walls take by the collision of the virtual particles in them."""
    virtual, thread = walls.virtual, worker.thread
    gathered, impulse = fluid.scratch.coefficients[thread], fluid.taken.impulse[thread]
    if now.flags & MEASURE_WALLS:
        for s in range((virtual.filled[thread] + LANES - 1) // LANES):
            strip = virtual.data[thread][strip_at(s, fluid.particles.rows)]
            here = virtual.cell[thread, s * LANES : (s + 1) * LANES]
            gather_strip(here, fluid.cells.coefficients, gathered, physics.coefficients, ())
            collide_strip(physics, now.grid, strip, gathered)
            take_momentum(virtual, worker, physics, s, strip, impulse, 1.0)


@where(walls=lambda walls: len(field_of(walls, "top_up")))
def top_up_walls(worker, now, physics, fluid, walls):
    """Top up each cut cell to the mean density, if a wall has this rule.

    A fractional density is met on average. Places are uniform in the solid part of the cell.
    """
    virtual, counter = walls.virtual, now.counter
    offset = offset_of(physics.solid, now.grid)
    start = virtual.starts[offset]
    begin, end = share(virtual.starts[offset + 1] - start, worker.thread, worker.threads)
    count = 0
    # `present` counts particles of the fluid of all threads and ranks, so sums must be complete. A
    # thread reads its own cut cells only, and its virtual particles lie in these: no race.
    for entry in range(start + begin, start + end):
        key = virtual.keys[entry]
        present = number_in_cell(physics, fluid.cells.sums, virtual.cells[entry])
        for j in range(number_missing(virtual, counter, key, present)):
            at = Candidate(worker.thread, count, entry, FIRST_VIRTUAL + key * MOST + j)
            for attempt in range(TRIES):
                drawn = words(counter, VIRTUAL_POSITION, key, j * TRIES + attempt)
                if place_one(virtual, at, physics, now.grid, drawn, fluid.particles.rows) == 1:
                    count += 1
                    break
    draw_velocities(virtual, count, worker, now, physics, fluid)
    barrier(worker)
