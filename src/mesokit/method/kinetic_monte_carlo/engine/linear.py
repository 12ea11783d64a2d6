"""Choice by a walk over all sites, until their rates make up the number that was drawn (Gillespie
1976). Its cost grows with the lattice: it is here to be read, and to be compared with.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.engine.choice import choose, put, total_rate


class Linear(NamedTuple):
    """Rates (n,) of all sites or bonds by place, and (m,) by surroundings."""

    of: NDArray[np.float64]
    rates: NDArray[np.float64]


@put.register(Linear)
def _(choice, part, i, around):
    choice.of[i] = choice.rates[around]


@total_rate.register(Linear)
def _(choice, part):
    total = 0.0
    for i in range(len(choice.of)):
        total += choice.of[i]
    return total


@choose.register(Linear)
def _(choice, sites, part, total, u, word):
    left, last, part_of = u * total, 0, 0.0
    for i in range(len(choice.of)):
        if choice.of[i] > 0.0:
            last, part_of = i, left / choice.of[i]
            if left < choice.of[i]:
                break
            left -= choice.of[i]
    return last, min(part_of, 1.0 - 2.0**-53)
