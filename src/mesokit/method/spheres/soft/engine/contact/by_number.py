"""The springs of contacts between spheres, by the ids of the two, for checkpoints."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.method.spheres.soft.engine.contact.remembered import ROLLING
from mesokit.method.spheres.soft.engine.groups import Lists

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
