"""One pass over all cells: from the sums over their particles to what these need to collide."""

import numpy as np

from mesokit.execute.layout import (
    LANES,
    QUAD,
    fetch,
    inner,
    integers,
    note,
    put,
    read_sums,
    recall,
    record_length,
    share,
    sums_length,
)
from mesokit.execute.records import spread, take
from mesokit.mpcd.collision.protocol import coefficients as coefficients_of
from mesokit.mpcd.collision.protocol import freedom
from mesokit.mpcd.thermostat.protocol import draw, guess
from mesokit.scalar import added, scalar

MOST_DRAWS = 1000  # of a thermostat's random number, each accepted with more than 95 %


@scalar
def total_block(sums, start, count, totals, terms):
    """Add up what the threads found for these cells, and clear it."""
    none = (np.int64(0),) + integers(terms)
    for i in range(LANES):
        note(totals, i, none)
    together = count - count % QUAD
    length = sums_length(len(terms))
    for t in range(sums.shape[0]):
        for i in range(0, together, QUAD):
            take(sums[t], start + i, i, totals, terms)
        for i in range(together, count):
            cell = np.uint64(start + i) * np.uint64(length)
            note(totals, i, added(recall(totals, i, none), fetch(sums[t], cell, none)))
            put(sums[t], cell, none)


@scalar
def draw_block(physics, counter, start, count, totals, variates, doubtful):
    """The thermostat's random number for each cell; the few in doubt are drawn with care."""
    in_doubt = np.int64(0)
    for i in range(LANES):
        free = freedom(physics.rule, float(totals[i]))
        x, sure = guess(physics.thermostat, counter, start + i, free)
        variates[i] = x
        doubtful[i] = 1 - np.int64(sure)
        in_doubt |= doubtful[i]
    if in_doubt != 0:
        for i in range(count):
            attempt = 0
            while doubtful[i] != 0 and attempt < MOST_DRAWS:
                free = freedom(physics.rule, float(totals[i]))
                x, good = draw(physics.thermostat, counter, start + i, attempt, free)
                variates[i] = x
                doubtful[i] = 1 - np.int64(good)
                attempt += 1


@inner
def solve(thread, threads, physics, counter, cells, number, scratch, like, c, terms, scales):
    """Coefficients of every cell from its sums, which are cleared for the next step."""

    coefficients, sums = cells
    stride = record_length(len(c))
    rows, variates, doubtful, totals = scratch
    rows, variates = rows[thread], variates[thread]
    doubtful, totals = doubtful[thread], totals[thread]
    first, last = share((number + LANES - 1) // LANES, thread, threads)
    for b in range(first, last):
        start = b * LANES
        count = min(LANES, number - start)
        total_block(sums, start, count, totals, terms)
        draw_block(physics, counter, start, count, totals, variates, doubtful)
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
        together = count - count % QUAD
        for i in range(0, together, QUAD):
            spread(coefficients, start + i, i, rows, c)
        for i in range(together, count):
            put(coefficients, np.uint64(start + i) * np.uint64(stride), recall(rows, i, c))
