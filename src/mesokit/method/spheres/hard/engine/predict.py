"""The prediction of the next event of a sphere."""

import math

import numpy as np

from mesokit.method.spheres.common.walls import entries
from mesokit.method.spheres.hard.engine.groups import (
    FIRST_WALL,
    LEAVES,
    LOST,
    NOTHING,
    PARTNER,
    PARTNER_HITS,
    WIDTH,
)
from mesokit.method.spheres.hard.engine.lists import time_to_leave
from mesokit.method.spheres.hard.engine.motion import (
    of_column,
    of_row,
    pair_event_time,
    place_at,
    velocity_at,
)
from mesokit.method.spheres.hard.engine.walls import time_to_wall
from mesokit.scalar.jit import scalar

EIGHT = 8  # contacts in a vector; lengths of lists are multiples of it


@scalar
def predict(world, rules, spheres, lists, queue, i, now):
    """Store the next event of sphere i after the time `now`; the caller puts it into the queue."""
    state, number = spheres.state, spheres.number
    r, v = place_at(world, state, i, now), velocity_at(world, state, i, now)
    leaves = time_to_leave(world, lists, r, v, entries(lists.centre, i, 0, r))
    best = now + leaves
    partner = np.int64(LEAVES if leaves < math.inf else NOTHING)
    one = of_row(state, i, r)
    times = lists.times
    if world.growth != 0.0:
        collide_all(world, rules, state, lists, i, one, now, world.growth)
    else:
        collide_all(world, rules, state, lists, i, one, now, 0.0)
    # The soonest contact; of equal times the one with the lower particle number, so that the order
    # of the list does not matter.
    for a in range(lists.count[i]):
        if times[a] <= best:
            j = lists.near[i, a]
            if times[a] < best or (partner >= 0 and number[j] < number[partner]):
                best, partner = times[a], np.int64(j)
    for w in range(len(world.walls)):
        time = time_to_wall(world, one, w, best)
        if time < best:
            best, partner = time, np.int64(FIRST_WALL - w)
        elif math.isnan(time):
            best, partner = now, np.int64(LOST)
    queue.time[i], queue.event[i, PARTNER] = best, partner
    if partner >= 0:
        queue.event[i, PARTNER_HITS] = np.int32(spheres.hits[partner])


@scalar
def collide_all(world, rules, state, lists, i, one, now, growth):
    """Times of the events of sphere i with each sphere on its list; `growth` as a literal 0.0 where
    spheres do not grow, for the compiler."""
    near, columns = lists.count[i], lists.columns
    # A gather from rows of states, one cache line each, into columns. Then the times of eight
    # contacts are found at once, as vectors; entries beyond the end of the list are old and never
    # read. Each state is that of the last event of its sphere; free flight gives the place now.
    for a in range(near):
        j = lists.near[i, a]
        for k in range(WIDTH):
            columns[k, a] = state[j, k]
    for a in range((near + EIGHT - 1) & -EIGHT):
        other = of_column(columns, a, one.r)
        lists.times[a] = pair_event_time(world, rules.pair, one, other, now, growth)
