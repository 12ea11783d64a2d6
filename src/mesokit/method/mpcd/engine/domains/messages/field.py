"""Sums of cells at the borders, for rules that need the gradient of a sum."""

import numpy as np

from mesokit.kernels.part import stage
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.domains.messages.mpi import finish, receive, send
from mesokit.method.mpcd.engine.domains.messages.shared import FIELD_WORDS, MESSAGES, shares
from mesokit.scalar.jit import by_type

FIELDS = 3  # tag of messages


@by_type
def share_field(worker, fluid):
    """Exchange the sums of cells at the borders, which gradients in neighbouring cells need."""
    if not shares(fluid):
        return lambda worker, fluid: None
    return lambda worker, fluid: _share_field(worker, fluid)


@stage
def _share_field(worker, fluid):
    barrier(worker)
    if worker.thread == 0:
        shared, values = fluid.cells.shared, fluid.cells.field.values
        post, n = shared.post, 0
        for j in range(len(shared.given)):
            shared.field_out[j] = values[shared.given[j]]
        for p in range(len(shared.ranks)):
            first, last = shared.starts[p], shared.starts[p + 1]
            at = np.uint64(shared.field_in.ctypes.data) + np.uint64(8 * first)
            n = receive(post, n, at, last - first, shared.ranks[p], FIELDS)
        for p in range(len(shared.ranks)):
            first, last = shared.given_starts[p], shared.given_starts[p + 1]
            at = np.uint64(shared.field_out.ctypes.data) + np.uint64(8 * first)
            n = send(post, n, at, last - first, shared.ranks[p], FIELDS)
            shared.meter[MESSAGES] += 1
            shared.meter[FIELD_WORDS] += last - first
        finish(post, n)
        for j in range(len(shared.mine)):
            values[shared.mine[j]] = shared.field_in[j]
    barrier(worker)
