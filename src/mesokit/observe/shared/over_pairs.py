"""Sums over pairs of molecules, with error bars that hold in runs in which no pair parts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.observe.shared.over_molecules import OwnMeans
from mesokit.observe.shared.pair_counts import count_each
from mesokit.seam.observable import State
from mesokit.seam.result import Array


class OwnPairs:
    """Pairs that each molecule makes over the run, at each distance, of molecules that are alike
    and know nothing of one another.

    Wherever one molecule is, others are everywhere alike, so that different pairs of molecules are
    not correlated. The sum over pairs has half of the mean square that the molecules' own sums have
    together: twice that of independent halves. Pairs within molecules are independent.

    Parameters
    ----------
    molecules: how many.
    bins: of the distance.
    """

    def __init__(self, molecules: int, bins: int) -> None:
        self.molecules, self.bins = molecules, bins
        self.own = OwnMeans(molecules, 2 * bins)

    def add(self, places: Array, box: Array, edges: Array) -> None:
        """Take one sample: places (molecules, length, d) of their beads."""
        groups = self.own.group_of(np.arange(self.molecules))
        between, within = count_each(places, groups, box, edges)
        self.own.add_sums(self.molecules * np.concatenate([between / 2, within], axis=1))

    def state(self) -> State:
        """All it has to remember."""
        return self.own.state()

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.own.restore(state)

    def pool(self, other: OwnPairs) -> None:
        """Take in the molecules of an independent run: only to read from then on."""
        self.own.pool(other.own)

    def error(self, combine: Array, within: bool = True) -> Array:
        """Standard errors (n,) of linear combinations (n, bins) of the mean numbers of pairs.

        `within`: whether those within molecules count.
        """
        none = np.zeros_like(combine)
        square = 2 * self.own.error(np.concatenate([combine, none], axis=1)) ** 2
        if within:
            square = square + self.own.error(np.concatenate([none, combine], axis=1)) ** 2
        return np.asarray(np.sqrt(square))
