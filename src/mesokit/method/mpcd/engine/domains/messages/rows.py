"""Messages of rows: each partner has a part of an array, which begins with a header."""

import numpy as np

from mesokit.method.mpcd.engine.domains.messages.mpi import receive, send
from mesokit.method.mpcd.engine.domains.messages.shared import MESSAGES
from mesokit.scalar.jit import scalar


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


@scalar
def address_of(rows, first):
    """Address of a row of 64-bit numbers."""
    return np.uint64(rows.ctypes.data) + np.uint64(8 * first * rows.shape[1])
