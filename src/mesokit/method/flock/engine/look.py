"""Sums over all birds within reach of each bird, in whole numbers.

The birds of a cell see those of the cells around. These are brought together in one small stretch
of memory, for all birds of the cell; the loop over them has no branch and adds up whole numbers, so
that neither the order of birds nor cells nor threads changes a bit.
"""

import numpy as np

from mesokit.kernels.kernel import inner
from mesokit.loops.cells import NOWHERE, cell_after, runs_around
from mesokit.method.flock.cohesion import pull
from mesokit.method.flock.engine.memory import CHUNK, LANES, PULL, has_cohesion, past, sum_rows
from mesokit.method.flock.noise.protocol import counted
from mesokit.scalar.jit import by_type, elementwise, for_each, scalar

_NONE = np.int32(0)
_ONE = np.int32(1)
_PULL = np.float32(PULL)
_TINY = np.float32(1e-30)


@elementwise
def nothing(pattern):
    """A tuple of int32 zeros."""
    return "_NONE"


@elementwise
def place_of(places, i, pattern):
    """The place of bird i, as whole numbers."""
    return "places[{k}, i]"


@elementwise
def separation_from(near, j, here, unit):
    """The separation from bird j of those near, float32."""
    return "np.float32(np.int32(near[{k}, j] - here[{k}])) * unit[{k}]"


@scalar
def length_squared(separation):
    """The square of a length, float32."""
    total = separation[0] * separation[0]
    for k in range(1, len(separation)):
        total = np.float32(total + separation[k] * separation[k])
    return total


@elementwise
def with_heading(near, j, reached, sums):
    """Sums with the heading of bird j added, where it is in reach."""
    return "np.int32(sums[{k}] + (near[len(sums) + {k}, j] if reached else _NONE))"


@elementwise
def with_separation(factor, reached, separation, sums):
    """Sums with the separation times a factor added, where it counts."""
    return "np.int32(sums[{k}] + (np.int32(separation[{k}] * factor) if reached else _NONE))"


@for_each
def add_to(sums, first, i, values):
    """Add values to rows of the sums of bird i."""
    return "sums[first + {k}, i] += np.int64(values[{k}])"


@for_each
def bring(near, j, seen, i, pattern):
    """Place and heading of bird i become those of bird j near."""
    return "near[{k}, j] = seen.places[{k}, i]; near[len(pattern) + {k}, j] = seen.headings[{k}, i]"


@by_type
def asks_number(physics):
    """Whether birds in reach are counted, or lanes with birds distinguished from empty ones."""
    if has_cohesion(physics):
        return lambda physics: True
    return lambda physics: counted(physics.noise)


@by_type
def add_seen(physics, near, top, here, sums, i):
    """Add to the sums of bird i what it sees of so many birds near."""
    return _see_headings_and_separations if has_cohesion(physics) else _see_headings


def _see_headings(physics, near, top, here, sums, i):
    unit, d = physics.axes.unit, len(here)
    headings, around = nothing(here), _NONE
    # A loop over vectors of 32-bit integers. Differences of places wrap around like the periodic
    # box, so each is the separation of nearest images. At most CHUNK birds add up, so no sum
    # overflows.
    for j in range(top):
        reached = length_squared(separation_from(near, j, here, unit)) <= physics.reach
        headings = with_heading(near, j, reached, headings)
        if counted(physics.noise):
            around = np.int32(around + (near[2 * d, j] if reached else _NONE))
    add_to(sums, 0, i, headings)
    sums[d, i] += np.int64(around)


def _see_headings_and_separations(physics, near, top, here, sums, i):
    unit, d, cohesion = physics.axes.unit, len(here), physics.cohesion[0]
    core = cohesion.core * cohesion.core
    headings, pulls, out, around = nothing(here), nothing(here), nothing(here), _NONE
    # The same with cohesion: float32 factors of each separation, cut off to integers before they
    # are added. Lanes that only fill up the last vector hold no bird and count for nothing.
    for j in range(top):
        separation = separation_from(near, j, here, unit)
        square = length_squared(separation)
        reached = square <= physics.reach
        headings = with_heading(near, j, reached, headings)
        there = near[2 * d, j] > _NONE
        around = np.int32(around + (_ONE if reached & there else _NONE))
        other = reached & there & (square > _NONE)
        inside, safe = square < core, max(square, _TINY)
        pulls = with_separation(
            _PULL * pull(cohesion, safe), other & (not inside), separation, pulls
        )
        away = np.float32(-_PULL / np.float32(np.sqrt(safe)))
        out = with_separation(away, other & inside, separation, out)
    add_to(sums, 0, i, headings)
    sums[d, i] += np.int64(around)
    add_to(sums, d + 1, i, pulls)
    add_to(sums, 2 * d + 1, i, out)


@scalar
def cells_of_axis(axes, k):
    """Cells along an axis; one along z in 2D."""
    return axes.cells[k] if k < len(axes.cells) else 1


@scalar
def list_runs(axes, starts, cell, runs):
    """Write down the runs of birds around a cell, three cells along x in one; gives how many."""
    wide, high, deep = cells_of_axis(axes, 0), cells_of_axis(axes, 1), cells_of_axis(axes, 2)
    x, y, z, number = cell % wide, cell // wide % high, cell // (wide * high), 0
    # Sorted birds of three cells along x are one run in memory, and those of the cell across an end
    # of a periodic box another one.
    for c in range(-1, 2) if deep > 1 else range(1):
        z_there = cell_after(axes, axes, 2, z, c) if c != 0 else z
        for b in range(-1, 2) if high > 1 else range(1):
            y_there = cell_after(axes, axes, 1, y, b)
            if min(y_there, z_there) != NOWHERE:
                row = (z_there * high + y_there) * wide
                for begin, end in runs_around(axes, axes, starts, row, x, min(wide - 1, 1)):
                    if begin < end:
                        runs[0, number], runs[1, number] = begin, end
                        number += 1
    return number


@inner
def look(physics, seen, starts, near, runs, cell, pattern):
    """Add up the sums of all birds of a cell, in which there are some."""
    begin, end = starts[cell], starts[cell + 1]
    for k in range(sum_rows(physics)):
        for i in range(begin, end):
            seen.sums[k, i] = 0
    number = list_runs(physics.axes, starts, cell, runs)
    run, held, first = 0, 0, runs[0, 0]
    # Birds of all runs are copied into one chunk, across borders of runs, until it is full or the
    # runs end. Then every bird of the cell adds up this chunk. Sums are integers, so chunks change
    # no bit.
    while run < number:
        fit = min(runs[1, run] - first, CHUNK - held)
        for j in range(fit):
            bring(near, past(held, j), seen, past(first, j), pattern)
        held, first = held + fit, first + fit
        if first == runs[1, run]:
            run += 1
            first = runs[0, run]
        if (held == CHUNK) | (run == number):
            see(physics, seen, near, held, begin, end, pattern)
            held = 0


@scalar
def see(physics, seen, near, held, begin, end, pattern):
    """Add the birds near to the sums of the birds of a cell; lanes without a bird add nothing."""
    d, top = len(pattern), (held + LANES - 1) // LANES * LANES
    if asks_number(physics):
        for j in range(held):
            near[2 * d, j] = _ONE
    for k in range(d, len(near)):
        for lane in range(LANES):
            near[k, past(held, lane)] = _NONE
    for i in range(begin, end):
        add_seen(physics, near, top, place_of(seen.places, i, pattern), seen.sums, i)
