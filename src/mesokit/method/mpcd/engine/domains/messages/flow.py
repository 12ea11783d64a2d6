"""Messages about the flow near surfaces (see `virtual.gradient`).

Only the owner of the cell of a probe has the sums of all its particles. It sends the velocity to
all ranks with that piece of surface, and all update their running means in the same way.
"""

import numpy as np

from mesokit.method.mpcd.engine.domains.messages.shared import FAULTS, FULL, HEADER
from mesokit.method.mpcd.engine.virtual.gradient import PROBES, average_probe, straighten
from mesokit.method.mpcd.engine.virtual.particles import has_gradient
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import elementwise


@elementwise
def seen_at(values, e, p, pattern):
    """The values of a probe, as a tuple as long as `pattern`."""
    return "values[e, p, {k}]"


@where("0", walls=has_gradient)
def write_seen(walls, now, physics, shared, partner, row):
    """Write rows of this step's probes at pieces that a partner keeps; returns their number."""
    seen, rows, first = walls.virtual.seen, shared.coefficients_out, row
    pattern = physics.zero + (0.0,)
    # Rows are in the order of pieces and probes, behind the coefficients. Only probes of this step
    # count: an older value was sent before.
    for j in range(seen.given_starts[partner], seen.given_starts[partner + 1]):
        e = seen.given[j]
        for p in range(PROBES):
            if seen.step[e, p] == np.int64(now.counter.step):
                values = seen_at(seen.values, e, p, pattern)
                if row == shared.in_at[partner + 1]:
                    shared.noted[FAULTS] |= FULL
                    return row - first
                rows[row, 0], rows[row, 1] = float(e), float(p)
                for k in range(len(values)):
                    rows[row, 2 + k] = values[k]
                row += 1
    return row - first


@where(walls=has_gradient)
def take_seen(walls, now, physics, shared):
    """Update the running means by the probes of this step, own and received."""
    seen, virtual, rows = walls.virtual.seen, walls.virtual, shared.coefficients_in
    d = len(physics.zero)
    # Each probe has one owner, so rows of several partners never meet in one place.
    for partner in range(len(shared.ranks)):
        first = shared.out_at[partner]
        begin = first + HEADER + 1 + shared.sent[partner]
        for row in range(begin, begin + int(rows[first + HEADER, 0])):
            e, p = int(rows[row, 0]), int(rows[row, 1])
            seen.step[e, p] = np.int64(now.counter.step)
            for k in range(d + 1):
                seen.values[e, p, k] = rows[row, 2 + k]
    # The means are updated only when all probes are here, piece by piece. Every rank with a piece
    # does the same operations on the same numbers.
    for j in range(len(seen.here)):
        e, new = seen.here[j], False
        for p in range(PROBES):
            if seen.step[e, p] == np.int64(now.counter.step):
                values = seen_at(seen.values, e, p, physics.zero + (0.0,))
                average_probe(virtual.rates, e, p, values, physics.zero)
                new = True
        if new:
            straighten(virtual.rates, e, physics.zero)
