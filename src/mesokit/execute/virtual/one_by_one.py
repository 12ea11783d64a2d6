"""Virtual particles of solids of any shape: a gas in the solid part of the cells they cut.

Each step draws, uniform over the cut cells of its grid, as many places as the fluid would have
particles there, and keeps those that lie in a solid: their number in a cell is then that of an
ideal gas in the solid part of the cell, whatever its shape. What a gas at the surface's velocity
lacks, the fluid's own profile gives, as for plates (see `slit_gradient`), which is followed at
each piece of surface (see `gradient`).
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.execute.cpu.groups import MEASURE_WALLS
from mesokit.execute.cpu.physics import field_of, momentum_scale
from mesokit.execute.cpu.stages import add_strip, bin_strip, collide_strip, gather_strip
from mesokit.execute.cpu.strips.cell_energy import tally
from mesokit.execute.cpu.strips.layout import LANES, ROW, share, strip_at
from mesokit.execute.cpu.strips.rows import load_particle, mass_of, store_particle
from mesokit.execute.cpu.strips.terms import number_in_cell
from mesokit.execute.cpu.threads import meet
from mesokit.execute.virtual.gas import body_takes, thermal
from mesokit.execute.virtual.gradient import flow_at
from mesokit.execute.virtual.per_cell import CellParticles
from mesokit.geometry.solids.bodies import (
    FILLS,
    home_cell,
    in_box,
    nearest,
    part_normal,
    surface_number,
    surface_velocity,
)
from mesokit.geometry.solids.clearance import offset_of
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.random import BODY_POSITION, BODY_VELOCITY, unit_open, words
from mesokit.scalar.vector import added, added_scaled, first, scaled

TRIES = 32  # to find a place in the solid part of a cell that is to be topped up
KINDS = 1024  # masses to draw from, in a mixture


class SolidParticles(NamedTuple):
    """Tables and memory of the virtual particles; arrays, `threads` first where each has its own.

    density: particles per cell. first_number: their numbers follow those of the fluid's.
    starts (offsets + 1,), cells, corners (entries, d): cut cells for each offset of the grid, and
    their lower corners in the grid.
    pieces: number of the piece of surface in each cell of the box, or -1.
    outward, probes (pieces, d): its normal, and where first to look for fluid; terms (pieces,).
    rates (pieces, columns): what is known of the flow there.
    masses: those of mixtures.
    data, cell, number, term (threads, ...), filled (threads,): the virtual particles of this step.
    per_cell: CellParticles, or () where they come one by one.
    """

    density: float
    first_number: int
    starts: Any
    cells: Any
    corners: Any
    pieces: Any
    outward: Any
    probes: Any
    terms: Any
    rates: Any
    masses: Any
    data: Any
    cell: Any
    number: Any
    term: Any
    filled: Any
    per_cell: Any


def drawn_per_cell(walls: Any) -> bool:
    """Whether those of a cell are drawn all at once, from the numba type of `Walls`."""
    per_cell = field_of(field_of(walls, "solids"), "per_cell")
    return getattr(per_cell, "instance_class", None) is CellParticles


def fill_solids(team, now, physics, fluid, walls):
    """Fill all cut cells, whose number of particles is that of an ideal gas."""
    virtual, solid = walls.solids, physics.solid
    offset = offset_of(solid, now.grid)
    start = virtual.starts[offset]
    entries = virtual.starts[offset + 1] - start
    a, _, _, _ = words(now.counter, BODY_POSITION, 0, 1)
    total = int(virtual.density * entries + unit_open(a))
    begin, end = share(total, team.thread, team.threads)
    count = 0
    for j in range(begin, end):
        a, b, c, e = words(now.counter, BODY_POSITION, j, 0)
        entry = start + int((a * np.uint64(entries)) >> np.uint64(32))
        part_of_cell = first((unit_open(b), unit_open(c), unit_open(e)), physics.zero)
        r = in_grid(virtual.corners, entry, part_of_cell, now.grid)
        if place_one(virtual, team.thread, physics, r, j, count, fluid.particles.rows):
            count += 1
    draw_velocities(virtual, count, team, now, physics, fluid)


@scalar
def in_grid(corners, entry, place, grid):
    """A place in a cell of the grid, from numbers between 0 and 1."""
    for k in range(len(place)):
        place = with_item(place, k, corners[entry, k] + place[k] - grid.origin[k])
    return place


@seldom
def place_one(virtual, thread, physics, r, number, count, rows):
    """Note a virtual particle at r, with the mean velocity of the gas there, if that is solid."""
    solid, zero = physics.solid, physics.zero
    x = in_box(solid, r)
    clear, part, term = nearest(solid.tables, x)
    if clear >= 0.0 or surface_number(solid.tables, term, FILLS) < 0.5:
        return False
    foot = in_box(solid, added_scaled(x, -clear, part_normal(solid.tables, part, x)))
    u = surface_velocity(solid.tables, term, x)
    piece = virtual.pieces[home_cell(solid.tables, foot)]
    if piece >= 0:
        u = added(u, flow_at(virtual.rates, piece, clear, zero))
    strip = virtual.data[thread][strip_at(count // LANES, rows)]
    store_particle(strip, count % LANES, 0, r + u)
    if len(physics.masses) == 0:
        mass = virtual.masses[number % KINDS]
        strip[2 * len(zero) * ROW + count % LANES] = mass
    virtual.number[thread, count] = virtual.first_number + number
    virtual.term[thread, count] = term
    return True


@scalar
def draw_velocities(virtual, count, team, now, physics, fluid):
    """Thermal velocities about the mean, cells, and what the particles add to the sums."""
    thread, zero, rows = team.thread, physics.zero, fluid.particles.rows
    terms, sums = fluid.scratch.terms[thread], fluid.cells.sums[thread]
    d = len(zero)
    virtual.filled[thread] = count
    for s in range((count + LANES - 1) // LANES):
        strip, lanes = virtual.data[thread][strip_at(s, rows)], min(LANES, count - s * LANES)
        here = virtual.cell[thread, s * LANES : (s + 1) * LANES]
        who = virtual.number[thread, s * LANES : (s + 1) * LANES]
        for i in range(LANES):
            r, u = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
            m = max(mass_of(physics.masses, strip, i, 2 * d), 1e-300)
            v = added(u, thermal(physics, m, now.counter, BODY_VELOCITY, who[i], 0))
            store_particle(strip, i, 0, r + v)
        if now.flags & MEASURE_WALLS:
            take_momentum(virtual, team, physics, s, strip, fluid.taken.impulse[thread], -1.0)
        bin_strip(physics, now, strip, here, who, terms)
        add_strip(here, terms, sums, lanes, physics.terms, tally(physics.energy, 0.0, zero))


@scalar
def take_momentum(virtual, team, physics, s, strip, impulse, sign):
    """Add the momentum of virtual particles, as part of the body in which they lie."""
    solid, zero, thread = physics.solid, physics.zero, team.thread
    d, scale = len(zero), momentum_scale(physics)
    for i in range(min(LANES, virtual.filled[thread] - s * LANES)):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        term = virtual.term[thread, s * LANES + i]
        m = mass_of(physics.masses, strip, i, 2 * d)
        body_takes(impulse, solid, term, in_box(solid, r), scaled(sign * m, v), scale)


def solids_recoil(team, now, physics, fluid, walls):
    """What bodies take by the collision of the virtual particles in them."""
    virtual, thread = walls.solids, team.thread
    gathered, impulse = fluid.scratch.coefficients[thread], fluid.taken.impulse[thread]
    if now.flags & MEASURE_WALLS:
        for s in range((virtual.filled[thread] + LANES - 1) // LANES):
            strip = virtual.data[thread][strip_at(s, fluid.particles.rows)]
            here = virtual.cell[thread, s * LANES : (s + 1) * LANES]
            gather_strip(here, fluid.cells.coefficients, gathered, physics.coefficients)
            collide_strip(physics, now.grid, strip, gathered)
            take_momentum(virtual, team, physics, s, strip, impulse, 1.0)


def top_up_solids(team, now, physics, fluid, walls):
    """Top up each cut cell to the mean density.

    A fractional density is met on average. Places are uniform in the solid part of the cell.
    """
    virtual, counter, most = walls.solids, now.counter, int(walls.solids.density) + 2
    offset = offset_of(physics.solid, now.grid)
    start = virtual.starts[offset]
    begin, end = share(virtual.starts[offset + 1] - start, team.thread, team.threads)
    count = 0
    for n in range(begin, end):
        entry = start + n
        present = number_in_cell(physics, fluid.cells.sums, virtual.cells[entry])
        a, _, _, _ = words(counter, BODY_POSITION, n, 1)
        for j in range(n * most, n * most + int(virtual.density + unit_open(a)) - present):
            for attempt in range(TRIES):
                a, b, c, _ = words(counter, BODY_POSITION, j, 2 + attempt)
                part_of_cell = first((unit_open(a), unit_open(b), unit_open(c)), physics.zero)
                r = in_grid(virtual.corners, entry, part_of_cell, now.grid)
                if place_one(virtual, team.thread, physics, r, j, count, fluid.particles.rows):
                    count += 1
                    break
    draw_velocities(virtual, count, team, now, physics, fluid)
    meet(team)
