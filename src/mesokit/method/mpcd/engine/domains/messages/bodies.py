"""Messages about bodies: the sums of all ranks over the hits and the gas of each body.

All ranks have all bodies, and move them alike. A rank sends the sums of the bodies that it has
particles near to every other rank. Sums are whole numbers, so each rank finds the same total in
whatever order they come, and solves for the same change.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.loops.layout import zeros
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.cpu.grid import cell_in_box, in_block
from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.domains.messages.mpi import Post, finish, post, receive, send
from mesokit.method.mpcd.engine.domains.messages.shared import address_of
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import scalar

BODY_SUMS = 40  # tag of messages
ROWS, FOUND = 0, 1  # of the first row of a message: how many follow, and how many hits there were


class BodyMessages(NamedTuple):
    """Memory for messages to the q other ranks.

    ranks (q,): of these; rows_out (1 + bodies, width), rows_in (q, 1 + bodies, width): a header,
    and a row for each body: its number and its sums. hits (1,): those of other ranks in this round.
    first: whether this is the first rank, which counts for all what all ranks do alike.
    """

    post: Post
    ranks: Any
    rows_out: Any
    rows_in: Any
    hits: Any
    first: bool


def body_messages(comm: Any, bodies: int, width: int, crowded: bool) -> BodyMessages:
    """Memory for the ranks of a communicator."""
    others = [rank for rank in range(comm.size) if rank != comm.rank]
    q = len(others)
    return BodyMessages(
        post=post(comm, 2 * q, crowded),
        ranks=np.array(others, np.int64),
        rows_out=zeros((1 + bodies, 1 + width), np.int64),
        rows_in=zeros((q, 1 + bodies, 1 + width), np.int64),
        hits=np.zeros(1, np.int64),
        first=comm.rank == 0,
    )


def on_ranks(bodies: Any) -> bool:
    """Whether ranks share bodies, from the numba type of `MovingBodies`."""
    return len(field_of(bodies, "messages")) > 0


@where("0", bodies=on_ranks)
def hits_elsewhere(bodies):
    """Hits on other ranks in this round."""
    return bodies.messages.hits[0]


@where("True", bodies=on_ranks)
def counts_for_all(bodies):
    """Whether this rank counts what all ranks do alike."""
    return bodies.messages.first


@where(bodies=on_ranks)
def add_others(worker, bodies, sums, found):
    """Add the sums (threads, bodies, ...) of all other ranks to those of the first thread here.

    `found` is the number of hits of this rank. All threads have met before, and meet after it.
    """
    if worker.thread == 0:
        exchange_sums_of_bodies(worker, bodies.messages, sums, found)
    barrier(worker)


@scalar
def exchange_sums_of_bodies(worker, messages, sums, found):
    """Send the rows of bodies with any sum, and add those that arrive."""
    out, width, rows = messages.rows_out, sums.shape[2], np.int64(0)
    for i in range(sums.shape[1]):
        row, any_sum = out[1 + rows], np.int64(0)
        row[0] = i
        for k in range(width):
            total = np.int64(0)
            for t in range(worker.threads):
                total += sums[t, i, k]
            row[1 + k] = total
            any_sum |= total
        if any_sum != 0:
            rows += 1
    out[0, ROWS], out[0, FOUND] = rows, found
    sent, length = 0, out.shape[1]
    for p in range(len(messages.ranks)):
        place = address_of(messages.rows_in[p], 0)
        most = messages.rows_in.shape[1] * length
        sent = receive(messages.post, sent, place, most, messages.ranks[p], BODY_SUMS)
    for p in range(len(messages.ranks)):
        words = (1 + rows) * length
        sent = send(messages.post, sent, address_of(out, 0), words, messages.ranks[p], BODY_SUMS)
    finish(messages.post, sent)
    messages.hits[0] = 0
    for p in range(len(messages.ranks)):
        messages.hits[0] += messages.rows_in[p, 0, FOUND]
        for n in range(messages.rows_in[p, 0, ROWS]):
            row = messages.rows_in[p, 1 + n]
            for k in range(width):
                sums[0, row[0], k] += row[1 + k]


@where("True", shared=len)
def is_own_cell(shared, grid, r):
    """Whether the cell at a place is in the block of this rank."""
    return in_block(shared.limits, cell_in_box(r, grid))
