"""The rate of all events in the first state, in plain Python: no kernel has to be compiled."""

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.lattice.patch import MISSING, Patch, neighbours_of

MOST = 2**16  # sites: of more it would take a part of a second


def first_rate(case: Case) -> float | None:
    """Rate of all that may happen in the first state; None of a large lattice, and of a model whose
    moves cannot be listed."""
    if int(np.prod(case.box.size)) > MOST:
        return None
    return rate_of_all(case, case.lattice.first().states(case))


def rate_of_all(case: Case, numbers: NDArray[np.integer]) -> float | None:
    """The same in any states (n,), by number."""
    kind, size = case.lattice.lattice, tuple(map(int, case.box.size))
    moves, states = case.lattice.model.list_moves(kind), numbers.astype(np.int64)
    if moves is None or moves.reach > 1:
        return None
    closed = tuple(axis in case.lattice.ends for axis in case.box.axes)
    near = neighbours_of(kind, size, closed, np.arange(len(states)))
    # of sites with the same states around them one is enough
    z, missing = kind.neighbours, near == MISSING
    rows = np.column_stack([states, np.where(missing, 0, states[near]), missing])
    # rows are told apart by random sums, which are alike of different rows once in 2^64 pairs
    words = np.random.default_rng(1).integers(2**63, size=rows.shape[1])
    _, first, number = np.unique(rows @ words, return_index=True, return_counts=True)
    total = 0.0
    for row, times in zip(rows[first].tolist(), number.tolist(), strict=True):
        around = tuple(MISSING if row[1 + z + k] else 1 + k for k in range(z))
        star = Patch(tuple(row[: z + 1]), (around, *(() for _ in range(z))))
        total += times * sum(one.rate for one in moves.at(star, 0))
    return total
