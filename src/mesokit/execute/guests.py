"""Virtual particles of solids of any shape: a gas in the solid part of the cells they cut.

Each step draws, uniform over the cut cells of its grid, as many places as the fluid would have
particles there, and keeps those that lie in a solid: their number in a cell is then that of an
ideal gas in the solid part of the cell, whatever its shape. What a gas at the surface's velocity
lacks, the fluid's own profile gives, as for plates (see `wall_flow`), which is followed at each
piece of surface (see `near_flow`).
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.execute.bounce import take
from mesokit.execute.cell_energy import tally, untangled
from mesokit.execute.chart import offset_of
from mesokit.execute.flags import MEASURE_WALLS
from mesokit.execute.layout import LANES, ROW, share, strip_at, sums_length
from mesokit.execute.lumps import Lumps, fill_lumps, lumps_recoil
from mesokit.execute.near_flow import flow_at
from mesokit.execute.rows import load, mass_of, store
from mesokit.execute.stages import add_strip, bin_strip, collide_strip, gather_strip
from mesokit.geometry.bodies import (
    BODY,
    FILLS,
    from_pivot,
    home_cell,
    in_box,
    nearest,
    part_normal,
    surface_number,
    surface_velocity,
)
from mesokit.pointer import whole, word
from mesokit.random import BODY_POSITION, BODY_VELOCITY, normals, unit_open, words
from mesokit.scalar import added, added_scaled, by_type, first, scalar, scaled, seldom

TRIES = 32  # to find a place in the solid part of a cell that is to be topped up
KINDS = 1024  # masses to draw from, in a mixture


class Guests(NamedTuple):
    """Tables and memory of the virtual particles; arrays, `threads` first where each has its own.

    density: particles per cell. first_number: their numbers follow those of the fluid's.
    starts (offsets + 1,), cells, corners (entries, d): cut cells for each offset of the grid, and
    their lower corners in the grid.
    pieces: number of the piece of surface in each cell of the box, or -1.
    outward, probes (pieces, d): its normal, and where first to look for fluid; terms (pieces,).
    rates (pieces, columns): what is known of the flow there.
    masses: those of mixtures.
    data, cell, number, term (threads, ...), filled (threads,): the virtual particles of this step.
    lumps: Lumps, or () where they come one by one.
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
    lumps: Any


@by_type
def fill_guests(guests, tops_up, thread, threads, *rest):
    """Fill all cut cells, unless there are none, or they are to be topped up."""
    if len(guests) == 0 or len(tops_up) == 1:
        return lambda *_: None
    return _fill_lumps if lumps_of(guests) else _fill


def lumps_of(guests: Any) -> bool:
    """Whether the virtual particles of a cell come as lumps, from the numba type of `Guests`."""
    lumps = guests.types[guests.fields.index("lumps")]
    return getattr(lumps, "instance_class", None) is Lumps


def _fill_lumps(
    guests, tops_up, thread, threads, what, physics, counter, grid, rows, sums, gathered, quanta,
    impulse, like, terms, scales,
):  # fmt: skip
    fill_lumps(
        guests, thread, threads, what, physics, counter, grid, sums, impulse, like, terms, scales
    )


def _fill(
    guests, tops_up, thread, threads, what, physics, counter, grid, rows, sums, gathered, quanta,
    impulse, like, terms, scales,
):  # fmt: skip
    solid = physics.solid
    offset = offset_of(solid, grid)
    start = guests.starts[offset]
    entries = guests.starts[offset + 1] - start
    a, _, _, _ = words(counter, BODY_POSITION, 0, 1)
    total = int(guests.density * entries + unit_open(a))
    begin, end = share(total, thread, threads)
    count = 0
    for j in range(begin, end):
        a, b, c, e = words(counter, BODY_POSITION, j, 0)
        entry = start + int((a * np.uint64(entries)) >> np.uint64(32))
        part_of_cell = first((unit_open(b), unit_open(c), unit_open(e)), like)
        r = in_grid(guests.corners, entry, part_of_cell, grid)
        if settle(guests, thread, physics, r, j, count, rows, like):
            count += 1
    draw_velocities(
        guests, thread, what, physics, counter, grid, count, rows, sums, gathered, quanta, impulse,
        like, terms, scales,
    )  # fmt: skip


@scalar
def in_grid(corners, entry, place, grid):
    """A place in a cell of the grid, from numbers between 0 and 1."""
    for k in range(len(place)):
        place = tuple_setitem(place, k, corners[entry, k] + place[k] - grid.origin[k])
    return place


@seldom
def settle(guests, thread, physics, r, number, count, rows, like):
    """Note a virtual particle at r, with the mean velocity of the gas there, if that is solid."""
    solid = physics.solid
    x = in_box(solid, r)
    clear, part, term = nearest(solid.tables, x)
    if clear >= 0.0 or surface_number(solid.tables, term, FILLS) < 0.5:
        return False
    foot = in_box(solid, added_scaled(x, -clear, part_normal(solid.tables, part, x)))
    u = surface_velocity(solid.tables, term, x)
    piece = guests.pieces[home_cell(solid.tables, foot)]
    if piece >= 0:
        u = added(u, flow_at(guests.rates, piece, clear, like))
    strip = guests.data[thread][strip_at(count // LANES, rows)]
    store(strip, count % LANES, 0, r + u)
    if len(physics.masses) == 0:
        mass = guests.masses[number % KINDS]
        strip[2 * len(like) * ROW + count % LANES] = mass
    guests.number[thread, count] = guests.first_number + number
    guests.term[thread, count] = term
    return True


@scalar
def draw_velocities(
    guests, thread, what, physics, counter, grid, count, rows, sums, gathered, quanta, impulse,
    like, terms, scales,
):  # fmt: skip
    """Thermal velocities about the mean, cells, and what the particles add to the sums."""
    d = len(like)
    guests.filled[thread] = count
    for s in range((count + LANES - 1) // LANES):
        strip, lanes = guests.data[thread][strip_at(s, rows)], min(LANES, count - s * LANES)
        here = guests.cell[thread, s * LANES : (s + 1) * LANES]
        who = guests.number[thread, s * LANES : (s + 1) * LANES]
        for i in range(LANES):
            r, u = load(strip, i, 0, like), load(strip, i, d, like)
            a, b, c, e = words(counter, BODY_VELOCITY, who[i], 0)
            m = mass_of(physics.masses, strip, i, 2 * d)
            thermal = math.sqrt(physics.kT / max(m, 1e-300))
            store(strip, i, 0, r + added(u, scaled(thermal, normals(like, a, b, c, e))))
        if what & MEASURE_WALLS:
            momentum(guests, thread, physics, s, strip, lanes, impulse, scales[0], -1.0, like)
        bin_strip(physics, counter, grid, strip, here, who, quanta, scales, like)
        add_strip(here, quanta, sums, lanes, terms, tally(physics.energy, 0.0, like))


@scalar
def momentum(guests, thread, physics, s, strip, lanes, impulse, scale, sign, like):
    """Add the momentum of virtual particles, as part of the body in which they lie."""
    d, solid = len(like), physics.solid
    for i in range(lanes):
        r, v = load(strip, i, 0, like), load(strip, i, d, like)
        term = guests.term[thread, s * LANES + i]
        m = mass_of(physics.masses, strip, i, 2 * d)
        lever = from_pivot(solid.tables, term, in_box(solid, r))
        take(impulse, whole(word(solid.tables, BODY), term), lever, scaled(sign * m, v), scale)


@by_type
def recoil(guests, thread, what, *rest):
    """What bodies take by the collision of the virtual particles in them."""
    if len(guests) == 0:
        return lambda *_: None
    return _lumps_recoil if lumps_of(guests) else _recoil


def _lumps_recoil(
    guests, thread, what, physics, grid, rows, coefficients, gathered, impulse, like, c, scales
):
    lumps_recoil(guests, thread, what, physics, grid, coefficients, impulse, like, c, scales)


def _recoil(
    guests, thread, what, physics, grid, rows, coefficients, gathered, impulse, like, c, scales
):
    if what & MEASURE_WALLS:
        count = guests.filled[thread]
        for s in range((count + LANES - 1) // LANES):
            strip = guests.data[thread][strip_at(s, rows)]
            here = guests.cell[thread, s * LANES : (s + 1) * LANES]
            gather_strip(here, coefficients, gathered, c)
            collide_strip(physics, grid, strip, gathered, like, c)
            lanes = min(LANES, count - s * LANES)
            momentum(guests, thread, physics, s, strip, lanes, impulse, scales[0], 1.0, like)


@by_type
def top_up_guests(guests, tops_up, thread, threads, *rest):
    """Top up each cut cell to the mean density, if that is the rule."""
    if len(guests) == 0 or len(tops_up) == 0:
        return lambda *_: None
    return _top_up


def _top_up(
    guests, tops_up, thread, threads, what, physics, counter, grid, rows, all_sums, gathered,
    quanta, impulse, like, terms, scales,
):  # fmt: skip
    """A fractional density is met on average. Places are uniform in the solid part of the cell."""
    width, most = sums_length(len(terms)), int(guests.density) + 2
    offset = offset_of(physics.solid, grid)
    start = guests.starts[offset]
    begin, end = share(guests.starts[offset + 1] - start, thread, threads)
    count = 0
    for n in range(begin, end):
        entry = start + n
        present = np.int64(0)
        for t in range(all_sums.shape[0]):
            present += untangled(physics.energy, all_sums[t, guests.cells[entry] * width])[0]
        a, _, _, _ = words(counter, BODY_POSITION, n, 1)
        for j in range(n * most, n * most + int(guests.density + unit_open(a)) - present):
            for attempt in range(TRIES):
                a, b, c, _ = words(counter, BODY_POSITION, j, 2 + attempt)
                part_of_cell = first((unit_open(a), unit_open(b), unit_open(c)), like)
                r = in_grid(guests.corners, entry, part_of_cell, grid)
                if settle(guests, thread, physics, r, j, count, rows, like):
                    count += 1
                    break
    draw_velocities(
        guests, thread, what, physics, counter, grid, count, rows, all_sums[thread], gathered,
        quanta, impulse, like, terms, scales,
    )  # fmt: skip
