"""Numbers of pairs by their distance in a periodic box, in memory that the pairs do not fill."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.result import Array


def count_pairs(one: Array, other: Array | None, box: Array, edges: Array) -> NDArray[np.int64]:
    """Pairs at distances between `edges`, from 0 to half of the box at most.

    Those of places `one` (n, d) with the `other`, or, without these, among themselves, each once.

    >>> places, box = np.array([[0.5, 1.0], [9.5, 1.0], [5.0, 1.0]]), np.array([10.0, 8.0])
    >>> count_pairs(places, None, box, np.array([0.0, 2.0, 4.0])).tolist()
    [1, 0]
    """
    first = _tree(one, box)
    if other is None:
        found = first.count_neighbors(first, edges, cumulative=False)
        return np.asarray(found[1:] // 2, np.int64)
    found = first.count_neighbors(_tree(other, box), edges, cumulative=False)
    return np.asarray(found[1:], np.int64)


def count_within(molecules: Array, box: Array, edges: Array) -> NDArray[np.int64]:
    """The same of the pairs within each of molecules (molecules, length, d).

    >>> pair = np.array([[[0.5, 1.0], [9.5, 1.0]]])
    >>> count_within(pair, np.array([10.0, 8.0]), np.array([0.0, 2.0, 4.0])).tolist()
    [1, 0]
    """
    found = np.zeros(len(edges) - 1, np.int64)
    for apart in range(1, molecules.shape[1]):
        way = molecules[:, apart:] - molecules[:, :-apart]
        way -= box * np.rint(way / box)
        found += np.histogram(np.sqrt((way**2).sum(axis=2)), edges)[0]
    return found


def count_each(
    molecules: Array, groups: NDArray[np.int64], box: Array, edges: Array
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs (groups, bins) of each group of molecules (molecules, length, d): those that its beads
    make with beads of other molecules, and those within its molecules.

    Parameters: `groups` (molecules,), the group of each, ascending from 0.

    >>> pair, box = np.array([[[0.5, 1.0], [9.5, 1.0]]]), np.array([10.0, 8.0])
    >>> molecules = np.concatenate([pair, pair + 1.5])
    >>> between, within = count_each(molecules, np.arange(2), box, np.array([0.0, 2.0, 4.0]))
    >>> between.tolist(), within.tolist()
    ([[1, 3], [1, 3]], [[1, 0], [1, 0]])
    """
    number, bins, (_, length, d) = groups[-1] + 1, len(edges) - 1, molecules.shape
    within = np.zeros(number * (bins + 2), np.int64)
    for apart in range(1, length):
        way = molecules[:, apart:] - molecules[:, :-apart]
        way -= box * np.rint(way / box)
        place = np.searchsorted(edges, np.sqrt((way**2).sum(axis=2)))
        place += groups[:, None] * (bins + 2)
        within += np.bincount(place.ravel(), minlength=len(within))
    inside = within.reshape(number, -1)[:, 1:-1]
    every = _tree(molecules.reshape(-1, d), box)
    starts = np.searchsorted(groups, np.arange(1, number))
    parts = (_tree(part.reshape(-1, d), box) for part in np.split(molecules, starts))
    all_pairs = [part.count_neighbors(every, edges, cumulative=False)[1:] for part in parts]
    return np.array(all_pairs, np.int64) - 2 * inside, inside


def shells(edges: Array, dimension: int) -> Array:
    """Volume (area in 2D) between each two radii."""
    unit = np.pi if dimension == 2 else 4.0 / 3.0 * np.pi
    return np.asarray(unit * np.diff(edges**dimension))


def _tree(places: Array, box: Array) -> Any:
    from scipy.spatial import cKDTree

    folded = places % box
    return cKDTree(np.where(folded < box, folded, 0.0), boxsize=box)
