"""The next strip, prefetched in the two loops that move most memory.

A sweep reads all particles once and works on each for a few nanoseconds, so it waits for memory.
Cache lines of the next strip are therefore fetched a few at a time, between gathers and sums of
this one. That changes times and nothing else.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.loops.layout import LANES, ROW, record_length, strip_at
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.prefetch import LINE, prefetch


class NextStrip(NamedTuple):
    """A strip that comes next.

    data (flat), start: all particles, and where the first row of the strip begins. pattern: of a
    vector. cell (places,), first: cells of all particles, and where those of the strip begin.
    coefficients (flat), length: records of all cells, and how long one is.
    """

    data: Any
    start: int
    pattern: tuple
    cell: Any
    first: int
    coefficients: Any
    length: int


@scalar
def strip_after(fluid, physics, s, last):
    """The strip after s; s itself where it is the one before `last`."""
    particles, n = fluid.particles, min(s + 1, last - 1)
    start, length = strip_at(n, particles.rows).start, record_length(len(physics.coefficients))
    return NextStrip(
        particles.data,
        start,
        physics.zero,
        particles.cell,
        n * LANES,
        fluid.cells.coefficients,
        length,
    )


@by_type
def fetch_places(following, i):
    """Prefetch the lines with the place of lane i; `following` is () for nothing."""
    if len(following) == 0:
        return lambda following, i: None
    return lambda following, i: _fetch_rows(following, 0, i)


@by_type
def fetch_velocities(following, i):
    """Prefetch the lines with the velocity of lane i and the coefficients of its cell."""
    if len(following) == 0:
        return lambda following, i: None

    def fetch(following, i):
        _fetch_rows(following, len(following.pattern), i)
        cell = np.int64(following.cell[following.first + i])
        for byte in range(0, 8 * following.length + LINE, LINE):
            prefetch(following.coefficients, cell * following.length, byte)

    return fetch


@scalar
def _fetch_rows(following, row, i):
    for k in range(len(following.pattern)):
        prefetch(following.data, following.start + (row + k) * ROW + i, 0)
