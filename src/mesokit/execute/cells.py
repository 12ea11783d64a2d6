"""One pass over all cells: from the sums over their particles to what these need to collide."""

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.execute.layout import LANES, inner, note, read_sums, recall, share
from mesokit.mpcd.collision.protocol import coefficients as coefficients_of
from mesokit.mpcd.collision.protocol import freedom
from mesokit.mpcd.thermostat.protocol import draw
from mesokit.scalar import scalar

MOST_DRAWS = 1000  # of a thermostat's random number, each accepted with more than 95 %


@scalar
def total_block(sums, start, count, totals, terms):
    """Add up what the threads found for these cells, and clear it."""
    width = len(terms) + 1
    for i in range(count):
        cell = np.uint64(start + i) * np.uint64(width)
        n = np.int64(0)
        for k in range(len(terms)):
            terms = tuple_setitem(terms, k, np.int64(0))
        for t in range(sums.shape[0]):
            n += sums[t, cell]
            sums[t, cell] = 0
            for k in range(len(terms)):
                terms = tuple_setitem(terms, k, terms[k] + sums[t, cell + np.uint64(1 + k)])
                sums[t, cell + np.uint64(1 + k)] = 0
        note(totals, i, (n,) + terms)


@scalar
def draw_block(physics, counter, start, count, totals, variates, accepted):
    """The thermostat's random number for each cell; the few that are refused are drawn again."""
    refused = np.int64(0)
    for i in range(LANES):
        n = float(totals[i])
        x, good = draw(physics.thermostat, counter, start + i, 0, freedom(physics.rule, n))
        variates[i] = x
        accepted[i] = np.int64(good)
        refused |= 1 - np.int64(good)
    if refused != 0:
        for i in range(count):
            attempt = 1
            while accepted[i] == 0 and attempt < MOST_DRAWS:
                free = freedom(physics.rule, float(totals[i]))
                x, good = draw(physics.thermostat, counter, start + i, attempt, free)
                variates[i] = x
                accepted[i] = np.int64(good)
                attempt += 1


@inner
def solve(thread, threads, physics, counter, cells, number, scratch, like, c, terms, scales):
    """Coefficients of every cell from its sums, which are cleared for the next step."""
    coefficients, stride, sums = cells
    rows, variates, accepted, totals = scratch
    rows, variates = rows[thread], variates[thread]
    accepted, totals = accepted[thread], totals[thread]
    first, last = share((number + LANES - 1) // LANES, thread, threads)
    for b in range(first, last):
        start = b * LANES
        count = min(LANES, number - start)
        total_block(sums, start, count, totals, terms)
        draw_block(physics, counter, start, count, totals, variates, accepted)
        for i in range(LANES):
            n, mass, momentum, energy, own = read_sums(
                physics.masses, physics.energy, totals, i, like, terms, scales
            )
            x, cell = variates[i], start + i
            answer = coefficients_of(
                physics.rule,
                physics.thermostat,
                x,
                counter,
                cell,
                n,
                mass,
                momentum,
                energy,
                own,
            )
            note(rows, i, answer)
        for i in range(count):
            answer = recall(rows, i, c)
            first_place = np.uint64(start + i) * np.uint64(stride)
            for k in range(len(c)):
                coefficients[first_place + np.uint64(k)] = answer[k]
