"""The loops over events up to a time, and over spheres for new lists and predictions.

Events are at random places of a large gas, so each would wait for memory. The data of the next
events of the heap are therefore prefetched. Only the speed depends on this.
"""

import numpy as np

from mesokit.kernels.kernel import kernel
from mesokit.method.spheres.hard.engine.collide import IN_A_ROW, collide_pair, collide_wall
from mesokit.method.spheres.hard.engine.groups import (
    FIRST_WALL,
    LAST,
    LEAVES,
    LOST,
    PARTNER,
    PARTNER_HITS,
    RADIUS,
    TIME,
)
from mesokit.method.spheres.hard.engine.lists import find, link, renew
from mesokit.method.spheres.hard.engine.motion import bring_to, place_at, put_entries, velocity_at
from mesokit.method.spheres.hard.engine.predict import predict
from mesokit.method.spheres.hard.engine.queue import CURRENT, SIZE, insert, next_event, remove
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.prefetch import LINE, prefetch


@scalar
def with_partner(queue, i):
    """Sphere i and the sphere of its next event; i twice if that is with no sphere."""
    partner = np.int64(queue.event[i, PARTNER])
    return np.int64(i), partner if partner >= 0 else np.int64(i)


@scalar
def prefetch_neighbours(spheres, lists, queue):
    """Prefetch the states of the neighbours of spheres with the next events."""
    for place in range(1, min(3, queue.now[SIZE])):
        for i in with_partner(queue, queue.heap[place]):
            for a in range(lists.count[i]):
                prefetch(spheres.state, lists.near[i, a], 0)


@scalar
def prefetch_lists(spheres, lists, queue, i):
    """Prefetch states and lists of sphere i and of its partner."""
    for k in with_partner(queue, i):
        prefetch(queue.event, k, 0)
        prefetch(spheres.state, k, 0)
        prefetch(spheres.body, k, 0)
        prefetch(spheres.hits, k, 0)
        prefetch(lists.centre, k, 0)
        prefetch(lists.count, k, 0)
        for byte in range(0, np.int64(4) * lists.near.shape[1], LINE):
            prefetch(lists.near, k, byte)


DONE, FULL, COLLAPSED, PAUSED, FAILED = range(5)  # results of `run_events`
MANY = 100  # collisions in a row that take no time
AT_ONCE = 1_000_000  # events, after which Python can treat signals


@kernel
def run_events(world, rules, spheres, lists, queue, tally, end):
    """Do all events before the time `end` since the start of the window.

    Returns DONE, FULL (lists without room), COLLAPSED, PAUSED (after many events), or FAILED (no
    time was found at which a sphere meets a wall).
    """
    number, bin_before = spheres.number, np.int64(-1)
    # One event at a time, in the order of time, by one thread. Spheres of the event move from the
    # time of their last event to `now`; all others stay at theirs. A predicted hit counts only if
    # the partner has not collided since (`hits`); else the sphere just gets a new prediction. The
    # spheres of an event leave the queue, get a prediction, and enter again.
    for _ in range(AT_ONCE):
        i = next_event(queue, number, end)
        if i < 0:
            return DONE
        if queue.now[CURRENT] != bin_before:
            bin_before = queue.now[CURRENT]
            for place in range(queue.now[SIZE]):
                prefetch_lists(spheres, lists, queue, queue.heap[place])
        prefetch_neighbours(spheres, lists, queue)
        now, partner = queue.time[i], queue.event[i, PARTNER]
        other = i  # a partner that needs a new prediction too
        if partner >= 0:
            if np.int32(spheres.hits[partner]) == queue.event[i, PARTNER_HITS]:
                collide_pair(world, rules, spheres, tally, i, partner, now)
                other = partner
                if tally.counts[IN_A_ROW] >= MANY:
                    return COLLAPSED
        elif partner == LEAVES:
            if not renew(world, lists, spheres.state, i, boxed(world, spheres.state, i, now)):
                return FULL
        elif partner == LOST:
            return FAILED
        elif partner <= FIRST_WALL:
            collide_wall(world, rules, spheres, tally, i, FIRST_WALL - partner, now)
            if tally.counts[IN_A_ROW] >= MANY:
                return COLLAPSED
        for k in (i, other):
            remove(queue, number, k)
            predict(world, rules, spheres, lists, queue, k, now)
            insert(queue, number, k)
            if other == i:
                break
    return PAUSED


@scalar
def boxed(world, state, i, now):
    """The place of sphere i in the box at the time `now`."""
    r = place_at(world, state, i, now)
    for k in range(len(r)):
        r = with_item(r, k, r[k] - floor(r[k] * world.inverse[k]) * world.size[k])
    return r


@kernel
def rebuild(world, rules, spheres, lists, queue, now):
    """Make all lists and predictions from the states; false if a list had no room."""
    n, room = len(spheres.number), True
    lists.head[:] = -1
    lists.count[:] = 0
    # Lists at the time `now`. A sphere is linked to its cell after its search, so each pair is
    # found once, from its second sphere, and written on both lists.
    for i in range(n):
        r = boxed(world, spheres.state, i, now)
        put_entries(lists.centre, i, 0, r)
        room &= find(world, lists, spheres.state, i, r)
        link(lists, i, r)
    if not room:
        return False
    queue.first[:] = -1
    queue.now[CURRENT], queue.now[SIZE] = int(now * queue.per_time), 0
    for i in range(n):
        predict(world, rules, spheres, lists, queue, i, now)
        insert(queue, spheres.number, i)
    return True


@kernel
def synchronise(world, spheres, time):
    """Bring places, velocities and diameters to the end of a window, the time 0 of the next."""
    for i in range(len(spheres.number)):
        bring_to(world, spheres, i, time)
        spheres.state[i, TIME] = 0.0
        spheres.state[i, RADIUS] *= 1.0 + world.growth * time
        spheres.body[i, LAST] -= time


@kernel
def read(world, spheres, now, places, velocities):
    """Store places, inside the box or not, and velocities at `now` by particle number."""
    for i in range(len(spheres.number)):
        put_entries(places, spheres.number[i], 0, place_at(world, spheres.state, i, now))
        put_entries(velocities, spheres.number[i], 0, velocity_at(world, spheres.state, i, now))
