"""What the next events will read, asked for before it is due.

Events are at random places of a large gas: each would wait for memory again and again. The heap
knows some that come soon. Nothing but the time that events take depends on it.
"""

import numpy as np

from mesokit.method.spheres.hard.engine.groups import PARTNER
from mesokit.method.spheres.hard.engine.queue import SIZE
from mesokit.scalar.jit import scalar
from mesokit.scalar.prefetch import LINE, prefetch


@scalar
def ask_for_next(spheres, lists, queue):
    """The states of all on the lists of those whose events may be next."""
    for place in range(1, min(3, queue.now[SIZE])):
        i = queue.heap[place]
        ask_for_others(spheres, lists, i)
        j = queue.event[i, PARTNER]
        if j >= 0:
            ask_for_others(spheres, lists, j)


@scalar
def ask_for_others(spheres, lists, i):
    """The states of all on the list of a sphere."""
    for a in range(lists.count[i]):
        prefetch(spheres.state, lists.near[i, a], 0)


@scalar
def ask_for_lists(spheres, lists, queue, i):
    """What is known of sphere i and of its partner, and their lists."""
    j = queue.event[i, PARTNER]
    ask_for_list(spheres, lists, i)
    if j >= 0:
        ask_for_list(spheres, lists, j)
        prefetch(queue.event, j, 0)


@scalar
def ask_for_list(spheres, lists, i):
    """What is known of a sphere, and its list."""
    prefetch(spheres.state, i, 0)
    prefetch(spheres.body, i, 0)
    prefetch(spheres.hits, i, 0)
    prefetch(lists.centre, i, 0)
    prefetch(lists.count, i, 0)
    for byte in range(0, np.int64(4) * lists.near.shape[1], LINE):
        prefetch(lists.near, i, byte)
