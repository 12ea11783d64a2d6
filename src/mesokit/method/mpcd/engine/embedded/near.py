"""The particles of the fluid that may come near a bead in a timestep, and these beads.

A particle that no bead can reach flies straight: its distance from all beads is larger than the
reach of the potential, what it flies, and what beads may go (`skin`). The others are moved in the
sub-steps of the beads. The choice depends on places and velocities alone, neither on the order in
memory nor on threads: marked cells only save work.
"""

import math

import numpy as np

from mesokit.case.box import fold
from mesokit.kernels.kernel import inner
from mesokit.loops.cells import NOWHERE, cell_after, cells_along, row_around
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.beads.neighbours import apart, find_cells, link
from mesokit.method.mpcd.engine.beads.state import load_place
from mesokit.method.mpcd.engine.cpu.grid import cell_index
from mesokit.method.mpcd.engine.cpu.strips.rows import load_particle, store_values
from mesokit.method.mpcd.engine.embedded.state import (
    ALL_BEADS,
    COUNT,
    PARTNERS,
    STEP,
    TOO_MANY,
    WHAT,
    WHICH,
)
from mesokit.method.mpcd.streaming import halfway, vector
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.pointer import is_address, raise_to
from mesokit.scalar.vector import added_scaled, dot, scaled


@inner
def find_beads(worker, stamp, box, beads, zero):
    """Put beads into their cells, and mark the cells of the fluid around them with a stamp."""
    (embedded,), number = beads.embedded, len(beads.cell)
    first, last = share(number, worker.thread, worker.threads)
    find_cells(embedded.lists, beads.halo, box, beads.r, (first, last), zero)
    for i in range(first, last):
        mark_around(embedded, load_place(beads, i, zero), stamp)
    barrier(worker)
    link(embedded.lists, beads.halo, share(len(embedded.lists.head), worker.thread, worker.threads))
    barrier(worker)


@seldom
def mark_around(embedded, r, stamp):
    """Mark the cells of the fluid that come as near to r as the lists of partners reach."""
    d, reach = len(r), embedded.lists.reach
    low, high = r, r
    for k in range(d):
        low = with_item(low, k, floor(r[k] - reach))
        high = with_item(high, k, floor(r[k] + reach))
    depth = int(high[d - 1] - low[d - 1]) + 1 if d == 3 else 1  # along z
    middle = r
    # All cells of side a in a cube around the bead, but only those nearer than `reach`. Threads may
    # mark the same cell, but all write the same stamp, the number of the step. So marks need no
    # clearing.
    for c in range(depth):
        if d == 3:
            middle = with_item(middle, d - 1, low[d - 1] + c + 0.5)
        for b in range(int(high[1] - low[1]) + 1):
            middle = with_item(middle, 1, low[1] + b + 0.5)
            for a in range(int(high[0] - low[0]) + 1):
                middle = with_item(middle, 0, low[0] + a + 0.5)
                square = 0.0
                for k in range(d):
                    gap = max(abs(middle[k] - r[k]) - 0.5, 0.0)
                    square += gap * gap
                if square <= reach * reach:
                    put_mark(embedded.marked, np.int64(cell_index(middle, embedded.grid)), stamp)


@by_type
def put_mark(marked, cell, stamp):
    """Mark a cell; on a device, where all threads do so at once, stamps only rise."""
    if is_address(marked):
        return lambda marked, cell, stamp: raise_to(marked, cell, np.int64(stamp))
    return _put_mark


def _put_mark(marked, cell, stamp):
    marked[cell] = stamp


@scalar
def path_of(embedded, physics, r, v):
    """The longest path that a particle can fly in a timestep, far from beads."""
    a, time = vector(halfway(physics.field, r, v, physics.timestep), r), physics.timestep
    path = time * math.sqrt(dot(v, v)) + 0.5 * time * time * math.sqrt(dot(a, a))
    return path + embedded.further


@scalar
def may_be_near(embedded, physics, mark, step, r, v):
    """Whether a particle is in a cell that is marked for this step, or so fast that cells are no
    bound."""
    return (mark == step) | (not path_of(embedded, physics, r, v) <= embedded.travel)


@scalar
def choose_near(worker, now, physics, beads, strip, s, count, marks):
    """Put the particles of strip s that may come near a bead on the list of this thread.

    Their lanes become the first entries of `marks`; returns their number.
    """
    (embedded,), zero = beads.embedded, physics.zero
    d, step, candidates, chosen = len(zero), now.counter.step, 0, 0
    # Coarse test of all lanes at t, before the flight. It has no branches.
    for i in range(count):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        mark = embedded.marked[cell_index(r, embedded.grid)]
        marks[i] = np.int64(may_be_near(embedded, physics, mark, step, r, v))
    # Compact the lanes of candidates to the front, again without branches.
    for i in range(count):
        mark = marks[i]
        marks[candidates] = i
        candidates += mark
    # Exact test of the few candidates, by distances from beads. The choice depends on places and
    # velocities alone, so neither the order in memory nor threads change the result.
    for j in range(candidates):
        i = marks[j]
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        path, n = path_of(embedded, physics, r, v), embedded.number[worker.thread, COUNT]
        if n == embedded.lane.shape[1]:
            note(embedded.faults[worker.thread], step, TOO_MANY, 0)
            break
        partners = find_partners(embedded, beads, now.box, r, path, (worker.thread, n))
        if partners != 0:
            at = np.uint64(n * d)
            embedded.lane[worker.thread, n] = s * len(marks) + i
            embedded.partners[worker.thread, n] = partners
            embedded.bound[worker.thread, n] = max(path, embedded.travel)
            store_values(embedded.r[worker.thread], at, r)
            store_values(embedded.start[worker.thread], at, r)
            store_values(embedded.v[worker.thread], at, v)
            embedded.number[worker.thread, COUNT] = n + 1
            marks[chosen] = i
            chosen += 1
    return chosen


@seldom
def find_partners(embedded, beads, box, r, path, where):
    """List the beads that a particle at r may meet, which flies so far; 0 if there are none.

    All beads of a list lie within reach of `travel`, so that it holds if the path is shorter.
    """
    lists, number = embedded.lists, len(beads.cell)
    if not path <= embedded.travel:  # a fast one, or one that is lost
        for j in range(number):
            if comes_near(embedded, beads, box, r, path, j):
                return ALL_BEADS
        return 0
    still, d, found, met = scaled(0.0, r), len(r), 0, False
    place, _, _ = fold(box, r, still, still)
    # Beads in the 9 or 27 cells around the particle; these cells are at least as long as the reach.
    # The list holds beads within reach of a flight of length `travel`. It is kept only if one of
    # them is within reach of the particle's own flight. Forces are integers, so its order is free.
    here = cells_along(lists, place)
    for n in range(3 ** (d - 1)):
        row, middle = row_around(lists, box, place, here, 0.0, n)
        for a in range(-1, 2 if row != NOWHERE else -1):
            along_x = cell_after(lists, box, 0, middle, a)
            j = lists.head[np.uint64(row + along_x)] if along_x != NOWHERE else -1
            while j >= 0:
                if comes_near(embedded, beads, box, r, embedded.travel, j):
                    if found < PARTNERS:
                        embedded.beads[where[0], where[1] * PARTNERS + found] = j
                    found += 1
                    met |= comes_near(embedded, beads, box, r, path, j)
                j = lists.following[j]
    if not met:
        return 0
    return found if found <= PARTNERS else ALL_BEADS


@scalar
def comes_near(embedded, beads, box, r, path, j):
    """Whether a particle at r that flies so far may come within the reach of bead j."""
    bound = embedded.reach + embedded.skin + path
    separation = apart(box, load_place(beads, j, r), r)
    return not dot(separation, separation) > bound * bound


@scalar
def note(faults, step, what, which):
    """Note the first thing that goes wrong."""
    if faults[STEP] == 0:
        faults[STEP], faults[WHAT], faults[WHICH] = np.int64(step), what, np.int64(which)


@scalar
def has_left(start, r, bound):
    """Whether a place is farther from an earlier one than a bound."""
    displacement = added_scaled(r, -1.0, start)
    return not dot(displacement, displacement) <= bound * bound
