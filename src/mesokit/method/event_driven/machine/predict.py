"""What happens to a sphere next."""

import math

import numpy as np

from mesokit.method.event_driven.machine.groups import (
    FIRST_WALL,
    LEAVES,
    NOTHING,
    PARTNER,
    PARTNER_HITS,
    PREDICTIONS,
)
from mesokit.method.event_driven.machine.lists import time_to_leave
from mesokit.method.event_driven.machine.motion import (
    entries,
    meeting,
    mover,
    place_at,
    velocity_at,
)
from mesokit.method.event_driven.machine.walls import time_to_wall
from mesokit.scalar.jit import scalar


@scalar
def predict(world, rules, spheres, lists, queue, tally, i, now):
    """Find the next event of sphere i, and write it down; the queue is told by the caller."""
    state, number = spheres.state, spheres.number
    r, v = place_at(world, state, i, now), velocity_at(world, state, i, now)
    leaves = time_to_leave(world, lists, r, v, entries(lists.centre, i, 0, r))
    best = now + leaves
    partner = np.int64(LEAVES if leaves < math.inf else NOTHING)
    one = mover(state, i, r)
    # all times first and the soonest then, so that one pair need not wait for another
    near, times = lists.count[i], lists.times
    for a in range(near):
        times[a] = meeting(world, rules.pair, one, mover(state, lists.near[i, a], r), now)
    for a in range(near):
        if times[a] <= best:
            j = lists.near[i, a]
            if times[a] < best or (partner >= 0 and number[j] < number[partner]):
                best, partner = times[a], np.int64(j)
    for w in range(len(world.walls)):
        time = time_to_wall(world, state, i, w, best)
        if time < best:
            best, partner = time, np.int64(FIRST_WALL - w)
    queue.time[i], queue.event[i, PARTNER] = best, partner
    if partner >= 0:
        queue.event[i, PARTNER_HITS] = np.int32(spheres.hits[partner])
    tally.counts[PREDICTIONS] += 1
