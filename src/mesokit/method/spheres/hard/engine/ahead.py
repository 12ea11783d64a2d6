"""Prefetch of the memory that the next events will read.

Events are at random places of a large gas, so each would wait for memory again and again. The heap
holds some of the next events. Only the speed depends on this.
"""

import numpy as np

from mesokit.method.spheres.hard.engine.groups import PARTNER
from mesokit.method.spheres.hard.engine.queue import SIZE
from mesokit.scalar.jit import scalar
from mesokit.scalar.prefetch import LINE, prefetch


@scalar
def ask_for_next(spheres, lists, queue):
    """Prefetch the states of the neighbours of spheres with the next events."""
    for place in range(1, min(3, queue.now[SIZE])):
        i = queue.heap[place]
        ask_for_others(spheres, lists, i)
        j = queue.event[i, PARTNER]
        if j >= 0:
            ask_for_others(spheres, lists, j)


@scalar
def ask_for_others(spheres, lists, i):
    """Prefetch the states of the neighbours of a sphere."""
    for a in range(lists.count[i]):
        prefetch(spheres.state, lists.near[i, a], 0)


@scalar
def ask_for_lists(spheres, lists, queue, i):
    """Prefetch states and lists of sphere i and of its partner."""
    j = queue.event[i, PARTNER]
    ask_for_list(spheres, lists, i)
    if j >= 0:
        ask_for_list(spheres, lists, j)
        prefetch(queue.event, j, 0)


@scalar
def ask_for_list(spheres, lists, i):
    """Prefetch state and list of a sphere."""
    prefetch(spheres.state, i, 0)
    prefetch(spheres.body, i, 0)
    prefetch(spheres.hits, i, 0)
    prefetch(lists.centre, i, 0)
    prefetch(lists.count, i, 0)
    for byte in range(0, np.int64(4) * lists.near.shape[1], LINE):
        prefetch(lists.near, i, byte)
