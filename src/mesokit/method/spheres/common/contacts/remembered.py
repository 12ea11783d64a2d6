"""Springs of contacts along the surface: friction with a memory (Cundall and Strack 1979).

In memory a contact has a row of no, three or six numbers: springs of sliding and of rolling.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import share
from mesokit.method.spheres.common.contacts.groups import Lists
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added_scaled, dot, scaled
from mesokit.seam.engine import Array

Pairs = NDArray[np.int64]
SLIDING, ROLLING = 0, 3  # columns of the two springs of a contact


class Slider(NamedTuple):
    """Stiffness (0: a dashpot alone) and damping of a spring, and the largest force."""

    stiffness: float
    damping: float
    limit: float


class Springs(NamedTuple):
    """The springs of a contact: how far it slid and rolled, held back by friction."""

    sliding: tuple[float, float, float]
    rolling: tuple[float, float, float]


@scalar
def stretched(slider, spring, velocity, normal, step):
    """The force, and the spring after a step: stretched by the velocity, turned into the plane of
    contact, and cut back to the largest force."""
    spring = added_scaled(spring, step, velocity)
    spring = added_scaled(spring, -dot(spring, normal), normal)
    force = added_scaled(scaled(-slider.stiffness, spring), -slider.damping, velocity)
    square = dot(force, force)
    if square > slider.limit * slider.limit:
        force = scaled(slider.limit / math.sqrt(square), force)
        if slider.stiffness > 0.0:
            held = added_scaled(force, slider.damping, velocity)
            spring = scaled(-1.0 / slider.stiffness, held)
    return force, spring


NO_SPRINGS = Springs((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@scalar
def kept(springs, c):
    """The springs of contact c; of zero length where contacts have no memory."""
    sliding, rolling = NO_SPRINGS.sliding, NO_SPRINGS.rolling
    if springs.shape[1] > SLIDING:
        sliding = springs[c, 0], springs[c, 1], springs[c, 2]
    if springs.shape[1] > ROLLING:
        rolling = springs[c, 3], springs[c, 4], springs[c, 5]
    return Springs(sliding, rolling)


@scalar
def keep(springs, c, now):
    """Store the springs of contact c."""
    if springs.shape[1] > SLIDING:
        springs[c, 0], springs[c, 1], springs[c, 2] = now.sliding
    if springs.shape[1] > ROLLING:
        springs[c, 3], springs[c, 4], springs[c, 5] = now.rolling


@scalar
def kept_between(lists, i, j):
    """The springs of spheres i and j for i; sliding has the other sign in the memory of j."""
    for s in range(lists.own[i]):
        if lists.near[i, s] == j:
            return kept(lists.springs, lists.begin[i] + s)
    for s in range(lists.own[j]):
        if lists.near[j, s] == i:
            found = kept(lists.springs, lists.begin[j] + s)
            return Springs(scaled(-1.0, found.sliding), found.rolling)
    return NO_SPRINGS


@kernel
def carry_springs(worker, order, old, new):
    """Copy springs from old lists to new ones; `order` (n,): old places in memory."""
    first, last = share(len(order), worker.thread, worker.threads)
    for i in range(first, last):
        for s in range(new.own[i]):
            found = kept_between(old, order[i], order[new.near[i, s]])
            keep(new.springs, new.begin[i] + s, found)


def pairs_of(lists: Lists, number: Pairs) -> tuple[Pairs, Array]:
    """Sorted pairs of particle numbers (m, 2), the smaller first, with stretched springs, and these
    springs (m, width) for the first of the two."""
    pairs, signs = _contacts_in_memory(lists, number)
    springs = lists.springs[: len(pairs)] * signs
    kept = (springs != 0).any(axis=1)
    pairs, which = np.unique(pairs[kept], axis=0, return_index=True)
    return pairs, springs[kept][which]


def remember(lists: Lists, number: Pairs, pairs: Pairs, springs: Array) -> None:
    """Store springs (m, width) of pairs of particle numbers (m, 2) in the lists."""
    own, signs = _contacts_in_memory(lists, number)
    keys, wanted = (each[:, 0] * len(number) + each[:, 1] for each in (pairs, own))
    at = np.searchsorted(keys, wanted)
    found = keys.take(at, mode="clip") == wanted if len(keys) else np.zeros(len(own), bool)
    lists.springs[: len(own)][found] = springs[at[found]] * signs[found]


def _contacts_in_memory(lists: Lists, number: Pairs) -> tuple[Pairs, Any]:
    """Pairs of all contacts in the order of memory, the smaller number first, and the signs
    (m, width) of the springs in memory against those for the first."""
    one = np.repeat(np.arange(len(number)), lists.own)
    other = lists.near[one, np.arange(len(one)) - lists.begin[one]]
    both = np.stack([number[one], number[other]], axis=1)
    signs = np.ones((len(one), lists.springs.shape[1]))
    signs[both[:, 0] > both[:, 1], :ROLLING] = -1.0
    return np.sort(both, axis=1), signs
