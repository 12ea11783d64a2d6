"""Neighbours: images next to one another, when lists must be made again, and pairs at one time.

A list holds all within the reach of a pair and a skin. It is complete until two particles may have
approached one another by more than the skin (Verlet 1967).
"""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.scalar.elementary import rint  # noqa: F401  in the text of `nearest_image`
from mesokit.scalar.jit import elementwise, scalar

Floats = NDArray[np.floating[Any]]
GAP = 8  # numbers between those of two threads: each has a cache line of its own


@elementwise
def nearest_image(box, separation):
    """The shortest of the vectors that differ from a separation by whole boxes at rest."""
    return "separation[{k}] - rint(separation[{k}] * box.inverse[{k}]) * box.size[{k}]"


@scalar
def outdated(noted, column, threads, slip, skin):
    """Whether lists may miss a pair; the answer is the same in all threads.

    noted[t, column]: square of the longest displacement of the particles of thread t since the
    lists were made; `slip`: displacement of images along x meanwhile.
    """
    farthest = 0.0
    for t in range(threads):
        farthest = max(farthest, noted[t, column])
    return too_far(farthest, slip, skin)


@scalar
def too_far(square, slip, skin):
    """Whether lists may miss a pair after a longest displacement of this square."""
    return 2.0 * math.sqrt(square) + slip > skin


@scalar
def insert(lists, i, length, number):
    """Insert a number into list i, which is in order and so long; returns its new length."""
    place = length
    while place > 0 and lists[i, place - 1] > number:
        lists[i, place] = lists[i, place - 1]
        place -= 1
    lists[i, place] = number
    return length + 1


def inverse_lengths(size: Iterable[float], closed: Iterable[bool]) -> tuple[float, ...]:
    """One over each length of a box, 0 along closed axes."""
    return tuple(
        0.0 if shut else 1.0 / float(length) for shut, length in zip(closed, size, strict=True)
    )


def near_pairs(
    places: Floats, reach: float, period: Floats
) -> tuple[NDArray[np.int64], NDArray[np.int64], Floats]:
    """Pairs of places (n, d) within a reach: the first of each, the second, and their distances.

    period (d,): lengths after which the box repeats, 0 along closed axes.
    """
    from scipy.spatial import cKDTree

    repeats = period > 0
    lengths = np.where(repeats, period, 1.0)
    inside = np.where(repeats, np.mod(places, lengths), places)
    inside[repeats & (inside >= lengths)] = 0.0  # a place just below 0 is rounded up to the length
    one, other = cKDTree(inside, boxsize=period).query_pairs(reach, output_type="ndarray").T
    separation = inside[one] - inside[other]
    separation -= period * np.rint(separation / lengths)
    return one, other, np.linalg.norm(separation, axis=1)
