"""The queue of events: a calendar of bins of time, and a heap of the current bin (Paul 2007).

The cost of an insertion, of a removal and of the next event does not depend on their number.
"""

from mesokit.method.spheres.hard.engine.groups import AFTER, BIN, PARTNER, PLACE, PREVIOUS
from mesokit.scalar.jit import scalar

HEAP, CURRENT, SIZE = -1, 0, 1
FAR = 2.0**52


@scalar
def sooner(queue, number, a, b):
    """Whether the event of a comes before that of b; equal times by the lower particle number."""
    if queue.time[a] != queue.time[b]:
        return queue.time[a] < queue.time[b]
    return key(queue, number, a) < key(queue, number, b)


@scalar
def key(queue, number, i):
    """The lower and the higher particle number of an event, as one number."""
    mine, other = number[i], number[i]
    if queue.event[i, PARTNER] >= 0:
        other = number[queue.event[i, PARTNER]]
    return min(mine, other) * 4294967296 + max(mine, other)


@scalar
def put_at(queue, place, i):
    """Write an entry of the heap."""
    queue.heap[place] = i
    queue.event[i, PLACE] = place


@scalar
def rise(queue, number, place):
    """Bring an entry of the heap up to where it belongs."""
    i = queue.heap[place]
    while place > 0:
        above = (place - 1) >> 1
        if not sooner(queue, number, i, queue.heap[above]):
            break
        put_at(queue, place, queue.heap[above])
        place = above
    put_at(queue, place, i)


@scalar
def sink(queue, number, place):
    """Bring an entry of the heap down to where it belongs."""
    i, size = queue.heap[place], queue.now[SIZE]
    # The sooner of the two events below moves up, until both are later. Equal times are ordered by
    # particle numbers, so the order of events does not depend on the history of the heap.
    while 2 * place + 1 < size:
        below = 2 * place + 1
        if below + 1 < size and sooner(queue, number, queue.heap[below + 1], queue.heap[below]):
            below += 1
        if not sooner(queue, number, queue.heap[below], i):
            break
        put_at(queue, place, queue.heap[below])
        place = below
    put_at(queue, place, i)


@scalar
def bin_at(queue, time):
    """The bin of a time; all very late times have one bin."""
    scaled = time * queue.per_time
    return int(scaled) if scaled < FAR else int(FAR)


@scalar
def insert(queue, number, i):
    """Insert the event of i; events beyond the calendar wait in its last bin."""
    wanted, current = bin_at(queue, queue.time[i]), queue.now[CURRENT]
    if wanted <= current:
        place = queue.now[SIZE]
        queue.now[SIZE], queue.event[i, BIN] = place + 1, HEAP
        put_at(queue, place, i)
        rise(queue, number, place)
    else:
        bins = len(queue.first)
        b = min(wanted, current + bins - 1) & (bins - 1)
        after = queue.first[b]
        queue.event[i, AFTER], queue.event[i, PREVIOUS], queue.event[i, BIN] = after, -1, b
        if after >= 0:
            queue.event[after, PREVIOUS] = i
        queue.first[b] = i


@scalar
def remove(queue, number, i):
    """Remove the event of i."""
    b = queue.event[i, BIN]
    if b == HEAP:
        place, last = queue.event[i, PLACE], queue.now[SIZE] - 1
        queue.now[SIZE] = last
        if place < last:
            put_at(queue, place, queue.heap[last])
            rise(queue, number, place)
            sink(queue, number, queue.event[queue.heap[place], PLACE])
    else:
        after, previous = queue.event[i, AFTER], queue.event[i, PREVIOUS]
        if after >= 0:
            queue.event[after, PREVIOUS] = previous
        if previous >= 0:
            queue.event[previous, AFTER] = after
        else:
            queue.first[b] = after


@scalar
def next_event(queue, number, end):
    """The sphere with the next event, -1 if there is none before the end."""
    bins = len(queue.first)
    # An empty heap takes all events of the next bin, up to that of `end`. The calendar is a ring:
    # an event beyond all bins waited in the last one, and `insert` may put it there again.
    while queue.now[SIZE] == 0:
        if queue.now[CURRENT] >= bin_at(queue, end):
            return -1
        queue.now[CURRENT] += 1
        b = queue.now[CURRENT] & (bins - 1)
        i = queue.first[b]
        queue.first[b] = -1
        while i >= 0:
            after = queue.event[i, AFTER]
            insert(queue, number, i)
            i = after
    i = queue.heap[0]
    return i if queue.time[i] < end else -1
