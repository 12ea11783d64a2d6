"""Choice by a tree of sums: each node has the rate of the two below it (Blue, Beichl and Sullivan
1995). Any rates will do; a change costs as many sums as the tree has levels.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.engine.choice import choose, put, total_rate

U = np.uint64


class Tree(NamedTuple):
    """Rates of all sites or bonds as the leaves of a tree.

    leaves: how many, a power of two. sums: (2 * leaves,) of node k those of nodes 2 k and 2 k + 1;
    node 1 is the root. rates: (m,) by surroundings.
    """

    leaves: int
    sums: NDArray[np.float64]
    rates: NDArray[np.float64]


def tree_of(rates: NDArray[np.float64], memory: int) -> Tree:
    """A tree without rates, by those of surroundings, for so many places."""
    leaves = 1 << (memory - 1).bit_length()
    return Tree(leaves, np.zeros(2 * leaves), rates)


@put.register(Tree)
def _(choice, part, i, around):
    k = i + choice.leaves
    choice.sums[U(k)] = choice.rates[U(around)]
    # each sum is made anew, not changed by a difference: it never drifts
    while k > 1:
        k >>= 1
        choice.sums[U(k)] = choice.sums[U(2 * k)] + choice.sums[U(2 * k + 1)]


@total_rate.register(Tree)
def _(choice, part):
    return choice.sums[U(1)]


@choose.register(Tree)
def _(choice, sites, part, total, u, word):
    k, left, rate = 1, u * total, total
    while k < choice.leaves:
        k, low = 2 * k, choice.sums[U(2 * k)]
        high = choice.sums[U(k + 1)]
        # by rounding the rest may be more than there is: then it is that of the other branch
        right = (left >= low and high > 0.0) or low == 0.0
        left = min(max(left - low, 0.0), high) if right else min(left, low)
        rate = high if right else low
        k += 1 if right else 0
    return k - choice.leaves, min(left / rate, 1.0 - 2.0**-53)
