"""What ranks tell one another of the flow near surfaces (see `virtual.gradient`).

Only the rank whose cell a probe is in knows all of its particles; all ranks that have cells at that
piece of surface hear of it, and take it into their means in the same way.
"""

import numpy as np

from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.domains.messages.shared import FAULTS, FULL, HEADER
from mesokit.method.mpcd.engine.virtual.gradient import PROBES, remember, straighten
from mesokit.scalar.jit import by_type, elementwise, for_each


@elementwise
def seen_at(values, e, p, like):
    """What was seen at a probe, as a tuple as long as `like`."""
    return "values[e, p, {k}]"


@for_each
def put_seen(values, e, p, given):
    """Write down what was seen."""
    return "values[e, p, {k}] = given[{k}]"


@by_type
def write_seen(walls, now, physics, shared, partner, row):
    """Rows for a partner of what was seen at this step of the pieces that it keeps: how many."""
    if len(field_of(walls, "gradient")) == 0:
        return lambda walls, now, physics, shared, partner, row: 0
    return _write


def _write(walls, now, physics, shared, partner, row):
    seen, rows, first = walls.virtual.seen, shared.answers_out, row
    like = physics.zero + (0.0,)
    for j in range(seen.given_starts[partner], seen.given_starts[partner + 1]):
        e = seen.given[j]
        for p in range(PROBES):
            if seen.step[e, p] == np.int64(now.counter.step):
                values = seen_at(seen.values, e, p, like)
                if row == shared.in_at[partner + 1]:
                    shared.noted[FAULTS] |= FULL
                    return row - first
                rows[row, 0], rows[row, 1] = float(e), float(p)
                for k in range(len(values)):
                    rows[row, 2 + k] = values[k]
                row += 1
    return row - first


@by_type
def take_seen(walls, now, physics, shared):
    """All that was seen at this step goes into the means."""
    if len(field_of(walls, "gradient")) == 0:
        return lambda walls, now, physics, shared: None
    return _take


def _take(walls, now, physics, shared):
    seen, virtual, rows = walls.virtual.seen, walls.virtual, shared.answers_in
    d = len(physics.zero)
    for partner in range(len(shared.ranks)):
        first = shared.out_at[partner]
        asked = shared.sent[partner]
        begin = first + HEADER + 1 + asked
        for row in range(begin, begin + int(rows[first + HEADER, 0])):
            e, p = int(rows[row, 0]), int(rows[row, 1])
            seen.step[e, p] = np.int64(now.counter.step)
            for k in range(d + 1):
                seen.values[e, p, k] = rows[row, 2 + k]
    for j in range(len(seen.here)):
        e, new = seen.here[j], False
        for p in range(PROBES):
            if seen.step[e, p] == np.int64(now.counter.step):
                values = seen_at(seen.values, e, p, physics.zero + (0.0,))
                remember(virtual.rates, e, p, values, physics.zero)
                new = True
        if new:
            straighten(virtual.rates, e, physics.zero)
