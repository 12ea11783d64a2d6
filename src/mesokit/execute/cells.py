"""One pass over all cells: from the sums over their particles to what these need to collide."""

import numpy as np

from mesokit.execute.cache import inner
from mesokit.execute.layout import LANES, QUAD, record_length, share, sums_length
from mesokit.execute.records import spread, take
from mesokit.execute.rows import fetch, note, put, recall
from mesokit.execute.sums import nothing_found, read_sums
from mesokit.mpcd.collision.protocol import coefficients as coefficients_of
from mesokit.mpcd.collision.protocol import freedom
from mesokit.mpcd.thermostat.protocol import draw, guess
from mesokit.random import CELL, words
from mesokit.scalar import added, scalar

MOST_DRAWS = 1000  # of a thermostat's random number, each accepted with more than 95 %


@scalar
def total_block(sums, start, count, totals, terms):
    """Add up what the threads found for these cells, and clear it.

    A thread that found nothing in four cells is passed over, so that no other writes to its memory.
    """
    none = nothing_found(terms)
    for i in range(LANES):
        note(totals, i, none)
    together = count - count % QUAD
    length = np.uint64(sums_length(len(terms)))
    for t in range(sums.shape[0]):
        for i in range(0, together, QUAD):
            found = np.int64(0)
            for j in range(QUAD):
                found |= sums[t, np.uint64(start + i + j) * length]
            if found != 0:
                take(sums[t], start + i, i, totals, terms)
        for i in range(together, count):
            cell = np.uint64(start + i) * length
            note(totals, i, added(recall(totals, i, none), fetch(sums[t], cell, none)))
            put(sums[t], cell, none)


@scalar
def put_block(coefficients, start, count, rows, c):
    """Write the rows to the records of these cells."""
    together = count - count % QUAD
    for i in range(0, together, QUAD):
        spread(coefficients, start + i, i, rows, c)
    for i in range(together, count):
        put(
            coefficients,
            np.uint64(start + i) * np.uint64(record_length(len(c))),
            recall(rows, i, c),
        )


@scalar
def draw_with_care(physics, counter, cell, free):
    """The thermostat's random number where a guess was not sure."""
    x, good = draw(physics.thermostat, counter, cell, free, 0)
    attempt = 1
    while not good and attempt < MOST_DRAWS:
        x, good = draw(physics.thermostat, counter, cell, free, attempt)
        attempt += 1
    return x


@inner
def solve(thread, threads, physics, counter, cells, number, scratch, like, c, terms, scales):
    """Coefficients of every cell from its sums, which are cleared for the next step."""
    coefficients, sums = cells
    rows, doubtful, totals = scratch
    rows, doubtful, totals = rows[thread], doubtful[thread], totals[thread]
    none = nothing_found(terms)
    first, last = share((number + LANES - 1) // LANES, thread, threads)
    for b in range(first, last):
        start = b * LANES
        count = min(LANES, number - start)
        total_block(sums, start, count, totals, terms)
        in_doubt = np.int64(0)
        for i in range(LANES):
            n, mass, momentum, energy, own = read_sums(
                physics.masses, physics.energy, recall(totals, i, none), like, scales
            )
            chance = words(counter, CELL, start + i, 0)
            x, sure = guess(physics.thermostat, chance[2:], freedom(physics.rule, n))
            doubtful[i] = 1 - np.int64(sure)
            in_doubt |= doubtful[i]
            answer = coefficients_of(
                physics.rule, physics.thermostat, x, chance[:2], n, mass, momentum, energy, own
            )
            note(rows, i, answer)
        for i in range(count if in_doubt != 0 else 0):
            if doubtful[i] != 0:
                n, mass, momentum, energy, own = read_sums(
                    physics.masses, physics.energy, recall(totals, i, none), like, scales
                )
                chance = words(counter, CELL, start + i, 0)
                x = draw_with_care(physics, counter, start + i, freedom(physics.rule, n))
                answer = coefficients_of(
                    physics.rule, physics.thermostat, x, chance[:2], n, mass, momentum, energy, own
                )
                note(rows, i, answer)
        put_block(coefficients, start, count, rows, c)
