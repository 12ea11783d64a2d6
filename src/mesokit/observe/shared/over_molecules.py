"""Means over time and over molecules, with error bars that also hold in short runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.observe.shared.estimate import Array, of_mean
from mesokit.observe.shared.origins import GROUPS
from mesokit.observe.shared.protocol import State, pack, unpack
from mesokit.statistics import Blocks

FEWEST = 4  # groups of molecules that tell how far molecules scatter


class MeansOverMolecules:
    """Means of numbers that every molecule has at each sample.

    Two error bars are kept, and the larger counts: blocks of time see what all molecules do
    together, the scatter of the molecules' own means sees what takes longer than the run, such as
    a chain that is caught behind an obstacle.

    Parameters
    ----------
    molecules: how many.
    width: numbers of each.

    >>> means = MeansOverMolecules(8, 1)
    >>> for time in range(16):
    ...     means.add(np.arange(8.0)[:, None])  # each keeps its own for ever
    >>> means.mean().tolist(), means.error().round(2).tolist()  # sqrt(6/8), not 0
    ([3.5], [0.87])
    """

    def __init__(self, molecules: int, width: int) -> None:
        self.blocks = Blocks((width,))
        groups = min(GROUPS, molecules)
        self._starts = np.arange(groups) * molecules // groups
        self._sizes = np.diff(np.append(self._starts, molecules))
        self._sums = np.zeros((groups, width))
        self._others: list[NDArray[np.float64]] = []  # means of the groups of pooled runs

    def add(self, each: Array) -> None:
        """Take one sample, (molecules, width)."""
        self.blocks.add(each.mean(axis=0))
        self._sums += np.add.reduceat(each, self._starts, axis=0)

    def state(self) -> State:
        """All it has to remember."""
        return pack(blocks=self.blocks, sums=self._sums)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.blocks = Blocks.from_state(unpack(state, "blocks"))
        self._sums = np.array(state["sums"], float)

    def pool(self, other: MeansOverMolecules) -> None:
        """Take in the samples of an independent run: only to read from then on."""
        self._others += [other._of_groups(), *other._others]
        self._own = self._of_groups()
        self.blocks.pool(other.blocks)

    _own: NDArray[np.float64] | None = None  # as they were before others came

    def _of_groups(self) -> NDArray[np.float64]:
        """Means (groups, width) of this run."""
        if self._own is not None:
            return self._own
        samples = max(self.blocks.count, 1)
        return np.asarray(self._sums / (samples * self._sizes[:, None]))

    def mean(self, combine: Array | None = None) -> Array:
        """Means (width,), or linear combinations (n, width) of them; nan before the first."""
        mean = self.blocks.mean()
        return mean if combine is None else np.asarray(combine @ mean)

    def error(self, combine: Array | None = None) -> Array:
        """Standard errors of the same; nan for fewer than 4 samples."""
        if not self.blocks.count:
            return np.full(len(self.mean(combine)), np.nan)
        found = of_mean(self.blocks)
        groups = np.concatenate([self._of_groups(), *self._others])
        if combine is not None:
            found, groups = found.linear(combine), groups @ combine.T
        if len(groups) < FEWEST:
            return found.error
        return np.maximum(found.error, groups.std(axis=0, ddof=1) / np.sqrt(len(groups)))
