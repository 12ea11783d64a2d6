"""The messages of a step: sums go to the ranks whose cells they are of, answers come back.

Rows are those of cells that are not empty, in one order, and then those of guests. Integers are
added, so that who found them changes no bit.
"""

import numpy as np

from mesokit.kernels.part import stage
from mesokit.loops.clock import CELLS, SHARE, WAIT, lap
from mesokit.loops.layout import LANES, record_length, share, sums_length
from mesokit.loops.threads import meet
from mesokit.method.mpcd.engine.cpu.collide import Asked, settle_batch
from mesokit.method.mpcd.engine.cpu.strips.rows import load_scratch, store_scratch, store_values
from mesokit.method.mpcd.engine.cpu.strips.terms import nothing_found, sums_of_cell
from mesokit.method.mpcd.engine.domains.beads.terms import (
    bead_row,
    beads_that_ask,
    find_bead_owners,
    joint_answer,
    send_terms,
    take_terms,
)
from mesokit.method.mpcd.engine.domains.messages.flow import take_seen, write_seen
from mesokit.method.mpcd.engine.domains.messages.guests import find_owners
from mesokit.method.mpcd.engine.domains.messages.mpi import finish
from mesokit.method.mpcd.engine.domains.messages.rows import receive_rows, send_rows
from mesokit.method.mpcd.engine.domains.messages.shared import (
    ANSWER_WORDS,
    FAULTS,
    FULL,
    GUESTS,
    HEADER,
    SUM_WORDS,
    shares,
)
from mesokit.scalar.jit import by_type, elementwise, for_each, scalar

SUMS, ANSWERS = 1, 2  # tags of messages


@elementwise
def load_row(rows, row, like):
    """The first numbers of a row, as a tuple as long as `like`."""
    return "rows[row, {k}]"


@for_each
def write_row(rows, row, values):
    """Write a tuple to the begin of a row."""
    return "rows[row, {k}] = values[{k}]"


@by_type
def give_sums(team, now, physics, fluid, beads):
    """What this rank's particles add to cells of others goes there; what theirs add comes here."""
    if not shares(fluid):
        return lambda team, now, physics, fluid, beads: None
    return lambda team, now, physics, fluid, beads: _give(team, now, physics, fluid, beads)


@stage
def _give(team, now, physics, fluid, beads):
    shared = fluid.cells.shared
    partners = len(shared.ranks)
    find_owners(team, now, physics, fluid)
    find_bead_owners(team, now, physics, fluid, beads)
    for p in range(partners):
        rows = count_rows(team, fluid.cells, p, physics) + beads_that_ask(team, beads, p)
        shared.counting[team.thread, p] = rows
    meet(team)
    for p in range(partners):
        write_rows(team, fluid, beads, p, physics)
    meet(team)
    lap(team, SHARE)
    if team.thread == 0:
        send_sums(team, shared, beads)
        take_terms(beads)
    meet(team)
    lap(team, WAIT)
    for p in range(partners):
        add_rows(team, fluid.cells, p, physics)
    meet(team)
    lap(team, SHARE)


@scalar
def count_rows(team, cells, p, physics):
    """Rows for a partner from this thread's share of the cells and from its guests."""
    shared, number = cells.shared, 0
    width = np.uint64(sums_length(len(physics.terms)))
    first, last = part_of_list(team, shared.starts, p)
    for j in range(first, last):
        found = np.int64(0)
        for t in range(cells.sums.shape[0]):
            found |= cells.sums[t, np.uint64(shared.mine[j]) * width]
        number += found != 0
    for n in range(shared.guests[team.thread, 0]):
        number += shared.guest_owner[team.thread, n] == p
    return number


@scalar
def part_of_list(team, starts, p):
    """First and last + 1 of a thread's share of the list of a partner."""
    first, last = share(starts[p + 1] - starts[p], team.thread, team.threads)
    return starts[p] + first, starts[p] + last


@scalar
def first_row(team, shared, p):
    """Where the rows of a thread begin."""
    row = shared.out_at[p] + HEADER + 1
    for t in range(team.thread):
        row += shared.counting[t, p]
    return row


@scalar
def write_rows(team, fluid, beads, p, physics):
    """Rows for a partner; the sums of these cells are cleared."""
    cells, shared, t = fluid.cells, fluid.cells.shared, team.thread
    row = first_row(team, shared, p)
    if row + shared.counting[t, p] > shared.out_at[p + 1]:
        shared.noted[FAULTS] |= FULL
        shared.counting[t, p] = 0
        return
    width = sums_length(len(physics.terms))
    first, last = part_of_list(team, shared.starts, p)
    for j in range(first, last):
        start, found = np.uint64(shared.mine[j]) * np.uint64(width), np.int64(0)
        for u in range(cells.sums.shape[0]):
            found |= cells.sums[u, start]
        if found != 0:
            shared.asked[row], shared.sums_out[row, 0] = shared.mine[j], shared.theirs[j]
            for k in range(width):
                at, total = start + np.uint64(k), np.int64(0)
                for u in range(cells.sums.shape[0]):
                    total += cells.sums[u, at]
                    cells.sums[u, at] = 0
                shared.sums_out[row, 1 + k] = total
            row += 1
    slot = cells.number + 1 + t * shared.guest_place.shape[1]
    for n in range(shared.guests[t, 0]):
        if shared.guest_owner[t, n] == p:
            fluid.particles.cell[shared.guest_place[t, n]] = slot + n
            shared.asked[row], shared.sums_out[row, 0] = slot + n, shared.guest_cell[t, n]
            for k in range(width):
                shared.sums_out[row, 1 + k] = shared.guest_terms[t, n, k]
            row += 1
    for j in range(beads_that_ask(team, beads, p)):  # they add what is said elsewhere
        shared.asked[row], shared.sums_out[row, 0] = bead_row(beads, p, j)
        for k in range(width):
            shared.sums_out[row, 1 + k] = 0
        row += 1


@scalar
def send_sums(team, shared, beads):
    """Send all rows, and wait for those of the others."""
    n = receive_rows(shared, send_terms(beads, shared, 0), shared.sums_in, shared.in_at, SUMS)
    for p in range(len(shared.ranks)):
        first, rows = shared.out_at[p], 0
        for t in range(team.threads):
            rows += shared.counting[t, p]
        shared.sent[p] = rows
        shared.sums_out[first + HEADER, 0] = rows
        n = send_rows(shared, n, shared.sums_out, first, 1 + rows, p, SUMS, SUM_WORDS)
    for t in range(team.threads):
        shared.meter[GUESTS] = max(shared.meter[GUESTS], shared.guests[t, 0])
        shared.guests[t, 0] = 0
    finish(shared.post, n)


@scalar
def rows_in(shared, p):
    """How many rows a partner has sent."""
    return shared.sums_in[shared.in_at[p] + HEADER, 0]


@scalar
def add_rows(team, cells, p, physics):
    """Add what a partner's particles found in cells of this rank."""
    shared, sums = cells.shared, cells.sums[team.thread]
    width = sums_length(len(physics.terms))
    first, last = share(rows_in(shared, p), team.thread, team.threads)
    for row in range(shared.in_at[p] + HEADER + 1 + first, shared.in_at[p] + HEADER + 1 + last):
        start = np.uint64(shared.sums_in[row, 0]) * np.uint64(width)
        for k in range(width):
            sums[start + np.uint64(k)] += shared.sums_in[row, 1 + k]


@by_type
def answer_others(team, now, physics, fluid, beads, walls):
    """What others asked for, first: it is on its way while this rank's own cells collide."""
    if not shares(fluid):
        return lambda team, now, physics, fluid, beads, walls: None
    return lambda team, now, physics, fluid, beads, walls: _answer(
        team, now, physics, fluid, beads, walls
    )


@stage
def _answer(team, now, physics, fluid, beads, walls):
    shared = fluid.cells.shared
    if len(beads) > 0:
        meet(team)  # answers for cells with beads are there
    for p in range(len(shared.ranks)):
        rows = rows_in(shared, p)
        first, last = share((rows + LANES - 1) // LANES, team.thread, team.threads)
        for b in range(first, last):
            start = shared.in_at[p] + HEADER + 1 + b * LANES
            count = min(LANES, rows - b * LANES)
            answer_batch(team, now, physics, fluid, beads, start, count)
    meet(team)
    if team.thread == 0:
        send_answers(now, physics, shared, walls)
    lap(team, SHARE)


@scalar
def answer_batch(team, now, physics, fluid, beads, start, count):
    """Answers to some rows: of whole cells, which keep their sums."""
    cells, scratch, none = fluid.cells, fluid.scratch, nothing_found(physics.terms)
    totals, out = scratch.terms[team.thread], scratch.coefficients[team.thread]
    rows, answers = cells.shared.sums_in, cells.shared.answers_out
    for i in range(LANES):
        store_scratch(totals, i, none)
    for i in range(count):
        found = sums_of_cell(cells.sums, rows[start + i, 0], physics.terms)
        store_scratch(totals, i, found)
    settle_batch(team, now.counter, physics, fluid, Asked(rows, start, count), count)
    for i in range(count):
        answer = load_scratch(out, i, physics.coefficients)
        write_row(answers, start + i, joint_answer(beads, rows[start + i, 0], answer))


@scalar
def send_answers(now, physics, shared, walls):
    """Begin to send answers, what was seen of the flow after them, and to receive those of others.

    Messages in hand are counted on from 0: `take_answers` waits for them.
    """
    n = receive_rows(shared, 0, shared.answers_in, shared.out_at, ANSWERS)
    for p in range(len(shared.ranks)):
        first, rows = shared.in_at[p], rows_in(shared, p)
        seen = write_seen(walls, now, physics, shared, p, first + HEADER + 1 + rows)
        shared.answers_out[first + HEADER, 0] = float(seen)
        number = 1 + rows + seen
        n = send_rows(shared, n, shared.answers_out, first, number, p, ANSWERS, ANSWER_WORDS)


@by_type
def take_answers(team, now, physics, fluid, walls):
    """What particles here need of the cells of others."""
    if not shares(fluid):
        return lambda team, now, physics, fluid, walls: None
    return lambda team, now, physics, fluid, walls: _take(team, now, physics, fluid, walls)


@stage
def _take(team, now, physics, fluid, walls):
    shared = fluid.cells.shared
    partners = len(shared.ranks)
    meet(team)
    lap(team, CELLS)
    if team.thread == 0:
        finish(shared.post, 2 * partners)
    meet(team)
    lap(team, WAIT)
    for p in range(partners):
        put_answers(team, fluid.cells, p, physics.coefficients)
    if team.thread == 0:
        take_seen(walls, now, physics, shared)
    meet(team)
    lap(team, SHARE)


@scalar
def put_answers(team, cells, p, needed):
    """Answers of a partner become records of its cells."""
    shared, length = cells.shared, np.uint64(record_length(len(needed)))
    first, last = share(shared.sent[p], team.thread, team.threads)
    begin = shared.out_at[p] + HEADER + 1
    for row in range(begin + first, begin + last):
        start = np.uint64(shared.asked[row]) * length
        store_values(cells.coefficients, start, load_row(shared.answers_in, row, needed))
