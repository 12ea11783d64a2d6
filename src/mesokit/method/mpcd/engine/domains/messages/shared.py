"""What a rank keeps in order to share cells with others, as compiled code takes it."""

from typing import Any, NamedTuple

from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.domains.messages.mpi import Post
from mesokit.scalar.jit import by_type

# Places in `Shared.noted`: molecules held, steps done by the last call, faults, newcomers in hand.
MOLECULES, DONE, FAULTS, ARRIVED = 0, 1, 2, 3
# Faults: more guests than there is room for; a cell of nobody in reach; a bead that went too far.
FULL, FAR, STRETCHED = 1, 2, 4
# Places in `Shared.meter`, numbers since the run began: messages, words and rows sent for sums,
# answers, particles and fields, most guests of a thread at once, molecules moved,
# words for beads.
MESSAGES, SUM_WORDS, ANSWER_WORDS, MOVED_WORDS, FIELD_WORDS, GUESTS, MOVED, BEAD_WORDS = range(8)
METER_SIZE = 8
HEADER = 0  # the row in front of a message: how many follow


class Shared(NamedTuple):
    """The cells around a block and the messages about them; q partners, T threads.

    A cell of another rank is known by a number of its own here. Rows of sums go to the rank whose
    cell it is, which answers with what particles need in order to collide. Guests are particles in
    cells that are not known: their rows go to whoever has the cell, their answers into a slot
    behind all known cells.

    keys (known + LANES,): number in the whole box of each known cell. mixed (batches,): whether any
    cell of a batch is this rank's own.
    blocks (q, 2, d): of partners; regions (q, 2, d): first and
    number of the cells that they know. cells (d,): of the box.
    ranks (q,): their numbers.
    starts (q + 1,), mine, theirs: cells of each partner that are known here, their numbers here and
    there; given_starts (q + 1,), given: own cells that each partner knows, in its order.
    out_at, in_at (q + 1,): where the rows of each partner begin; sums_out, sums_in (rows, 1 +
    width); answers_out, answers_in (rows, answer); asked (rows,): which cell a row is of.
    counting (T, q): rows of each thread; sent (q,): of all.
    field_out, field_in: numbers of cells whose neighbours are asked for, in the order of `given`
    and of `mine`.
    guest_place, guest_cell, guest_owner (T, guests), guest_terms (T, guests, width), guests (T, 8).
    leaving, owner (T, most), left (T, 8): molecules that go to others, and to whom; moved_at
    (q + 1,), moved_out, moved_in (rows, record): where those of each partner begin, and their
    numbers.
    every: steps from one move to the next; slots: guests of all threads; room: molecules that the
    arrays hold.
    """

    post: Post
    keys: Any
    mixed: Any
    cells: Any
    limits: tuple
    closed: tuple
    ranks: Any
    blocks: Any
    regions: Any
    starts: Any
    mine: Any
    theirs: Any
    given_starts: Any
    given: Any
    out_at: Any
    in_at: Any
    sums_out: Any
    sums_in: Any
    answers_out: Any
    answers_in: Any
    asked: Any
    counting: Any
    sent: Any
    field_out: Any
    field_in: Any
    guest_place: Any
    guest_cell: Any
    guest_owner: Any
    guest_terms: Any
    guests: Any
    leaving: Any
    owner: Any
    left: Any
    moved_at: Any
    moved_out: Any
    moved_in: Any
    noted: Any
    meter: Any
    every: int
    slots: int
    room: int


def shares(fluid: Any) -> bool:
    """Whether a fluid is that of one rank of several, from the numba type of `Fluid`."""
    return len(field_of(field_of(fluid, "cells"), "shared")) > 0


@by_type
def any_own(shared, batch):
    """Whether a batch of cells has one that is this rank's own."""
    if len(shared) == 0:
        return lambda shared, batch: True
    return lambda shared, batch: shared.mixed[batch]


@by_type
def key_of(shared, cell):
    """The number in the whole box of a known cell."""
    if len(shared) == 0:
        return lambda shared, cell: cell
    return lambda shared, cell: shared.keys[cell]
