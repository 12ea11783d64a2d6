"""How fast the fluid's velocity rises with the distance from each piece of surface.

Next to a surface the velocity relative to it is s h + q h^2 at the height h. Two cells of fluid in
front of each piece, free of solid, tell u / h = s + q h at two heights; where the second is not
free, q is taken for 0.
"""

import math

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.execute.layout import share, sums_length
from mesokit.execute.stages import cell_index
from mesokit.execute.sums import nothing_found, read_sums
from mesokit.geometry.bodies import (
    in_box,
    nearest,
    sure_clearance,
    surface_velocity,
    term_clearance,
)
from mesokit.scalar import added_scaled, dot, scalar, scaled, seldom

EVERY = 4  # steps from one look at a piece to the next: sooner, the same particles are there
MEMORY = EVERY / 256.0  # weight of one look
PROBES = 2
APART = 1.0  # cells between the places where fluid is looked for
LEAST_APART = 0.5  # of the first mean height: nearer to one another, two tell no bend


@scalar
def columns(d):
    """Numbers kept for each piece: slope s (d), bend q (d), and of each probe the mean of u / h (d)
    and of h."""
    return 2 * d + PROBES * (d + 1)


@scalar
def flow_at(rates, piece, height, like):
    """Velocity relative to the surface at a height, which is negative in the solid."""
    d = len(like)
    for k in range(d):
        rise = rates[piece, k] + height * rates[piece, d + k]
        like = tuple_setitem(like, k, height * rise)
    return like


@seldom
def follow_pieces(
    guests, thread, threads, physics, counter, grid, sums, like, terms, scales
):  # fmt: skip
    """Update what is known at every EVERYth piece of surface, from this step's cells."""
    turn = np.int64(counter.step) % EVERY
    begin, end = share((len(guests.terms) + EVERY - 1 - turn) // EVERY, thread, threads)
    for e in range(turn + EVERY * begin, turn + EVERY * end, EVERY):
        for p in range(PROBES):
            look(guests, e, p, physics, grid, sums, like, terms, scales)
        straighten(guests.rates, e, like)


@scalar
def look(guests, e, p, physics, grid, sums, like, terms, scales):
    """Update the means of one probe, unless its cell is empty or holds some solid."""
    d, solid, width = len(like), physics.solid, sums_length(len(terms))
    probe, n = like, like
    for k in range(d):
        n = tuple_setitem(n, k, guests.outward[e, k])
        probe = tuple_setitem(probe, k, guests.probes[e, k] + p * APART * guests.outward[e, k])
    middle = probe
    for k in range(d):
        corner = np.floor(probe[k] + grid.origin[k]) - grid.origin[k]
        middle = tuple_setitem(middle, k, corner + 0.5)
    room = 0.5 * math.sqrt(float(d))
    if sure_clearance(solid, middle) < room:
        least, _, _ = nearest(solid.tables, in_box(solid, middle))
        if least < room:
            return
    cell, found = cell_index(probe, grid), nothing_found(terms)
    for t in range(sums.shape[0]):
        for k in range(len(found)):
            more = found[k] + sums[t, cell * width + k]
            found = tuple_setitem(found, k, more)
    number, mass, momentum, _, _ = read_sums(physics.masses, physics.energy, found, like, scales)
    if number < 1.0:
        return
    height, _ = term_clearance(solid.tables, guests.terms[e], middle)
    u = surface_velocity(solid.tables, guests.terms[e], middle)
    rise = scaled(1.0 / height, added_scaled(scaled(1.0 / mass, momentum), -1.0, u))
    rise = added_scaled(rise, -dot(rise, n), n)
    place = 2 * d + p * (d + 1)
    for k in range(d):
        guests.rates[e, place + k] += MEMORY * (rise[k] - guests.rates[e, place + k])
    guests.rates[e, place + d] += MEMORY * (height - guests.rates[e, place + d])


@scalar
def straighten(rates, e, like):
    """Slope and bend from the means. At the start all means are short of what they will be by the
    same factor, and so then is the slope."""
    d = len(like)
    near, far = rates[e, 3 * d], rates[e, 4 * d + 1]
    apart = far - near
    for k in range(d):
        a, b = rates[e, 2 * d + k], rates[e, 3 * d + 1 + k]
        bent = apart > LEAST_APART * near
        rates[e, d + k] = (b - a) / apart if bent else 0.0
        rates[e, k] = (a * far - b * near) / apart if bent else a
