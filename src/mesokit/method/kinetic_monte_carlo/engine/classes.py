"""Choice by classes: sites of one class have one rate (Bortz, Kalos and Lebowitz 1975).

A class is a byte for each site. How many sites of each class there are is known for each tile, for
16 tiles, for 16 times as many, and so on: all of them integers, which never drift. A class is drawn
by its total rate, then one of its sites, from the top of that tree down to the tile, whose bytes
are compared 64 at a time.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.engine.bytes import bits_set, equal_bytes, lowest_bit
from mesokit.method.kinetic_monte_carlo.lattice.grid import TILE
from mesokit.scalar.jit import scalar

IDLE = 255  # the byte of sites where nothing can happen, and of no site
FAN = 16  # tiles, or nodes of the tree, below a node
_ONE = np.uint64(1)


class Classes(NamedTuple):
    """Sites by class.

    of: (memory,) class of each site, IDLE if nothing can happen there. by_surroundings: (m,) class
    of sites with these. rates: (classes,) of each site of a class. numbers: (classes,) of sites.
    tree: counts of each class in each node, level by level, 16 nodes side by side; levels: where
    each begins.
    """

    of: NDArray[np.uint8]
    by_surroundings: NDArray[np.uint8]
    rates: NDArray[np.float64]
    numbers: NDArray[np.int64]
    tree: NDArray[np.int32]
    levels: NDArray[np.int64]


def classes_of(rates: NDArray[np.float64], memory: int) -> Classes:
    """An empty choice, by the rates (m,) of sites by their surroundings, for so many places."""
    distinct = np.unique(rates[rates > 0])[::-1]  # the fastest first: most events are of these
    number = max(len(distinct), 1)
    if number > IDLE:
        raise ValueError(f"{number} different rates; expected at most {IDLE}")
    found = len(distinct) - np.searchsorted(distinct[::-1], rates, side="right")
    levels, nodes = [0], memory // TILE
    while True:
        nodes = -(-nodes // FAN)
        levels.append(levels[-1] + nodes * number * FAN)
        if nodes == 1:
            break
    return Classes(
        np.full(memory, IDLE, np.uint8),
        np.where(rates > 0, found, IDLE).astype(np.uint8),
        np.append(distinct, np.zeros(number - len(distinct))),
        np.zeros(number, np.int64),
        np.zeros(levels[-1], np.int32),
        np.array(levels[:-1]),
    )


@scalar
def put_class(classes, i, new):
    """Set the class of the site at a place in memory."""
    old = np.int64(classes.of[i])
    if new != old:
        classes.of[i] = new
        node, width = i >> 8, len(classes.rates)
        for level in range(len(classes.levels)):
            base = classes.levels[level] + (((node >> 4) * width) << 4) + (node & 15)
            if old < width:
                classes.tree[base + (old << 4)] -= 1
            if new < width:
                classes.tree[base + (new << 4)] += 1
            node >>= 4
        if old < width:
            classes.numbers[old] -= 1
        if new < width:
            classes.numbers[new] += 1


@scalar
def total_rate(classes):
    """Rate of all events."""
    total = 0.0
    for c in range(len(classes.rates)):
        total += classes.numbers[c] * classes.rates[c]
    return total


@scalar
def choose(classes, total, u):
    """The place in memory of a site, drawn by its rate, and what is left of u."""
    left, c, last = u * total, 0, 0
    for k in range(len(classes.rates)):
        rate = classes.numbers[k] * classes.rates[k]
        if rate > 0.0:
            last = k
            if left < rate:
                break
            left -= rate
    c = last
    number = classes.numbers[c]
    left = left / classes.rates[c]
    rank = min(np.int64(left), number - 1)
    return _nth(classes, c, rank), min(left - rank, 1.0 - 2.0**-53)


@scalar
def _nth(classes, c, rank):
    """Where the site with this rank among those of its class is in memory."""
    node, width = 0, len(classes.rates)
    for back in range(len(classes.levels)):
        base = classes.levels[len(classes.levels) - 1 - back] + ((node * width + c) << 4)
        # without a branch: which of the 16 is as good as random
        up_to, before, below = 0, 0, 0
        for k in range(FAN):
            up_to += classes.tree[base + k]
            passed = up_to <= rank
            below += 1 if passed else 0
            before = up_to if passed else before
        node, rank = (node << 4) | below, rank - before
    i = node << 8
    address = np.uint64(classes.of.ctypes.data)
    found = equal_bytes(address + np.uint64(i), np.uint64(c))
    number = np.int64(bits_set(found))
    while rank >= number:
        rank, i = rank - number, i + 64
        found = equal_bytes(address + np.uint64(i), np.uint64(c))
        number = np.int64(bits_set(found))
    for _ in range(rank):
        found &= found - _ONE
    return i + np.int64(lowest_bit(found))
