"""The loop over events: choose a site and a process, change states, find the next time."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.kernel import kernel
from mesokit.method.kinetic_monte_carlo.engine.classes import choose, put_class, total_rate
from mesokit.method.kinetic_monte_carlo.lattice.grid import coordinates, neighbour
from mesokit.method.kinetic_monte_carlo.model.protocol import (
    process_of,
    surroundings,
    surroundings_after,
)
from mesokit.scalar.elementary import short_log
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import METHOD, Counter, unit, unit_open, words

EVENT = METHOD + np.uint64(90)  # purpose of the random numbers of events

TIME, TIME_REST, NEXT, NEXT_REST, CLOCK = 0, 1, 2, 3, 4  # places in `Course.clock`


class Course(NamedTuple):
    """How far a run has come.

    seed. clock: time of the last event and of the next one, each as a sum of two numbers, so that
    it never loses short waiting times. drawn: (1,) waiting times so far. happened: (processes,
    directions + 1) events of each, the last column of those without a neighbour.
    """

    seed: np.uint64
    clock: NDArray[np.float64]
    drawn: NDArray[np.uint64]
    happened: NDArray[np.int64]


@scalar
def _put(sites, classes, i, around):
    sites.around[i] = around
    put_class(classes, i, np.int64(classes.by_surroundings[around]))


@scalar
def _tell_neighbours(model, sites, classes, i, old, new, but):
    """Change the surroundings of the neighbours of a site, but of those at one place."""
    for direction in range(sites.grid.neighbours):
        j = neighbour(sites.grid, i, direction)
        if j >= 0 and j != but:
            back = sites.grid.back[direction]
            _put(sites, classes, j, surroundings_after(model, sites, j, back, old, new))


@scalar
def _change(model, sites, classes, i, new, j, other):
    """Change the state of a site, and of a neighbour if j is not negative."""
    old, before = np.int64(sites.states[i]), np.int64(0)
    sites.states[i] = new
    if j >= 0:
        before = np.int64(sites.states[j])
        sites.states[j] = other
    if old != new:
        _tell_neighbours(model, sites, classes, i, old, new, j)
    if j >= 0:
        if before != other:
            _tell_neighbours(model, sites, classes, j, before, other, i)
        _put(sites, classes, j, surroundings(model, sites, j))
    _put(sites, classes, i, surroundings(model, sites, i))


@scalar
def _later(clock, waiting):
    """Set the next time: that of the event that happens now, and a waiting time."""
    now, rest = clock[NEXT], clock[NEXT_REST]
    clock[TIME], clock[TIME_REST] = now, rest
    total = now + waiting  # with the error of that sum (Knuth, TAOCP 2, 4.2.2)
    back = total - now
    rest += (now - (total - back)) + (waiting - back)
    clock[NEXT] = total + rest
    clock[NEXT_REST] = rest - (clock[NEXT] - total)


@scalar
def _wait(clock, total, word):
    """Set the next time by a waiting time that is exponential with the rate of all events."""
    if total > 0.0:
        _later(clock, -short_log(unit_open(word)) / total)
    else:
        clock[TIME], clock[TIME_REST] = clock[NEXT], clock[NEXT_REST]
        clock[NEXT], clock[NEXT_REST] = np.inf, 0.0


@kernel
def begin(model, sites, classes, course):
    """Find the classes of all sites and the time of the first event."""
    for i in range(len(sites.states)):
        r = coordinates(sites.grid, i)
        inside = True
        for k in range(len(r)):
            inside = inside and r[k] < sites.grid.size[k]
        if inside:
            _put(sites, classes, i, surroundings(model, sites, i))
    if course.drawn[0] == 0:
        a, _, _, _ = words(Counter(course.seed, np.uint64(0)), EVENT, 0, 0)
        course.drawn[0] = 1
        _wait(course.clock, total_rate(classes), a)


@kernel
def events(model, sites, classes, course, until, most):
    """The events up to a time, but no more than so many; whether these were all.

    What the next event waits for is not drawn anew: it happens in the next call, at its time, so
    that the lengths of calls change nothing.
    """
    clock, none, total = course.clock, sites.grid.neighbours, total_rate(classes)
    while clock[NEXT] < until or (clock[NEXT] == until and clock[NEXT_REST] <= 0.0):
        if most == 0:
            return False
        most -= 1
        a, b, c, _ = words(Counter(course.seed, course.drawn[0]), EVENT, 0, 0)
        course.drawn[0] += np.uint64(1)
        i, left = choose(classes, total, unit(a, b))
        process, new, direction, j, other = process_of(model, sites, i, left)
        course.happened[process, direction if direction >= 0 else none] += 1
        _change(model, sites, classes, i, new, j, other)
        total = total_rate(classes)
        _wait(clock, total, c)
    return True
