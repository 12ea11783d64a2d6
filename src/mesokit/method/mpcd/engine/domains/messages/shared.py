"""The memory with which a rank shares cells with its partners, as compiled code takes it."""

from typing import Any, NamedTuple

import numpy as np

from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.domains.messages.mpi import Post, receive, send
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import scalar

# Places in `Shared.noted`: molecules held, steps done by the last call, faults, particles that
# arrived in the last migration.
MOLECULES, DONE, FAULTS, ARRIVED = 0, 1, 2, 3
# Faults: more ghosts than there is room for; a cell of no partner; a bead that moved too far.
FULL, FAR, STRETCHED = 1, 2, 4
# Places in `Shared.meter`, numbers since the run began: messages, words and rows sent for sums,
# coefficients, particles and fields, most ghosts of a thread at once, molecules moved,
# words for beads.
MESSAGES, SUM_WORDS, RECORD_WORDS, MOVED_WORDS, FIELD_WORDS, GHOSTS, MOVED, BEAD_WORDS = range(8)
METER_SIZE = 8
HEADER = 0  # the first row of a message: how many rows follow


class Shared(NamedTuple):
    """The halo of cells around a block, and the messages about it; q partners, T threads.

    Cells of the block and of its halo are numbered from 0 ("held cells"). Rows of sums of halo
    cells go to the owners, which return the coefficients of the collision. Ghosts are particles
    beyond the halo: their rows go to the owners of their cells, their coefficients return to
    records behind all held cells.

    keys (held + LANES,): number in the whole box of each held cell. mixed (batches,): whether a
    batch has any own cell.
    blocks (q, 2, d): of partners; regions (q, 2, d): first of the cells that they hold, and their
    number. cells (d,): of the box. ranks (q,): of the partners.
    starts (q + 1,), mine, theirs: halo cells of each partner, by their numbers here and there;
    given_starts (q + 1,), given: own cells in the halo of each partner, in its order.
    out_at, in_at (q + 1,): first rows of each partner; sums_out, sums_in (rows, 1 + width);
    coefficients_out, coefficients_in (rows, length); records (rows,): held cell, or record behind
    these, of each row that was sent.
    counting (T, q): rows of each thread; sent (q,): of all threads.
    field_out, field_in: sums of cells at the borders for gradients, in the order of `given` and of
    `mine`.
    ghost_place, ghost_cell, ghost_owner (T, ghosts), ghost_terms (T, ghosts, width), ghosts (T, 8).
    leaving, owner (T, most), left (T, 8): molecules that migrate, and their new owners; moved_at
    (q + 1,), moved_out, moved_in (rows, record): first rows of each partner, and the rows.
    every: steps from one migration to the next; slots: records of the ghosts of all threads;
    room: molecules that the arrays hold.
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
    coefficients_out: Any
    coefficients_in: Any
    records: Any
    counting: Any
    sent: Any
    field_out: Any
    field_in: Any
    ghost_place: Any
    ghost_cell: Any
    ghost_owner: Any
    ghost_terms: Any
    ghosts: Any
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
    """Whether ranks share the fluid, from the numba type of `Fluid`."""
    return len(field_of(field_of(fluid, "cells"), "shared")) > 0


@scalar
def address_of(rows, first):
    """Address of a row of an array of 64-bit numbers, which lies in one piece."""
    return np.uint64(rows.ctypes.data) + np.uint64(first * rows.strides[0])


@scalar
def receive_rows(shared, n, rows, starts, tag):
    """Begin to receive rows of all partners, each into its part; returns the number of messages."""
    words = rows.shape[1]
    for p in range(len(shared.ranks)):
        most = (starts[p + 1] - starts[p]) * words
        n = receive(shared.post, n, address_of(rows, starts[p]), most, shared.ranks[p], tag)
    return n


@scalar
def send_rows(shared, n, rows, first, number, p, tag, kind):
    """Begin to send `number` rows, the header first, to a partner; returns the number of messages.

    `kind` is the place in `Shared.meter` that counts the words.
    """
    words = number * rows.shape[1]
    n = send(shared.post, n, address_of(rows, first), words, shared.ranks[p], tag)
    shared.meter[MESSAGES] += 1
    shared.meter[kind] += words
    return n


@where("True", shared=len)
def any_own(shared, batch):
    """Whether a batch of cells has any own cell."""
    return shared.mixed[batch]


@where("cell", shared=len)
def key_of(shared, cell):
    """The number of a held cell in the whole box."""
    return shared.keys[cell]
