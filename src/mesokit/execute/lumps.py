"""Virtual particles of a cell, all at once: a lump.

A rule that asks only for the number, momentum and energy of a cell's particles cannot tell whether
these were drawn one by one. The solid part of a cut cell holds a Poisson number N of them; their
momentum is that of one particle N times as heavy, and the energy of their motion about their mean
is kT/2 times a chi-square number of d (N - 1) degrees of freedom. The part that is solid follows
from a plane for each cut cell and offset of the grid: tables give its normal and its height,
which moves with the shift.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.execute.bounce import take
from mesokit.execute.cell_energy import asks, many_energy_term, many_tally
from mesokit.execute.chart import offset_of, offsets_along
from mesokit.execute.fixed_point import ROUNDER_BITS, rounded
from mesokit.execute.flags import MEASURE_WALLS
from mesokit.execute.layout import LANES, SCRATCH_ROW, record_length, share, sums_length
from mesokit.execute.near_flow import flow_at
from mesokit.execute.rows import fetch, note, recall
from mesokit.execute.stages import in_cell
from mesokit.gamma import gamma_number, likely
from mesokit.geometry.bodies import BODY, from_pivot, surface_velocity
from mesokit.geometry.cut_cube import share_and_depth
from mesokit.mpcd.collision.protocol import collide, contribute
from mesokit.pointer import whole, word
from mesokit.poisson import MOST_MEAN, MOST_NUMBER, none_found, one_more
from mesokit.random import BODY_NUMBER, BODY_VELOCITY, normals, words
from mesokit.scalar import added, added_scaled, dot, scalar, scaled, seldom

ROWS = 14  # of the scratch memory of a batch of lumps
# The first four are followed by as many rows as there are axes.
PLACE, THERMAL, MEAN, DEPTH, NUMBER, CHANCE, LEFT, INNER, HEIGHT = 0, 3, 6, 7, 8, 9, 10, 11, 12


class Lumps(NamedTuple):
    """Planes of the cut cells, and the lumps of this step.

    normals (d * entries,), heights (entries,): of the middle of the cell over the surface, at the
    middle of the interval of offsets; places (d * entries,): that middle, in the box.
    terms, pieces (entries,): the body, and the piece of surface.
    work (threads, ROWS * SCRATCH_ROW): the numbers of a batch, in rows.
    state (threads, entries, 3 d + 1): velocity, velocity kept for the collision, place, mass.
    entry (threads, entries), filled (threads,).
    """

    normals: Any
    heights: Any
    places: Any
    terms: Any
    pieces: Any
    work: Any
    state: Any
    entry: Any
    filled: Any


@scalar
def moved_by(grid, like):
    """How far the grid is from the middle of its interval of offsets."""
    for k in range(len(like)):
        many = offsets_along(like)
        within = grid.origin[k] * many
        like = tuple_setitem(like, k, (within - np.floor(within) - 0.5) / many)
    return like


@scalar
def cut_batch(lumps, start, count, density, grid, work, like):
    """Mean number of particles in the solid of each cell, their mean depth, and their mean place.

    The place is in the image of the cell next to the term, which may lie beyond an end of the box.
    """
    d, entries, moved = len(like), len(lumps.heights), moved_by(grid, like)
    for k in range(d):
        for i in range(count):
            work[(PLACE + k) * SCRATCH_ROW + i] = lumps.places[k * entries + start + i]
        for i in range(count):  # of which the room is needed later
            work[(THERMAL + k) * SCRATCH_ROW + i] = lumps.normals[k * entries + start + i]
    for i in range(count):
        work[HEIGHT * SCRATCH_ROW + i] = lumps.heights[start + i]
    for i in range(LANES):
        middle = recall(work, PLACE * SCRATCH_ROW + i, like)
        n = recall(work, THERMAL * SCRATCH_ROW + i, like)
        height = work[HEIGHT * SCRATCH_ROW + i] - dot(n, moved)
        part, depth = share_and_depth(height, n)
        # all fluid or all solid: then no particle of the fluid is there
        cut = (part > 0.0) & (part < 1.0)
        middle = added_scaled(middle, -1.0, moved)
        note(work, PLACE * SCRATCH_ROW + i, added_scaled(middle, -(height + depth), n))
        work[MEAN * SCRATCH_ROW + i] = density * part if cut else 0.0
        work[DEPTH * SCRATCH_ROW + i] = depth


@scalar
def count_batch(start, counter, work):
    """Numbers of particles: Poisson, for all lumps of a batch at once."""
    most = 0.0
    for i in range(LANES):
        most = max(most, work[MEAN * SCRATCH_ROW + i])
        work[NUMBER * SCRATCH_ROW + i] = 0.0
    draw = 0
    while most > 0.0:
        for i in range(LANES):
            a, _, _, _ = words(counter, BODY_NUMBER, start + i, draw)
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
def draw_batch(physics, start, counter, work, like):
    """Thermal velocity of one particle, and energy of all about their mean; -1 where in doubt."""
    thermal, asked = math.sqrt(physics.kT / physics.masses[0]), asks(physics.energy)
    for i in range(LANES):
        a, b, c, e = words(counter, BODY_VELOCITY, start + i, 0)
        note(work, THERMAL * SCRATCH_ROW + i, scaled(thermal, normals(like, a, b, c, e)))
    for i in range(LANES if asked else 0):
        _, _, a, b = words(counter, BODY_NUMBER, start + i, 0)
        freedom = max(len(like) * (work[NUMBER * SCRATCH_ROW + i] - 1.0), 0.0)
        value, sure = likely(a, b, freedom)
        work[INNER * SCRATCH_ROW + i] = value if sure else -1.0


@seldom
def fill_lumps(
    guests, thread, threads, what, physics, counter, grid, sums, impulse, like, terms, scales
):
    """A lump in every cut cell, from batches of them."""
    lumps, offset = guests.lumps, offset_of(physics.solid, grid)
    work = lumps.work[thread]
    first = guests.starts[offset]
    begin, end = share(guests.starts[offset + 1] - first, thread, threads)
    filled = 0
    for start in range(begin, end, LANES):
        count = min(LANES, end - start)
        cut_batch(lumps, first + start, count, guests.density, grid, work, like)
        for i in range(count, LANES):
            work[MEAN * SCRATCH_ROW + i] = 0.0
        count_batch(start, counter, work)
        draw_batch(physics, start, counter, work, like)
        for i in range(count):
            if work[NUMBER * SCRATCH_ROW + i] > 0.5:
                place_lump(
                    guests, thread, filled, first, start, i, physics, counter, grid, sums, work,
                    like, terms, scales,
                )  # fmt: skip
                filled += 1
    lumps.filled[thread] = filled


@scalar
def place_lump(
    guests, thread, n, first, start, i, physics, counter, grid, sums, work, like, terms, scales
):
    """The lump of lane i, the thread's nth, into its cell."""
    d, solid, lumps = len(like), physics.solid, guests.lumps
    entry = first + start + i
    number = np.int64(work[NUMBER * SCRATCH_ROW + i])
    r = recall(work, PLACE * SCRATCH_ROW + i, like)
    term, piece = lumps.terms[entry], lumps.pieces[entry]
    u = surface_velocity(solid.tables, term, r)
    if piece >= 0:
        u = added(u, flow_at(guests.rates, piece, -work[DEPTH * SCRATCH_ROW + i], like))
    mass, thermal = physics.masses[0] * number, recall(work, THERMAL * SCRATCH_ROW + i, like)
    v = added_scaled(u, 1.0 / math.sqrt(float(number)), thermal)
    inner = 0.0
    if asks(physics.energy):
        inner = work[INNER * SCRATCH_ROW + i]
        if inner < 0.0:
            inner = gamma_number(float(d * (number - 1)), counter, BODY_NUMBER, start + i)
        inner *= 2.0 * physics.kT
    who = (guests.first_number + start + i, 0)
    kept, own = contribute(physics.rule, counter, who, mass, v, in_cell(r, grid))
    width = sums_length(len(terms))
    add_lump(
        sums, np.uint64(guests.cells[entry] * width), physics.energy, number, mass, v, inner, own,
        scales,
    )  # fmt: skip
    for k in range(d):
        lumps.state[thread, n, k] = v[k]
        lumps.state[thread, n, d + k] = kept[k]
        lumps.state[thread, n, 2 * d + k] = r[k]
    lumps.state[thread, n, 3 * d] = mass
    lumps.entry[thread, n] = entry


@scalar
def add_lump(sums, start, energy, number, mass, v, inner, own, scales):
    """Add a lump to the sums of its cell, as so many particles."""
    m_v_squared = inner
    for k in range(len(v)):
        m_v_squared += mass * v[k] * v[k]
    values = rounded(scaled(mass, v) + many_energy_term(energy, m_v_squared) + own, scales)
    sums[start] += many_tally(energy, number, m_v_squared)
    for k in range(len(values)):
        place = start + np.uint64(k + 1)
        sums[place] += values[k] + np.int64(number - 1) * np.int64(ROUNDER_BITS)


@seldom
def lumps_recoil(guests, thread, what, physics, grid, coefficients, impulse, like, c, scales):
    """What bodies take by the collision of the lumps in them."""
    d, solid, lumps = len(like), physics.solid, guests.lumps
    if not what & MEASURE_WALLS:
        return
    for i in range(lumps.filled[thread]):
        v, kept, r = like, like, like
        for k in range(d):
            v = tuple_setitem(v, k, lumps.state[thread, i, k])
            kept = tuple_setitem(kept, k, lumps.state[thread, i, d + k])
            r = tuple_setitem(r, k, lumps.state[thread, i, 2 * d + k])
        entry = lumps.entry[thread, i]
        record = np.uint64(guests.cells[entry] * record_length(len(c)))
        after = collide(physics.rule, fetch(coefficients, record, c), kept, in_cell(r, grid))
        given = scaled(lumps.state[thread, i, 3 * d], added_scaled(after, -1.0, v))
        term = lumps.terms[entry]
        lever = from_pivot(solid.tables, term, r)
        take(impulse, whole(word(solid.tables, BODY), term), lever, given, scales[0])
