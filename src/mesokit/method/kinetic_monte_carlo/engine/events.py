"""The loop over events: choose a site and a process, change states, find the next time."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.kernel import kernel
from mesokit.method.kinetic_monte_carlo.engine.change import (
    found,
    happen,
    known,
    set_around,
    settle_all,
    surroundings,
)
from mesokit.method.kinetic_monte_carlo.engine.choice import (
    ANY,
    chance,
    choose,
    fetch,
    foresee,
    keeps,
    planes_of,
    total_rate,
)
from mesokit.method.kinetic_monte_carlo.lattice.grid import coordinates
from mesokit.scalar.elementary import short_log
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.random import METHOD, Counter, unit, unit_open, words

EVENT = METHOD + np.uint64(90)  # purpose of the random numbers of events

U = np.uint64
AHEAD = 64  # events whose random numbers are made together, in vector instructions
NEAR = 2**17  # sites that a processor's cache has at hand
TIME, TIME_REST, NEXT, NEXT_REST, CLOCK = 0, 1, 2, 3, 4  # places in `Course.clock`


class Numbers(NamedTuple):
    """Random numbers of AHEAD events of each thread, each by the event's number alone.

    units: uniform in [0, 1). waits: exponential with mean 1. streams: words for all else.
    hints: where the events may be, for memory to fetch in time.
    """

    units: NDArray[np.float64]
    waits: NDArray[np.float64]
    streams: NDArray[np.uint64]
    hints: NDArray[np.int64]


def numbers_of(threads: int) -> Numbers:
    """Memory for those of so many threads."""
    size = AHEAD * threads
    return Numbers(
        np.zeros(size), np.zeros(size), np.zeros(size, np.uint64), np.zeros(size, np.int64)
    )


@scalar
def draw(numbers, seed, purpose, n, index, slot):
    """Draw the numbers of the event with number n, and of all in the same AHEAD, from a slot."""
    first = n & ~U(AHEAD - 1)
    for k in range(AHEAD):
        a, b, c, d = words(Counter(seed, first + U(k)), purpose, index, 0)
        numbers.units[U(slot + k)] = unit(a, b)
        numbers.waits[U(slot + k)] = unit_open(c)
        numbers.streams[U(slot + k)] = (d << U(32)) | b
    for k in range(AHEAD):
        numbers.waits[U(slot + k)] = -short_log(numbers.waits[U(slot + k)])


class Course(NamedTuple):
    """How far a run has come.

    seed. numbers: of events to come. clock: time of the last event and of the next one, each as a sum of two numbers, so that
    it never loses short waiting times. drawn: (1,) waiting times so far. vain: (1,) attempts
    since something happened. happened: (processes,
    directions + 1) events of each, the last column of those without a neighbour.
    """

    seed: np.uint64
    numbers: Numbers
    clock: NDArray[np.float64]
    drawn: NDArray[np.uint64]
    vain: NDArray[np.int64]
    happened: NDArray[np.int64]


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
            if _inside(sites.grid, i):
                around = surroundings(model, sites, i)
                set_around(model, sites, choice, ANY, i, around)
        for i in range(len(sites.states)):
            if _inside(sites.grid, i):
                settle_all(model, sites, choice, i)
    if course.drawn[0] == 0:
        draw(course.numbers, course.seed, EVENT, U(0), 0, 0)
        course.drawn[0] = 1
        total, clock = total_rate(choice, 0), course.clock
        clock[NEXT], clock[NEXT_REST] = _later(0.0, 0.0, total, course.numbers.waits[0])


@scalar
def _inside(grid, i):
    r, inside = coordinates(grid, i), True
    for k in range(len(r)):
        inside = inside and r[k] < grid.size[k]
    return inside


@kernel
def events(model, sites, choice, course, until, most):
    """The events up to a time, but no more than so many; whether these were all.

    What the next event waits for is not drawn anew: it happens in the next call, at its time, so
    that the lengths of calls change nothing.
    """
    clock, none, total = course.clock, sites.grid.neighbours, total_rate(choice, 0)
    last, last_rest, now, rest = clock[TIME], clock[TIME_REST], clock[NEXT], clock[NEXT_REST]
    n, vain, numbers = course.drawn[0], course.vain[0], course.numbers
    far = len(sites.states) > NEAR
    draw(numbers, course.seed, EVENT, n, 0, 0)
    if far and total > 0.0:
        foresee(choice, sites, total, numbers)
    while now < until or (now == until and rest <= 0.0):
        if most == 0:
            break
        most -= 1
        k = n & U(AHEAD - 1)
        if far and total > 0.0:
            fetch(choice, sites, numbers, np.int64(k))
        i, left = choose(choice, sites, 0, total, numbers.units[k], numbers.streams[k])
        around = known(model, sites, i) if keeps(choice) else found(model, sites, i)
        happens = chance(choice, around)
        if left < happens:
            process, direction = happen(model, sites, choice, 0, i, left / happens)
            column = direction if direction >= 0 else none
            course.happened[U(process * (none + 1) + column)] += 1
            total = total_rate(choice, 0)
            vain = 0
        else:
            vain += 1
        last, last_rest = now, rest
        now, rest = _later(now, rest, total, numbers.waits[k])
        if not keeps(choice) and vain >= 4 * len(sites.states) + 1000:
            vain = 0  # attempts do not tell whether anything can happen at all
            if not _possible(model, sites, choice):
                now, rest = np.inf, 0.0
        n += U(1)
        if n & U(AHEAD - 1) == 0:
            draw(numbers, course.seed, EVENT, n, 0, 0)
            if far and total > 0.0:
                foresee(choice, sites, total, numbers)
    clock[TIME], clock[TIME_REST], clock[NEXT], clock[NEXT_REST] = last, last_rest, now, rest
    course.drawn[0], course.vain[0] = n, vain
    return most > 0


@seldom
def _possible(model, sites, choice):
    """Whether anything can happen at any place."""
    for plane in range(planes_of(choice)):
        for i in range(len(sites.states)):
            place = plane * len(sites.states) + i
            if _inside(sites.grid, i) and chance(choice, found(model, sites, place)) > 0.0:
                return True
    return False
