"""One pass over all cells: from the sums over their particles to coefficients of the collision."""

from typing import Any, NamedTuple

import numpy as np

from mesokit.kernels.kernel import inner
from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, QUAD, record_length, share, sums_length
from mesokit.method.mpcd.collision.protocol import Cell, freedom
from mesokit.method.mpcd.collision.protocol import coefficients as coefficients_of
from mesokit.method.mpcd.engine.cell_gradient import gradient_at
from mesokit.method.mpcd.engine.cpu.physics import of_cells
from mesokit.method.mpcd.engine.cpu.strips.records import gather_sums, spread
from mesokit.method.mpcd.engine.cpu.strips.rows import (
    load_scratch,
    load_values,
    store_scratch,
    store_values,
)
from mesokit.method.mpcd.engine.cpu.strips.terms import nothing_found, read_sums
from mesokit.method.mpcd.engine.domains.messages.shared import any_own, key_of, shares
from mesokit.method.mpcd.thermostat.protocol import draw, guess
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.random import CELL, words
from mesokit.scalar.vector import added

MOST_DRAWS = 1000  # of a thermostat's random number, each accepted with more than 95 %


@scalar
def total_block(sums, start, count, totals, terms):
    """Add up the sums of all threads for these cells, and clear them.

    Sums that are 0 in four cells are only read: so threads seldom write to memory of others.
    """
    none = nothing_found(terms)
    for i in range(LANES):
        store_scratch(totals, i, none)
    together = count - count % QUAD
    length = np.uint64(sums_length(len(terms)))
    # Integer sums of all threads for one batch of cells. A cell belongs to the batch of one thread,
    # which also clears it for the next step, so there is no race. Four empty cells cost one test.
    for t in range(sums.shape[0]):
        for i in range(0, together, QUAD):
            found = np.int64(0)
            for j in range(QUAD):
                found |= sums[t, np.uint64(start + i + j) * length]
            if found != 0:
                gather_sums(sums[t], start + i, i, totals, terms)
        for i in range(together, count):
            cell = np.uint64(start + i) * length
            found_here = load_values(sums[t], cell, none)
            store_scratch(totals, i, added(load_scratch(totals, i, none), found_here))
            store_values(sums[t], cell, none)


@scalar
def put_block(coefficients, start, count, rows, c):
    """Write the rows to the records of these cells."""
    together = count - count % QUAD
    for i in range(0, together, QUAD):
        spread(coefficients, start + i, i, rows, c)
    for i in range(together, count):
        place = np.uint64(start + i) * np.uint64(record_length(len(c)))
        store_values(coefficients, place, load_scratch(rows, i, c))


@scalar
def draw_with_care(physics, counter, cell, free):
    """The thermostat's random number where the guess is not certain."""
    x, good = draw(physics.thermostat, counter, cell, free, 0)
    attempt = 1
    while not good and attempt < MOST_DRAWS:
        x, good = draw(physics.thermostat, counter, cell, free, attempt)
        attempt += 1
    return x


@by_type
def as_many(answer, coefficients):
    """The coefficients of a rule; raises if their number is not the declared one."""
    if len(answer) != len(coefficients):
        raise TypeError(
            f"coefficients gives {len(answer)} numbers; coefficient_count says {len(coefficients)}"
        )
    return lambda answer, coefficients: answer


@scalar
def needs_of_cell(physics, counter, cell, found, gradient, certain):
    """The coefficients of the collision in a cell, and whether they are certain.

    `gradient` is that of the sum for which the rule declares it; it follows the rule's own sums.

    The thermostat's random number is a guess, unless it must be `certain`: that takes longer.
    """
    n, mass, momentum, energy, own = read_sums(physics, found)
    sums = Cell(n, mass, momentum, energy, own + gradient)
    chance, free = words(counter, CELL, cell, 0), freedom(physics.rule, sums.number)
    x, sure = guess(physics.thermostat, chance[2:], free)
    if certain:
        x = draw_with_care(physics, counter, cell, free)
    answer = coefficients_of(physics.rule, physics.thermostat, x, chance[:2], sums)
    return as_many(answer, physics.coefficients), sure


@seldom
def sure_needs(physics, counter, cell, found, gradient):
    """The coefficients of a cell where the guess was not certain; for few cells."""
    answer, _ = needs_of_cell(physics, counter, cell, found, gradient, True)
    return answer


class InRow(NamedTuple):
    """Cells that follow one another, from the first."""

    start: int


class OfRows(NamedTuple):
    """Cells whose numbers are the first column of rows of a message: so many, from a row on."""

    rows: Any
    start: int
    cells: int


@by_type
def cell_at(which, i):
    """Number of the cell of lane i of a batch."""
    if which.instance_class is InRow:
        return lambda which, i: which.start + i
    return lambda which, i: which.rows[which.start + min(i, which.cells - 1), 0]


@scalar
def settle_batch(worker, counter, physics, fluid, which, count):
    """Coefficients of the cells of a batch: rows of coefficients from rows of sums."""
    cells, scratch = fluid.cells, fluid.scratch
    rows, totals = scratch.coefficients[worker.thread], scratch.terms[worker.thread]
    doubtful, none = scratch.marks[worker.thread], nothing_found(physics.terms)
    in_doubt = np.int64(0)
    # Thermostat and rule for all lanes without branches, as vectors; lanes beyond the last cell are
    # computed and not used. The thermostat's number is a guess, and lanes note whether it is
    # certain.
    for i in range(LANES):
        found, cell = load_scratch(totals, i, none), cell_at(which, i)
        gradient, key = gradient_at(cells.neighbour_sums, cell), key_of(cells.shared, cell)
        answer, sure = needs_of_cell(physics, counter, key, found, gradient, False)
        doubtful[i] = 1 - np.int64(sure)
        in_doubt |= doubtful[i]
        store_scratch(rows, i, answer)
    # The few uncertain cells draw again, one by one. Random words follow from the step and from the
    # number of the cell in the whole box, so neither batches nor ranks change them.
    for i in range(count if in_doubt != 0 else 0):
        if doubtful[i] != 0:
            found, cell = load_scratch(totals, i, none), cell_at(which, i)
            gradient, key = gradient_at(cells.neighbour_sums, cell), key_of(cells.shared, cell)
            store_scratch(rows, i, sure_needs(physics, counter, key, found, gradient))


@by_type
def is_empty(fluid):
    """Whether there is no fluid at all; a rank that has no particles may have cells of others."""
    if shares(fluid):
        return lambda fluid: False
    return lambda fluid: fluid.particles.filling.molecules == 0


@inner
def collide_cells(worker, now, physics, fluid):
    """Coefficients of every cell from its sums, which are cleared for the next step."""
    _collide(worker, now.counter, of_cells(physics), fluid)


@stage
def _collide(worker, counter, physics, fluid):
    cells, scratch = fluid.cells, fluid.scratch
    rows, totals = scratch.coefficients[worker.thread], scratch.terms[worker.thread]
    batches = (cells.number + LANES - 1) // LANES
    if is_empty(fluid):  # a random solvent is only where beads are
        batches = 0
    first, last = share(batches, worker.thread, worker.threads)
    # Batches of cells: integer sums become floats once, then coefficients for the collision at
    # t + dt, which the next sweep does. Each cell is written by one thread.
    for b in range(first, last):
        if not any_own(cells.shared, b):
            continue
        start = b * LANES
        count = min(LANES, cells.number - start)
        total_block(cells.sums, start, count, totals, physics.terms)
        settle_batch(worker, counter, physics, fluid, InRow(start), count)
        put_block(cells.coefficients, start, count, rows, physics.coefficients)
