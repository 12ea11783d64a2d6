"""The loop over events: choose a site and a process, change states, find the next time."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.kernel import kernel
from mesokit.method.kinetic_monte_carlo.engine.choice import chance, choose, keeps, put, total_rate
from mesokit.method.kinetic_monte_carlo.lattice.grid import coordinates, neighbour
from mesokit.method.kinetic_monte_carlo.model.protocol import (
    MISSING,
    UNLIKE,
    change_of_own,
    change_of_weight,
    number_alone,
    process_of,
    weight,
)
from mesokit.scalar.elementary import short_log
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import METHOD, Counter, unit, unit_open, words

EVENT = METHOD + np.uint64(90)  # purpose of the random numbers of events

U = np.uint64
NONE = -(2**62)  # in place of a neighbour: no neighbour has it
AHEAD = 64  # events whose random numbers are made together, in vector instructions
TIME, TIME_REST, NEXT, NEXT_REST, CLOCK = 0, 1, 2, 3, 4  # places in `Course.clock`


class Numbers(NamedTuple):
    """Random numbers of AHEAD events, each by the event's number alone.

    units: uniform in [0, 1). waits: exponential with mean 1. streams: words for all else.
    """

    units: NDArray[np.float64]
    waits: NDArray[np.float64]
    streams: NDArray[np.uint64]


def numbers() -> Numbers:
    """Memory for them."""
    return Numbers(np.zeros(AHEAD), np.zeros(AHEAD), np.zeros(AHEAD, np.uint64))


@scalar
def draw(numbers, seed, purpose, n, index):
    """Draw the numbers of the event with number n and of all before the next multiple of AHEAD."""
    first = n & ~U(AHEAD - 1)
    for k in range(AHEAD):
        a, b, c, d = words(Counter(seed, first + U(k)), purpose, index, 0)
        numbers.units[U(k)] = unit(a, b)
        numbers.waits[U(k)] = unit_open(c)
        numbers.streams[U(k)] = (d << U(32)) | b
    for k in range(AHEAD):
        numbers.waits[U(k)] = -short_log(numbers.waits[U(k)])


class Course(NamedTuple):
    """How far a run has come.

    seed. numbers: of events to come. clock: time of the last event and of the next one, each as a sum of two numbers, so that
    it never loses short waiting times. drawn: (1,) waiting times so far. happened: (processes,
    directions + 1) events of each, the last column of those without a neighbour.
    """

    seed: np.uint64
    numbers: Numbers
    clock: NDArray[np.float64]
    drawn: NDArray[np.uint64]
    happened: NDArray[np.int64]


@scalar
def surroundings(model, sites, i):
    """The number of the surroundings of the site at a place, from the states around it."""
    state = np.int64(sites.states[U(i)])
    around = number_alone(model, state)
    for direction in range(sites.grid.neighbours):
        j = neighbour(sites.grid, i, direction)
        other = np.int64(sites.states[U(j)]) if j >= 0 else MISSING
        around += weight(model, direction, state, other)
    return around


@scalar
def _put(sites, choice, part, i, around):
    sites.around[U(i)] = around
    put(choice, part, i, around)


@scalar
def _change_around(model, sites, choice, part, i, old, new, j, before, other):
    """Change the surroundings of a site whose state has changed, and of its neighbours, after the
    state of the neighbour at j has changed too; those of j are left for later."""
    # in most models the number of the site's own surroundings changes by one and the same
    own = change_of_own(model, old, new)
    around = np.int64(sites.around[U(i)]) + own
    for direction in range(sites.grid.neighbours):
        k = neighbour(sites.grid, i, direction)
        if k == j:
            around += change_of_weight(model, direction, new, before, other)
        elif k >= 0:
            back, state = sites.grid.back[U(direction)], np.int64(sites.states[U(k)])
            change = change_of_weight(model, back, state, old, new)
            _put(sites, choice, part, k, np.int64(sites.around[U(k)]) + change)
    if own == UNLIKE:
        around = surroundings(model, sites, i)
    _put(sites, choice, part, i, around)


@scalar
def _change(model, sites, choice, part, i, new, j, other):
    """Change the state of a site, and of a neighbour if j is not negative."""
    old, before = np.int64(sites.states[U(i)]), np.int64(0)
    sites.states[U(i)] = new
    if j >= 0:
        before = np.int64(sites.states[U(j)])
        sites.states[U(j)] = other
        if keeps(choice):
            _change_around(model, sites, choice, part, i, old, new, j, before, other)
            _change_around(model, sites, choice, part, j, before, other, i, old, new)
    elif keeps(choice) and old != new:
        _change_around(model, sites, choice, part, i, old, new, NONE, before, other)


@scalar
def _later(now, rest, total, wait):
    """The time of the next event, as a sum of two numbers, by that of the last one and a waiting
    time in units of that which the rate of all events gives."""
    if total <= 0.0:
        return np.inf, 0.0
    waiting = wait / total
    later = now + waiting  # with the error of that sum (Knuth, TAOCP 2, 4.2.2)
    back = later - now
    rest += (now - (later - back)) + (waiting - back)
    return later + rest, rest - ((later + rest) - later)


@kernel
def begin(model, sites, choice, course):
    """Find the surroundings of all sites and the time of the first event."""
    if keeps(choice):
        for i in range(len(sites.states)):
            r, inside = coordinates(sites.grid, i), True
            for k in range(len(r)):
                inside = inside and r[k] < sites.grid.size[k]
            if inside:
                _put(sites, choice, 0, i, surroundings(model, sites, i))
    if course.drawn[0] == 0:
        draw(course.numbers, course.seed, EVENT, U(0), 0)
        course.drawn[0] = 1
        total, clock = total_rate(choice, 0), course.clock
        clock[NEXT], clock[NEXT_REST] = _later(0.0, 0.0, total, course.numbers.waits[0])


@kernel
def events(model, sites, choice, course, until, most):
    """The events up to a time, but no more than so many; whether these were all.

    What the next event waits for is not drawn anew: it happens in the next call, at its time, so
    that the lengths of calls change nothing.
    """
    clock, none, total = course.clock, sites.grid.neighbours, total_rate(choice, 0)
    last, last_rest, now, rest = clock[TIME], clock[TIME_REST], clock[NEXT], clock[NEXT_REST]
    n, numbers = course.drawn[0], course.numbers
    draw(numbers, course.seed, EVENT, n, 0)
    while now < until or (now == until and rest <= 0.0):
        if most == 0:
            break
        most -= 1
        k = n & U(AHEAD - 1)
        i, left = choose(choice, sites, 0, total, numbers.units[k], numbers.streams[k])
        if not keeps(choice):
            sites.around[U(i)] = surroundings(model, sites, i)
        happens = chance(choice, np.int64(sites.around[U(i)]))
        if left < happens:
            process, new, direction, j, other = process_of(model, sites, i, left / happens)
            column = direction if direction >= 0 else none
            course.happened[U(process * (none + 1) + column)] += 1
            _change(model, sites, choice, 0, i, new, j, other)
            total = total_rate(choice, 0)
        last, last_rest = now, rest
        now, rest = _later(now, rest, total, numbers.waits[k])
        n += U(1)
        if n & U(AHEAD - 1) == 0:
            draw(numbers, course.seed, EVENT, n, 0)
    clock[TIME], clock[TIME_REST], clock[NEXT], clock[NEXT_REST] = last, last_rest, now, rest
    course.drawn[0] = n
    return most > 0
