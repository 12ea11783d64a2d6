"""The messages of a step: sums go to the owners of cells, coefficients of collisions return.

Rows are those of cells that are not empty, in one order, and then those of ghosts. Sums are
integers, so no bit depends on the rank or the order in which terms are added.
"""

import numpy as np

from mesokit.kernels.part import stage
from mesokit.loops.clock import CELLS, SHARE, WAIT, lap
from mesokit.loops.layout import LANES, record_length, share, sums_length
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.cpu.collide import OfRows, settle_batch
from mesokit.method.mpcd.engine.cpu.strips.rows import load_scratch, store_scratch, store_values
from mesokit.method.mpcd.engine.cpu.strips.terms import nothing_found, sums_of_cell
from mesokit.method.mpcd.engine.domains.beads.terms import (
    bead_row,
    find_bead_owners,
    joint_answer,
    remote_beads,
    send_terms,
    take_terms,
)
from mesokit.method.mpcd.engine.domains.messages.flow import take_seen, write_seen
from mesokit.method.mpcd.engine.domains.messages.ghosts import find_owners
from mesokit.method.mpcd.engine.domains.messages.mpi import finish
from mesokit.method.mpcd.engine.domains.messages.shared import (
    FAULTS,
    FULL,
    GHOSTS,
    HEADER,
    RECORD_WORDS,
    SUM_WORDS,
    receive_rows,
    send_rows,
    shares,
)
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import elementwise, for_each, scalar

SUMS, COEFFICIENTS = 1, 2  # tags of messages


@elementwise
def load_row(rows, row, pattern):
    """The first numbers of a row, as a tuple as long as `pattern`."""
    return "rows[row, {k}]"


@for_each
def write_row(rows, row, values):
    """Write a tuple to the start of a row."""
    return "rows[row, {k}] = values[{k}]"


@where(fluid=shares)
@stage
def exchange_sums(worker, now, physics, fluid, beads):
    """Send the sums of cells of partners to their owners, and add those received to own cells."""
    shared = fluid.cells.shared
    partners = len(shared.ranks)
    find_owners(worker, now, physics, fluid)
    find_bead_owners(worker, now, physics, fluid, beads)
    # Threads count their rows before any writes. The counts say where the rows of each thread
    # begin, so all write to one message without a race. The order of rows depends on the number of
    # threads; the integer sums do not.
    for p in range(partners):
        rows = count_rows(worker, fluid.cells, p, physics) + remote_beads(worker, beads, p)
        shared.counting[worker.thread, p] = rows
    barrier(worker)
    for p in range(partners):
        write_rows(worker, fluid, beads, p, physics)
    barrier(worker)
    lap(worker, SHARE)
    if worker.thread == 0:
        send_sums(worker, shared, beads)
        take_terms(beads)
    barrier(worker)
    lap(worker, WAIT)
    for p in range(partners):
        add_rows(worker, fluid.cells, p, physics)
    barrier(worker)
    lap(worker, SHARE)


@scalar
def count_rows(worker, cells, p, physics):
    """Number of rows for a partner: occupied cells in this thread's share, and its ghosts."""
    shared, number = cells.shared, 0
    width = np.uint64(sums_length(len(physics.terms)))
    first, last = part_of_list(worker, shared.starts, p)
    # The first sum of a cell counts its particles. Most halo cells of the second layer are empty
    # and have no row.
    for j in range(first, last):
        found = np.int64(0)
        for t in range(cells.sums.shape[0]):
            found |= cells.sums[t, np.uint64(shared.mine[j]) * width]
        number += found != 0
    for n in range(shared.ghosts[worker.thread, 0]):
        number += shared.ghost_owner[worker.thread, n] == p
    return number


@scalar
def part_of_list(worker, starts, p):
    """First and last + 1 of a thread's share of the list of a partner."""
    first, last = share(starts[p + 1] - starts[p], worker.thread, worker.threads)
    return starts[p] + first, starts[p] + last


@scalar
def write_rows(worker, fluid, beads, p, physics):
    """Write the rows of this thread for a partner; clears the sums of these cells."""
    cells, shared, t = fluid.cells, fluid.cells.shared, worker.thread
    row = shared.out_at[p] + HEADER + 1  # and the rows of the threads before this one
    for before in range(t):
        row += shared.counting[before, p]
    if row + shared.counting[t, p] > shared.out_at[p + 1]:
        shared.noted[FAULTS] |= FULL
        shared.counting[t, p] = 0
        return
    width = sums_length(len(physics.terms))
    first, last = part_of_list(worker, shared.starts, p)
    # Occupied halo cells of the partner, in the order of `mine`: the sums of all threads become
    # one row and are cleared. `records` keeps the cell of each row for the coefficients.
    for j in range(first, last):
        start, found = np.uint64(shared.mine[j]) * np.uint64(width), np.int64(0)
        for u in range(cells.sums.shape[0]):
            found |= cells.sums[u, start]
        if found != 0:
            shared.records[row], shared.sums_out[row, 0] = shared.mine[j], shared.theirs[j]
            for k in range(width):
                at, total = start + np.uint64(k), np.int64(0)
                for u in range(cells.sums.shape[0]):
                    total += cells.sums[u, at]
                    cells.sums[u, at] = 0
                shared.sums_out[row, 1 + k] = total
            row += 1
    slot = cells.number + 1 + t * shared.ghost_place.shape[1]
    # Each ghost is a row of its own, since its cell has no sums here. It points to a record behind
    # all cells of the halo, and its coefficients return to that record.
    for n in range(shared.ghosts[t, 0]):
        if shared.ghost_owner[t, n] == p:
            fluid.particles.cell[shared.ghost_place[t, n]] = slot + n
            shared.records[row], shared.sums_out[row, 0] = slot + n, shared.ghost_cell[t, n]
            for k in range(width):
                shared.sums_out[row, 1 + k] = shared.ghost_terms[t, n, k]
            row += 1
    # Rows of remote beads are empty: they only bring back a record. `send_terms` has their terms.
    for j in range(remote_beads(worker, beads, p)):
        shared.records[row], shared.sums_out[row, 0] = bead_row(beads, p, j)
        for k in range(width):
            shared.sums_out[row, 1 + k] = 0
        row += 1


@scalar
def send_sums(worker, shared, beads):
    """Send all rows, and wait for those of all partners."""
    n = receive_rows(shared, send_terms(beads, shared, 0), shared.sums_in, shared.in_at, SUMS)
    for p in range(len(shared.ranks)):
        first, rows = shared.out_at[p], 0
        for t in range(worker.threads):
            rows += shared.counting[t, p]
        shared.sent[p] = rows
        shared.sums_out[first + HEADER, 0] = rows
        n = send_rows(shared, n, shared.sums_out, first, 1 + rows, p, SUMS, SUM_WORDS)
    for t in range(worker.threads):
        shared.meter[GHOSTS] = max(shared.meter[GHOSTS], shared.ghosts[t, 0])
        shared.ghosts[t, 0] = 0
    finish(shared.post, n)


@scalar
def rows_in(shared, p):
    """Number of rows that a partner has sent."""
    return shared.sums_in[shared.in_at[p] + HEADER, 0]


@scalar
def add_rows(worker, cells, p, physics):
    """Add the rows of a partner to the sums of own cells."""
    shared, sums = cells.shared, cells.sums[worker.thread]
    width = sums_length(len(physics.terms))
    first, last = share(rows_in(shared, p), worker.thread, worker.threads)
    # Rows of one cell may come from two partners, or be two ghosts in it. Each thread adds to sums
    # of its own, so this is no race.
    for row in range(shared.in_at[p] + HEADER + 1 + first, shared.in_at[p] + HEADER + 1 + last):
        start = np.uint64(shared.sums_in[row, 0]) * np.uint64(width)
        for k in range(width):
            sums[start + np.uint64(k)] += shared.sums_in[row, 1 + k]


@where(fluid=shares)
@stage
def send_coefficients(worker, now, physics, fluid, beads, walls):
    """Send coefficients of the rows received; messages travel while own cells collide."""
    shared = fluid.cells.shared
    if len(beads) > 0:
        barrier(worker)  # coefficients of cells with beads are complete
    # Rows of a partner are settled like own cells, LANES at a time. Sums stay as they are, because
    # several partners may have particles in one cell. Only the owner computes coefficients, so
    # all ranks collide with the same bits.
    for p in range(len(shared.ranks)):
        rows = rows_in(shared, p)
        first, last = share((rows + LANES - 1) // LANES, worker.thread, worker.threads)
        for b in range(first, last):
            start = shared.in_at[p] + HEADER + 1 + b * LANES
            count = min(LANES, rows - b * LANES)
            settle_rows(worker, now, physics, fluid, beads, start, count)
    barrier(worker)
    if worker.thread == 0:
        begin_coefficients(now, physics, shared, walls)
    lap(worker, SHARE)


@scalar
def settle_rows(worker, now, physics, fluid, beads, start, count):
    """Coefficients of the cells of some rows; the cells keep their sums."""
    cells, scratch, none = fluid.cells, fluid.scratch, nothing_found(physics.terms)
    totals, out = scratch.terms[worker.thread], scratch.coefficients[worker.thread]
    rows, answers = cells.shared.sums_in, cells.shared.coefficients_out
    for i in range(LANES):
        store_scratch(totals, i, none)
    for i in range(count):
        found = sums_of_cell(cells.sums, rows[start + i, 0], physics.terms)
        store_scratch(totals, i, found)
    settle_batch(worker, now.counter, physics, fluid, OfRows(rows, start, count), count)
    for i in range(count):
        answer = load_scratch(out, i, physics.coefficients)
        write_row(answers, start + i, joint_answer(beads, rows[start + i, 0], answer))


@scalar
def begin_coefficients(now, physics, shared, walls):
    """Begin to send coefficients, then the flow at surfaces, and to receive those of partners.

    Open messages are counted from 0: `receive_coefficients` waits for them.
    """
    n = receive_rows(shared, 0, shared.coefficients_in, shared.out_at, COEFFICIENTS)
    for p in range(len(shared.ranks)):
        first, rows = shared.in_at[p], rows_in(shared, p)
        seen = write_seen(walls, now, physics, shared, p, first + HEADER + 1 + rows)
        shared.coefficients_out[first + HEADER, 0] = float(seen)
        number = 1 + rows + seen
        n = send_rows(
            shared, n, shared.coefficients_out, first, number, p, COEFFICIENTS, RECORD_WORDS
        )


@where(fluid=shares)
@stage
def receive_coefficients(worker, now, physics, fluid, walls):
    """Receive the coefficients of halo cells, ghosts and remote beads."""
    shared = fluid.cells.shared
    partners = len(shared.ranks)
    barrier(worker)
    lap(worker, CELLS)
    if worker.thread == 0:
        finish(shared.post, 2 * partners)
    barrier(worker)
    lap(worker, WAIT)
    for p in range(partners):
        store_coefficients(worker, fluid.cells, p, physics.coefficients)
    if worker.thread == 0:
        take_seen(walls, now, physics, shared)
    barrier(worker)
    lap(worker, SHARE)


@scalar
def store_coefficients(worker, cells, p, needed):
    """Store the coefficients from a partner in the records of its cells."""
    shared, length = cells.shared, np.uint64(record_length(len(needed)))
    first, last = share(shared.sent[p], worker.thread, worker.threads)
    begin = shared.out_at[p] + HEADER + 1
    # Rows return in the order in which they were sent, so `records` has the place of each. No two
    # rows have the same record: threads share the rows without a race.
    for row in range(begin + first, begin + last):
        start = np.uint64(shared.records[row]) * length
        store_values(cells.coefficients, start, load_row(shared.coefficients_in, row, needed))
