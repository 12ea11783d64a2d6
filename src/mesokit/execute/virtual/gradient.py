"""How fast the fluid's velocity rises with the distance from each piece of surface.

Virtual particles at rest with a wall drag the fluid as if the wall lay deeper: in the part of a
cell that is solid the fluid's profile would go on, to velocities beyond the wall's. With the rate
of the profile known they can move like that; the wall is then where it should be.

Next to a surface the velocity relative to it is s h + q h^2 at the height h. Two cells of fluid in
front of each piece, free of solid, tell u / h = s + q h at two heights; where the second is not
free, q is taken for 0.
"""

import numpy as np

from mesokit.execute.cpu.grid import cell_index
from mesokit.execute.cpu.strips.layout import share
from mesokit.execute.cpu.strips.terms import read_sums, sums_of_cell
from mesokit.execute.cpu.threads import meet
from mesokit.geometry.cut import height, roomy, surface_flow
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.vector import added_scaled, dot, scaled

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
def flow_at(rates, piece, above, zero):
    """Velocity relative to the surface at a height above it, which is negative in the solid."""
    d = len(zero)
    for k in range(d):
        rise = rates[piece, k] + above * rates[piece, d + k]
        zero = with_item(zero, k, above * rise)
    return zero


def follow_pieces(team, now, physics, fluid, walls):
    """Update what is known at every EVERYth piece of surface, from this step's cells."""
    _follow(team, now, physics, fluid.cells.sums, walls.virtual)
    meet(team)


@seldom
def _follow(team, now, physics, sums, virtual):
    turn = np.int64(now.counter.step) % EVERY
    begin, end = share((len(virtual.terms) + EVERY - 1 - turn) // EVERY, team.thread, team.threads)
    for e in range(turn + EVERY * begin, turn + EVERY * end, EVERY):
        for p in range(PROBES):
            look(virtual, e, p, physics, now.grid, sums)
        straighten(virtual.rates, e, physics.zero)


@scalar
def look(virtual, e, p, physics, grid, sums):
    """Update the means of one probe, unless its cell is empty or holds some solid."""
    solid, zero = physics.solid, physics.zero
    d, probe, n = len(zero), zero, zero
    for k in range(d):
        n = with_item(n, k, virtual.outward[e, k])
        probe = with_item(probe, k, virtual.probes[e, k] + p * APART * virtual.outward[e, k])
    middle = probe
    for k in range(d):
        corner = floor(probe[k] + grid.origin[k]) - grid.origin[k]
        middle = with_item(middle, k, corner + 0.5)
    if not roomy(solid, middle):
        return
    found = sums_of_cell(sums, cell_index(probe, grid), physics.terms)
    number, mass, momentum, _, _ = read_sums(physics, found)
    if number < 1.0:
        return
    above = height(solid, virtual.terms[e], middle)
    u = surface_flow(solid, virtual.terms[e], middle)
    rise = scaled(1.0 / above, added_scaled(scaled(1.0 / mass, momentum), -1.0, u))
    rise = added_scaled(rise, -dot(rise, n), n)
    place = 2 * d + p * (d + 1)
    for k in range(d):
        virtual.rates[e, place + k] += MEMORY * (rise[k] - virtual.rates[e, place + k])
    virtual.rates[e, place + d] += MEMORY * (above - virtual.rates[e, place + d])


@scalar
def straighten(rates, e, zero):
    """Slope and bend from the means. At the start all means are short of what they will be by the
    same factor, and so then is the slope."""
    d = len(zero)
    near, far = rates[e, 3 * d], rates[e, 4 * d + 1]
    apart = far - near
    for k in range(d):
        a, b = rates[e, 2 * d + k], rates[e, 3 * d + 1 + k]
        bent = apart > LEAST_APART * near
        rates[e, d + k] = (b - a) / apart if bent else 0.0
        rates[e, k] = (a * far - b * near) / apart if bent else a
