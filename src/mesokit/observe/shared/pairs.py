"""Numbers of pairs by their distance in a periodic box, and their error bars."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.observe.shared.over_molecules import OwnMeans
from mesokit.seam.result import Array


def count_pairs(one: Array, other: Array | None, box: Array, edges: Array) -> NDArray[np.int64]:
    """Pairs at distances between `edges`, from 0 to half of the box at most.

    Those of places `one` (n, d) with the `other`, or, without these, among themselves, each once.

    >>> places, box = np.array([[0.5, 1.0], [9.5, 1.0], [5.0, 1.0]]), np.array([10.0, 8.0])
    >>> count_pairs(places, None, box, np.array([0.0, 2.0, 4.0])).tolist()
    [1, 0]
    """
    first = _tree(one, box)
    second = first if other is None else _tree(other, box)
    found = first.count_neighbors(second, edges, cumulative=False)[1:]
    return np.asarray(found // 2 if other is None else found, np.int64)


def count_within(molecules: Array, box: Array, edges: Array) -> NDArray[np.int64]:
    """The same of the pairs within each of molecules (molecules, length, d).

    >>> pair = np.array([[[0.5, 1.0], [9.5, 1.0]]])
    >>> count_within(pair, np.array([10.0, 8.0]), np.array([0.0, 2.0, 4.0])).tolist()
    [1, 0]
    """
    found = np.zeros(len(edges) - 1, np.int64)
    for distances in _within(molecules, box):
        found += np.histogram(distances, edges)[0]
    return found


def _within(molecules: Array, box: Array) -> Iterator[Array]:
    """Distances (molecules, pairs) of beads that are 1, 2, ... places apart in a molecule."""
    for apart in range(1, molecules.shape[1]):
        separation = molecules[:, apart:] - molecules[:, :-apart]
        separation -= box * np.rint(separation / box)
        yield np.sqrt((separation**2).sum(axis=2))


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
    number, bins, d = groups[-1] + 1, len(edges) - 1, molecules.shape[2]
    within = np.zeros(number * (bins + 2), np.int64)
    for distances in _within(molecules, box):
        place = np.searchsorted(edges, distances) + groups[:, None] * (bins + 2)
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


class OwnPairs(OwnMeans):
    """Pairs that each molecule makes over the run, at each distance, of molecules that are alike
    and independent of one another.

    Wherever one molecule is, others are everywhere alike, so that different pairs of molecules are
    not correlated. The sum over pairs has half of the mean square that the molecules' own sums have
    together: twice that of independent halves. Pairs within molecules are independent.

    Parameters
    ----------
    molecules: how many.
    bins: of the distance.
    """

    def __init__(self, molecules: int, bins: int) -> None:
        super().__init__(molecules, 2 * bins)
        self.molecules = molecules

    def add_places(self, places: Array, box: Array, edges: Array) -> None:
        """Take one sample: places (molecules, length, d) of their beads."""
        groups = self.group_of(np.arange(self.molecules))
        between, within = count_each(places, groups, box, edges)
        self.add_sums(self.molecules * np.concatenate([between / 2, within], axis=1))

    def error_of_pairs(self, combine: Array, within: bool = True) -> Array:
        """Standard errors (n,) of linear combinations (n, bins) of the mean numbers of pairs.

        `within`: whether those within molecules count.
        """
        none = np.zeros_like(combine)
        square = 2 * self.error(np.concatenate([combine, none], axis=1)) ** 2
        if within:
            square = square + self.error(np.concatenate([none, combine], axis=1)) ** 2
        return np.asarray(np.sqrt(square))


def _tree(places: Array, box: Array) -> Any:
    from scipy.spatial import cKDTree

    folded = places % box
    return cKDTree(np.where(folded < box, folded, 0.0), boxsize=box)
