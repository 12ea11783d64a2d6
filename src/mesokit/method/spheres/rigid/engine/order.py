"""The order in which contacts are updated: colour after colour, by number, or at random.

It depends on the numbers of the grains alone, neither on threads nor on places in memory. Contacts
of one colour have no grain in common, so that threads share them, and their order changes no bit.
"""

import numpy as np

from mesokit.method.spheres.rigid.engine.groups import COUNT, MOST_COLOURS
from mesokit.method.spheres.rigid.solver.protocol import COLOURED, TOGETHER
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import METHOD, words

SHUFFLE = METHOD + np.uint64(70)  # purpose of the random numbers of an order


@scalar
def arrange(worker, solver, n, plates, found, order, noted):
    """Find the place of every contact; how many there are. One thread does this."""
    most = len(found.slot) // worker.threads
    total = by_number(worker, n, most, found, order, noted)
    if solver.order == COLOURED or solver.order == TOGETHER:
        colour(worker, n, plates, most, total, found, order, noted)
    else:  # none has a colour: one thread updates them all
        order.colours[:] = 0
        order.colours[MOST_COLOURS + 1] = total
        for q in range(total):
            order.at[order.by_number[q]] = q
    return total


@scalar
def by_number(worker, n, most, found, order, noted):
    """Contacts in the order of the smaller number of their grains, then of the other."""
    begin, key = order.begin, found.key
    begin[:] = 0
    # Counting sort: contacts of each smaller number, where these begin, and then each to its place,
    # moved forward past those of larger other numbers: few have the same smaller number.
    for t in range(worker.threads):
        for f in range(t * most, t * most + np.int64(noted[t, COUNT])):
            begin[key[f, 0] + 1] += 1
    for k in range(n):
        begin[k + 1] += begin[k]
        order.used[k] = begin[k]
    for t in range(worker.threads):
        for f in range(t * most, t * most + np.int64(noted[t, COUNT])):
            low, other = key[f, 0], key[f, 1]
            q = order.used[low]
            order.used[low] = q + 1
            while q > begin[low] and key[order.by_number[q - 1], 1] > other:
                order.by_number[q] = order.by_number[q - 1]
                q -= 1
            order.by_number[q] = f
    return begin[n]


@scalar
def colour(worker, n, plates, most, total, found, order, noted):
    """Colour the contacts: each has the first colour that none of its two grains has yet."""
    used, colours = order.used, order.colours
    used[:] = 0
    colours[:] = 0
    for q in range(total):
        f = order.by_number[q]
        i, j = found.pair[f, 0], found.pair[f, 1]
        taken, free = used[i] | (used[j] if j < n else 0), 0
        if j >= plates:  # a plate that is pushed, with which others are in contact as well
            free = MOST_COLOURS
        while free < MOST_COLOURS and taken & 1:
            taken, free = taken >> 1, free + 1
        order.colour[f] = free
        colours[free + 1] += 1
        if free < MOST_COLOURS:
            used[i] |= 1 << free
            if j < n:
                used[j] |= 1 << free
    for k in range(MOST_COLOURS + 1):
        colours[k + 1] += colours[k]
    # Contacts of a colour in the order of memory, those without one in the order of numbers.
    # `colours` moves on to the ends, so it is shifted back afterwards.
    for t in range(worker.threads):
        for f in range(t * most, t * most + np.int64(noted[t, COUNT])):
            k = order.colour[f]
            if k < MOST_COLOURS:
                order.at[f] = colours[k]
                colours[k] += 1
    for q in range(total):
        f = order.by_number[q]
        if order.colour[f] == MOST_COLOURS:
            order.at[f] = colours[MOST_COLOURS]
            colours[MOST_COLOURS] += 1
    for k in range(MOST_COLOURS, 0, -1):
        colours[k] = colours[k - 1]
    colours[0] = 0


@scalar
def shuffle(counter, sweep, total, shuffled):
    """Draw an order of all contacts for a sweep (Fisher and Yates 1938)."""
    for q in range(total):
        shuffled[q] = q
    # Four words a draw; each word picks one of those that are left, by its high bits.
    q, left = 0, total
    while left > 1:
        for word in words(counter, SHUFFLE, q, sweep):
            if left > 1:
                pick = np.int64((word * np.uint64(left)) >> np.uint64(32))
                left -= 1
                shuffled[left], shuffled[pick] = shuffled[pick], shuffled[left]
        q += 1
