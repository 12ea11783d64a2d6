"""What is recorded beside the states of sites, for observables that need it: which particle is
where and how far it has come, and how long sites keep their states.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.lattice.grid import coordinates
from mesokit.scalar.jit import scalar

U = np.uint64
LOST = -1  # the tag of a site whose particle came later than the tags
BINS = 4 * 2048  # of waiting times: four between powers of two, as doubles have


class Record(NamedTuple):
    """What is recorded; arrays without elements where it is not.

    on: whether anything is recorded. tags: (n,) by place, the number of the particle there, or
    LOST. moved: (tags * d,) sites that each has come along each axis. since: (n,) by place, when
    the site took its state. now: (1,) time of the event. waits: (states * BINS,) how many sites
    have left each state after times in each bin. sums: (states * 2,) of these times and of their
    squares.
    """

    on: int
    tags: NDArray[np.int32]
    moved: NDArray[np.int64]
    since: NDArray[np.float64]
    now: NDArray[np.float64]
    waits: NDArray[np.int64]
    sums: NDArray[np.float64]


def record_of(memory: int, dimension: int, states: int, tracers: bool, waits: bool) -> Record:
    """Memory for what is recorded."""
    tags, since = memory if tracers else 0, memory if waits else 0
    return Record(
        int(tracers or waits),
        np.full(tags, LOST, np.int32),
        np.zeros(tags * dimension, np.int64),
        np.zeros(since),
        np.zeros(1),
        np.zeros(states * BINS if waits else 0, np.int64),
        np.zeros(states * 2 if waits else 0),
    )


def edges() -> NDArray[np.float64]:
    """Edges (BINS,) of the bins of waiting times, the lower ones.

    >>> float(edges()[4 * 1023]), float(edges()[4 * 1023 + 2])
    (1.0, 1.5)
    """
    return (np.arange(BINS, dtype=np.int64) << 50).view(np.float64)


@scalar
def leave_state(record, i, old):
    """Note that a site leaves a state now."""
    wait = record.now[0] - record.since[U(i)]
    record.since[U(i)] = record.now[0]
    bits = np.float64(wait).view(np.int64)  # exponent and two more bits: four bins to a factor of 2
    record.waits[U(old * BINS + (bits >> 50))] += 1
    record.sums[U(2 * old)] += wait
    record.sums[U(2 * old + 1)] += wait * wait


@scalar
def move(record, grid, i, j):
    """Let the particles at two neighbouring sites take each other's places."""
    one, other = np.int64(record.tags[U(i)]), np.int64(record.tags[U(j)])
    record.tags[U(i)], record.tags[U(j)] = other, one
    a, b = coordinates(grid, i), coordinates(grid, j)
    d = len(grid.size)
    for k in range(d):
        step = b[k] - a[k]
        # one site on, also through the end of a periodic lattice
        step = step - grid.size[k] if step > 1 else (step + grid.size[k] if step < -1 else step)
        if one >= 0:
            record.moved[U(one * d + k)] += step
        if other >= 0:
            record.moved[U(other * d + k)] -= step


@scalar
def change_recorded(record, grid, of_site, of_neighbour):
    """Note a change at a site, and at a neighbour if its place is not negative: the place of each,
    and its states before and after."""
    (i, old, new), (j, before, other) = of_site, of_neighbour
    if len(record.since) > 0:
        if old != new:
            leave_state(record, i, old)
        if j >= 0 and before != other:
            leave_state(record, j, before)
    if len(record.tags) > 0:
        if j >= 0 and new == before and other == old:
            if old != new:
                move(record, grid, i, j)
        else:
            if old != new:
                record.tags[U(i)] = LOST
            if j >= 0 and before != other:
                record.tags[U(j)] = LOST
