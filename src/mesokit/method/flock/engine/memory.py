"""The memory of birds: groups of arrays by name, and numbers that follow from a case."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.loops.neighbours import inverse_lengths
from mesokit.scalar.jit import by_type, scalar

CHUNK = 240  # birds near a cell that are looked at together: sums of so many fit 32 bits
LANES = 16  # their number is filled up to a multiple of this
STRIP = 256  # birds that are turned and moved together
MOST_RUNS = 18  # of birds near a cell: nine rows, and what is beyond the end of the box
HEADING = 2.0**23  # units of a heading in sums
PULL = 2.0**22  # units of what repulsion and cohesion add: at most 1 for each bird
SKIN = 1.0 + 1e-6  # cells are larger than the reach by more than rounding
ROUND, HALF = 32, 31  # bits of a place along an axis: all of them where it is periodic


class Axes(NamedTuple):
    """The box as whole numbers see it.

    A place along an axis is a whole number of 32 bits: of a periodic axis all are used, so that
    the difference of two of them is the way to the nearest image; of an axis that walls close
    half, so that it is the way itself. It does not depend on the cells.

    size, inverse: lengths, and their inverses (0 along axes that walls close).
    scale: units in a length of 1.  unit: length of one, float32.
    bits: of a place.  cells: along each axis.
    """

    size: tuple[float, ...]
    inverse: tuple[float, ...]
    scale: tuple[float, ...]
    unit: tuple[np.float32, ...]
    bits: tuple[np.uint64, ...]
    cells: tuple[int, ...]


class Physics(NamedTuple):
    """Parameters of the motion: reach squared (float32), length of a step, whether birds go with
    the old heading, noise, () or (repulsion and cohesion,), and the solids."""

    axes: Axes
    reach: np.float32
    step_length: float
    follows: bool
    noise: Any
    cohesion: tuple[Any, ...]
    solid: Any


def has_cohesion(physics: Any) -> bool:
    """Whether this type of `Physics` has repulsion and cohesion."""
    return len(physics.types[physics.fields.index("cohesion")]) > 0


@scalar
def past(first, i):
    """An index i places after the first: unsigned, as numba would count others from the end."""
    return np.uint64(first) + np.uint64(i)


class Birds(NamedTuple):
    """Birds, twice: sorted from one to the other at each step.

    places, headings (2, d, n); images (2, d, n): boxes away; numbers (2, n): which bird it is.
    """

    places: NDArray[np.float64]
    headings: NDArray[np.float64]
    images: NDArray[np.int32]
    numbers: NDArray[np.int32]


class Seen(NamedTuple):
    """Headings and places of birds, sorted by cell, all as whole numbers.

    places, headings (d, n); sums (rows, n): of headings in reach, of what cohesion adds, of the way
    out of the core, and how many birds are in reach.
    """

    places: NDArray[np.int32]
    headings: NDArray[np.int32]
    sums: NDArray[np.int64]


class Cells(NamedTuple):
    """Cells of at least the reach.

    homes (n,): cell of each bird, in the order before the sort.
    counts (threads, cells): birds of each thread in each cell, then where they go.
    starts (cells + 1,): the first bird of each cell.  work (cells + 1,): looks before each cell.
    totals (threads, 2): of the cells of each thread: birds and looks.
    """

    homes: NDArray[np.int32]
    counts: NDArray[np.int32]
    starts: NDArray[np.int64]
    work: NDArray[np.int64]
    totals: NDArray[np.int64]


class Scratch(NamedTuple):
    """Of each thread: birds near a cell, places and then headings and ones (threads, 2 d + 1,
    CHUNK + LANES); rows of a strip (threads, rows * STRIP): the sums, heading, place, way or boxes
    crossed, and the number; and ends of runs of birds (threads, 2, MOST_RUNS + 1)."""

    near: NDArray[np.int32]
    strip: NDArray[np.float64]
    runs: NDArray[np.int64]


class FlockMemory(NamedTuple):
    """All arrays of a flock."""

    birds: Birds
    seen: Seen
    cells: Cells
    scratch: Scratch


def axes_of(size: Sequence[float], closed: Sequence[bool], side: float, most: int) -> Axes:
    """The axes of a box with cells of at least this side, about as many as `most` at most."""
    d = len(size)
    side = max(side * SKIN, (math.prod(size) / max(most, 1)) ** (1 / d))
    cells = [max(1, int(length / side)) for length in size]
    bits = [HALF if shut else ROUND for shut in closed]
    return Axes(
        tuple(map(float, size)),
        inverse_lengths(size, closed),
        tuple(2.0**b / length for b, length in zip(bits, size, strict=True)),
        tuple(np.float32(length / 2.0**b) for b, length in zip(bits, size, strict=True)),
        tuple(np.uint64(b) for b in bits),
        tuple(n if n >= 3 else 1 for n in cells),
    )


def rows_of(dimension: int, cohesion: bool) -> int:
    """The number of sums of each bird."""
    return dimension * (3 if cohesion else 1) + 1


@by_type
def sum_rows(physics):
    """The same as a literal, by which the compiler tells rows of a strip apart."""
    axes = physics.types[physics.fields.index("axes")]
    rows = rows_of(len(axes.types[0]), has_cohesion(physics))
    return lambda physics: rows


def make(n: int, threads: int, axes: Axes, cohesion: bool) -> FlockMemory:
    """Arrays for so many birds; fill the first of `Birds` before a step."""
    d, cells = len(axes.size), math.prod(axes.cells)
    birds = Birds(
        np.zeros((2, d, n)),
        np.zeros((2, d, n)),
        np.zeros((2, d, n), np.int32),
        np.zeros((2, n), np.int32),
    )
    seen = Seen(
        np.zeros((d, n), np.int32),
        np.zeros((d, n), np.int32),
        np.zeros((rows_of(d, cohesion), n), np.int64),
    )
    found = Cells(
        np.zeros(n, np.int32),
        np.zeros((threads, cells), np.int32),
        np.zeros(cells + 1, np.int64),
        np.zeros(cells + 1, np.int64),
        np.zeros((threads, 2), np.int64),
    )
    scratch = Scratch(
        np.zeros((threads, 2 * d + 1, CHUNK + LANES), np.int32),
        np.zeros((threads, (rows_of(d, cohesion) + 3 * d + 1) * STRIP)),
        np.zeros((threads, 2, MOST_RUNS + 1), np.int64),
    )
    return FlockMemory(birds, seen, found, scratch)
