"""Sums of forces and torques in whole quanta: they have no order."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.method.spheres.soft.engine.contact.remembered import ROLLING
from mesokit.method.spheres.soft.engine.groups import Lists
from mesokit.scalar.jit import scalar

Array = NDArray[np.float64]
Pairs = NDArray[np.int64]


def pairs_of(lists: Lists, number: Pairs) -> tuple[Pairs, Array]:
    """Pairs of numbers (m, 2), the smaller one first and in order, that have something to remember,
    and what (m, width), as the first of the two sees it."""
    pairs, signs = _own(lists, number)
    springs = lists.springs[: len(pairs)] * signs
    kept = (springs != 0).any(axis=1)
    pairs, which = np.unique(pairs[kept], axis=0, return_index=True)
    return pairs, springs[kept][which]


def remember(lists: Lists, number: Pairs, pairs: Pairs, springs: Array) -> None:
    """Bring back what they remember."""
    own, signs = _own(lists, number)
    keys, wanted = (each[:, 0] * len(number) + each[:, 1] for each in (pairs, own))
    at = np.searchsorted(keys, wanted)
    found = keys.take(at, mode="clip") == wanted if len(keys) else np.zeros(len(own), bool)
    lists.springs[: len(own)][found] = springs[at[found]] * signs[found]


def _own(lists: Lists, number: Pairs) -> tuple[Pairs, Any]:
    """Of all contacts in the order of memory, the pairs, the smaller number first, and by what the
    first's view is to be multiplied (m, width)."""
    one = np.repeat(np.arange(len(number)), lists.own)
    other = lists.near[one, np.arange(len(one)) - lists.begin[one]]
    both = np.stack([number[one], number[other]], axis=1)
    signs = np.ones((len(one), lists.springs.shape[1]))
    signs[both[:, 0] > both[:, 1], :ROLLING] = -1.0
    return np.sort(both, axis=1), signs


@scalar
def counted(vector, scale):
    """A vector in whole quanta: cut off toward zero, so that what the other sphere has is exactly
    minus this."""
    return (np.int64(vector[0] * scale), np.int64(vector[1] * scale), np.int64(vector[2] * scale))


@scalar
def add(sums, i, counts):
    """Add quanta to those of sphere i."""
    sums[i, 0] += counts[0]
    sums[i, 1] += counts[1]
    sums[i, 2] += counts[2]


@scalar
def subtract(sums, i, counts):
    """Subtract quanta from those of sphere i."""
    sums[i, 0] -= counts[0]
    sums[i, 1] -= counts[1]
    sums[i, 2] -= counts[2]


@scalar
def opposite(vector):
    """Minus a vector."""
    return -vector[0], -vector[1], -vector[2]


@scalar
def abs_sum(vector):
    """A bound of the numbers of a vector; infinite where one is none."""
    found = abs(vector[0]) + abs(vector[1]) + abs(vector[2])
    return found if found >= 0.0 else np.inf
