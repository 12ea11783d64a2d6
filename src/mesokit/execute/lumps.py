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

from mesokit.elementary import log
from mesokit.execute.bounce import take
from mesokit.execute.cell_energy import asks, many_energy_term, many_tally
from mesokit.execute.chart import offset_of, offsets_along
from mesokit.execute.fixed_point import ROUNDER_BITS, rounded
from mesokit.execute.flags import MEASURE_WALLS
from mesokit.execute.layout import record_length, share, sums_length
from mesokit.execute.near_flow import flow_at
from mesokit.execute.rows import fetch
from mesokit.execute.stages import in_cell
from mesokit.geometry.bodies import BODY, from_pivot, surface_velocity
from mesokit.geometry.cut_cube import share_and_depth
from mesokit.mpcd.collision.protocol import collide, contribute
from mesokit.pointer import whole, word
from mesokit.random import BODY_NUMBER, BODY_VELOCITY, normal, normals, unit_open, words
from mesokit.scalar import added, added_scaled, scalar, scaled, seldom


class Lumps(NamedTuple):
    """Planes of the cut cells, and the lumps of this step.

    normals (entries, d), heights (entries,): of the middle of the cell over the surface, at the
    middle of the interval of offsets; places (entries, d): that middle, in the box.
    terms, pieces (entries,): the body, and the piece of surface.
    state (threads, entries, 3 d + 1): velocity, velocity kept for the collision, place, mass.
    entry (threads, entries), filled (threads,).
    """

    normals: Any
    heights: Any
    places: Any
    terms: Any
    pieces: Any
    state: Any
    entry: Any
    filled: Any


@seldom
def poisson(mean, counter, entry):
    """A Poisson number, by the product of uniform numbers, at most 8 of the mean at a time."""
    number, draw, left = 0, 0, mean
    while left > 0.0:
        part = min(left, 8.0)
        left -= part
        a, _, _, _ = words(counter, BODY_NUMBER, entry, draw)
        draw += 1
        chance = math.exp(-part)
        below, k = unit_open(a) - chance, 0
        while below > 0.0 and k < 64:
            k += 1
            chance *= part / k
            below -= chance
        number += k
    return number


@seldom
def chi_square(freedom, counter, entry):
    """A chi-square number: two degrees of freedom for each uniform number, one for a normal."""
    product, total, done = 1.0, 0.0, 0
    draw = 1
    while done + 1 < freedom:
        a, b, c, e = words(counter, BODY_VELOCITY, entry, draw)
        draw += 1
        for chance in (a, b, c, e):
            if done + 1 < freedom:
                product *= unit_open(chance)
                done += 2
        if product < 1e-200:
            total -= 2.0 * log(product)
            product = 1.0
    total -= 2.0 * log(product)
    if done < freedom:
        a, b, _, _ = words(counter, BODY_VELOCITY, entry, draw)
        total += normal(a, b) ** 2
    return total


@seldom
def height_now(guests, entry, grid, like):
    """Height of the middle of the cell over the surface, the normal, and that middle.

    The middle is that of the image next to the term, which may lie beyond an end of the box.
    """
    n, height, middle = like, guests.lumps.heights[entry], like
    for k in range(len(like)):
        n = tuple_setitem(n, k, guests.lumps.normals[entry, k])
        many = offsets_along(like)
        within = grid.origin[k] * many
        moved = (within - np.floor(within) - 0.5) / many
        height -= n[k] * moved
        middle = tuple_setitem(middle, k, guests.lumps.places[entry, k] - moved)
    return height, n, middle


@seldom
def fill_lumps(
    guests, thread, threads, what, physics, counter, grid, sums, impulse, like, terms, scales
):
    """A lump in every cut cell."""
    d, solid, lumps = len(like), physics.solid, guests.lumps
    m = physics.masses[0]
    width = sums_length(len(terms))
    offset = offset_of(solid, grid)
    first = guests.starts[offset]
    begin, end = share(guests.starts[offset + 1] - first, thread, threads)
    count = 0
    for j in range(begin, end):
        entry = first + j
        height, n, middle = height_now(guests, entry, grid, like)
        reach = 0.0
        for k in range(d):
            reach += 0.5 * abs(n[k])
        if abs(height) >= reach:  # all fluid, or all solid: then no particle of the fluid is there
            continue
        part, depth = share_and_depth(height, n)
        number = poisson(guests.density * part, counter, j)
        if number == 0:
            continue
        r = added_scaled(middle, -(height + depth), n)
        term = lumps.terms[entry]
        u = surface_velocity(solid.tables, term, r)
        piece = lumps.pieces[entry]
        if piece >= 0:
            u = added(u, flow_at(guests.rates, piece, -depth, like))
        mass = m * number
        a, b, c, e = words(counter, BODY_VELOCITY, j, 0)
        v = added(u, scaled(math.sqrt(physics.kT / mass), normals(like, a, b, c, e)))
        inner = 0.0
        if asks(physics.energy):
            inner = physics.kT * chi_square(d * (number - 1), counter, j)
        who = (guests.first_number + j, 0)
        kept, own = contribute(physics.rule, counter, who, mass, v, in_cell(r, grid))
        add_lump(
            sums, np.uint64(guests.cells[entry] * width), physics.energy, number, mass, v, inner,
            own, scales,
        )  # fmt: skip
        for k in range(d):
            lumps.state[thread, count, k] = v[k]
            lumps.state[thread, count, d + k] = kept[k]
            lumps.state[thread, count, 2 * d + k] = r[k]
        lumps.state[thread, count, 3 * d] = mass
        lumps.entry[thread, count] = entry
        count += 1
    lumps.filled[thread] = count


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
