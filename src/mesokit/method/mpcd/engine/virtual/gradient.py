"""The rise of the fluid's velocity with the distance from each piece of surface.

Virtual particles at rest with a wall drag the fluid as if the wall lay deeper: in the part of a
cell that is solid the fluid's profile would go on, to velocities beyond the wall's. With the rate
of the profile known they can move like that; the wall is then where it should be.

Next to a surface the velocity relative to it is s h + q h^2 at the height h. Two cells of fluid in
front of each piece, free of solid, give u / h = s + q h at two heights; where the second is not
free, q is taken for 0.
"""

# ruff: noqa: F401  lines written out as text use what is imported here

import numpy as np

from mesokit.geometry.protocol import distance_above, is_clear_cell, surface_flow
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.cpu.grid import cell_in_box, cell_index, in_block
from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.cpu.strips.terms import read_sums, sums_of_cell
from mesokit.method.mpcd.engine.virtual.particles import has_gradient
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import by_type, elementwise, scalar, seldom
from mesokit.scalar.pointer import integer, numbers_in, put_numbers_in
from mesokit.scalar.vector import added_scaled, dot, scaled

EVERY = 4  # steps from one look at a piece to the next: sooner, the same particles are there
MEMORY = EVERY / 256.0  # weight of one look
PROBES = 2
APART = 1.0  # cells between the places where fluid is looked for
LEAST_APART = 0.5  # of the first mean height: closer probes give no reliable bend


@scalar
def numbers_of_piece(d):
    """Numbers kept for each piece: slope s (d), bend q (d), and of each probe the mean of u / h (d)
    and of h."""
    return 2 * d + PROBES * (d + 1)


@scalar
def flow_at(rates, piece, above, zero):
    """Velocity relative to the surface at a height above it, which is negative in the solid."""
    d = len(zero)
    width = numbers_of_piece(d)
    slope, bend = numbers_in(rates, piece, width, 0, zero), numbers_in(rates, piece, width, d, zero)
    return _flow(above, slope, bend)


@elementwise
def _flow(above, slope, bend):
    return "above * (slope[{k}] + above * bend[{k}])"


@where(walls=has_gradient)
def follow_flow(worker, now, physics, fluid, walls):
    """Update the flow at every EVERYth piece of surface, from this step's cells."""
    _follow(worker, now, physics, fluid.cells.sums, walls.virtual)
    barrier(worker)


@by_type
def _follow(worker, now, physics, sums, virtual):
    """All pieces on one rank; one of several ranks only stores values for `messages.flow`."""
    if len(field_of(virtual, "seen")):
        return lambda *given: _see(*given)
    return lambda *given: _follow_all(*given)


@seldom
def _follow_all(worker, now, physics, sums, virtual):
    turn = np.int64(now.counter.step) % EVERY
    number = (len(virtual.terms) + EVERY - 1 - turn) // EVERY
    begin, end = share(number, worker.thread, worker.threads)
    # Every fourth piece at each step, in turn. A running mean belongs to one piece and one thread.
    for e in range(turn + EVERY * begin, turn + EVERY * end, EVERY):
        follow_piece(virtual, e, physics, now.grid, sums)


@seldom
def _see(worker, now, physics, sums, virtual):
    turn, pieces = np.int64(now.counter.step) % EVERY, virtual.seen.here
    begin, end = share(len(pieces), worker.thread, worker.threads)
    # The same pieces as on one rank, but only probes in own cells: their sums are complete here.
    # `receive_coefficients` updates the means when values of all ranks are there.
    for j in range(begin, end):
        e = pieces[j]
        for p in range(PROBES if e % EVERY == turn else 0):
            place = cell_in_box(probe_at(virtual, e, p, physics.zero), now.grid)
            if in_block(virtual.seen.limits, place):
                good, seen = look(virtual, e, p, physics, now.grid, sums)
                if good:
                    virtual.seen.step[e, p] = np.int64(now.counter.step)
                    for k in range(len(seen)):
                        virtual.seen.values[e, p, k] = seen[k]


@scalar
def follow_piece(virtual, e, physics, grid, sums):
    """Update the means at a piece, and slope and bend. Tables are arrays or addresses."""
    for p in range(PROBES):
        good, seen = look(virtual, e, p, physics, grid, sums)
        if good:
            average_probe(virtual.rates, e, p, seen, physics.zero)
    straighten(virtual.rates, e, physics.zero)


@scalar
def probe_at(virtual, e, p, zero):
    """The place of a probe."""
    d = len(zero)
    near = numbers_in(virtual.probes, e, d, 0, zero)
    return _ahead(p * APART, near, numbers_in(virtual.outward, e, d, 0, zero))


@elementwise
def _ahead(far, near, n):
    return "near[{k}] + far * n[{k}]"


@scalar
def look(virtual, e, p, physics, grid, sums):
    """Whether the cell of a probe has fluid alone, and then u / h (d) and h there."""
    solid, zero = physics.solid, physics.zero
    probe = probe_at(virtual, e, p, zero)
    n = numbers_in(virtual.outward, e, len(zero), 0, zero)
    middle = _middle_of_cell(grid.origin, probe)
    if not is_clear_cell(solid, middle):
        return False, zero + (0.0,)
    found = sums_of_cell(sums, cell_index(probe, grid), physics.terms)
    number, mass, momentum, _, _ = read_sums(physics, found)
    if number < 1.0:
        return False, zero + (0.0,)
    term = integer(virtual.terms, e)
    above = distance_above(solid, term, middle)
    u = surface_flow(solid, term, middle)
    rise = scaled(1.0 / above, added_scaled(scaled(1.0 / mass, momentum), -1.0, u))
    return True, added_scaled(rise, -dot(rise, n), n) + (above,)


@elementwise
def _middle_of_cell(origin, r):
    return "(floor(r[{k}] + origin[{k}]) - origin[{k}]) + 0.5"


@scalar
def average_probe(rates, e, p, seen, zero):
    """Update the running means of a probe."""
    d = len(zero)
    width, place = numbers_of_piece(d), 2 * d + p * (d + 1)
    before = numbers_in(rates, e, width, place, seen)
    put_numbers_in(rates, e, width, place, _averaged(before, seen))


@elementwise
def _averaged(before, seen):
    return "before[{k}] + MEMORY * (seen[{k}] - before[{k}])"


@scalar
def straighten(rates, e, zero):
    """Slope and bend from the means. At the start all means are short of what they will be by the
    same factor, and so then is the slope."""
    d = len(zero)
    width, mean = numbers_of_piece(d), zero + (0.0,)
    a = numbers_in(rates, e, width, 2 * d, mean)
    b = numbers_in(rates, e, width, 3 * d + 1, mean)
    near, far = a[d], b[d]
    apart = far - near
    # Through the two means u / h = s + q h, at heights h in cells, component by component. Where
    # the probes are too close to each other, q is 0.
    bent = apart > LEAST_APART * near
    put_numbers_in(rates, e, width, 0, _slopes(bent, near, far, apart, a, b, zero))
    put_numbers_in(rates, e, width, d, _bends(bent, apart, a, b, zero))


@elementwise
def _slopes(bent, near, far, apart, a, b, zero):
    return "(a[{k}] * far - b[{k}] * near) / apart if bent else a[{k}]"


@elementwise
def _bends(bent, apart, a, b, zero):
    return "(b[{k}] - a[{k}]) / apart if bent else 0.0"
