"""The next strip, fetched while the loops that wait most pass over this one.

A sweep reads all particles once and works on each for a few nanoseconds. So it waits for memory,
unless lines are on their way early, a few at a time.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.loops.layout import LANES, ROW, record_length, strip_at
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.prefetch import LINE, prefetch


class Next(NamedTuple):
    """A strip that comes next: all data, and where those of the strip begin; the pattern of a
    vector; all cells, and where those of the strip begin; coefficients of cells, and how many one
    has."""

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
    return Next(
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
    """Ask for the lines with the place of lane i; `following` is () for nothing."""
    if len(following) == 0:
        return lambda following, i: None
    return lambda following, i: _fetch_rows(following, 0, i)


@by_type
def fetch_velocities(following, i):
    """Ask for the lines with the velocity of lane i, and the coefficients of its cell."""
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
