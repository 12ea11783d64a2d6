"""Means over time and over molecules, with error bars that also hold in short runs."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesokit.observe.shared.origins import GROUPS
from mesokit.seam.estimate import Array, of_mean
from mesokit.seam.observable import BlockAccumulator
from mesokit.statistics import Blocks, student

FEW = 5  # molecules: the scatter of fewer is no error bar
ROUNDING = 1e-9  # of the scatter of molecules: what they have together never changed


class OwnMeans(BlockAccumulator):
    """Each molecule's own mean over the run, of groups of them where there are many.

    Their scatter sees what takes longer than the run, which blocks of time cannot see.

    Parameters
    ----------
    molecules: how many.
    width: numbers of each.
    """

    memory: ClassVar[tuple[str, ...]] = ("sums", "samples")

    def __init__(self, molecules: int, width: int) -> None:
        groups = min(GROUPS, molecules)
        self._starts = np.arange(groups) * molecules // groups
        self._sizes = np.diff(np.append(self._starts, molecules))
        self.sums = np.zeros((groups, width))
        self.samples = 0
        self._others: list[NDArray[np.float64]] = []  # means of the groups of pooled runs

    def add(self, each: Array) -> None:
        """Take one sample, (molecules, width)."""
        self.add_sums(np.add.reduceat(each, self._starts, axis=0))

    def add_sums(self, sums: Array) -> None:
        """The same of the sums over the molecules of each group, (groups, width)."""
        self.sums += sums
        self.samples += 1

    @property
    def groups(self) -> int:
        """Of the molecules of this run."""
        return len(self._starts)

    def group_of(self, molecules: NDArray[np.int64]) -> NDArray[np.int64]:
        """The group of each of some molecules."""
        return np.searchsorted(self._starts, molecules, side="right") - 1

    def pool(self, other: OwnMeans) -> None:
        """Take in the molecules of an independent run: only to read from then on."""
        self._others += [other._own(), *other._others]

    def _own(self) -> NDArray[np.float64]:
        """Means (groups, width) of this run."""
        return np.asarray(self.sums / (max(self.samples, 1) * self._sizes[:, None]))

    @property
    def number(self) -> int:
        """Number of groups, those of pooled runs included."""
        return len(self.sums) + sum(map(len, self._others))

    def error(self, combine: Array | None = None) -> Array:
        """Standard errors of the mean over all, (width,) or of linear combinations (n, width).

        As their number is small, so that their scatter is itself uncertain, with Student's factor;
        nan of a single one.
        """
        groups = np.concatenate([self._own(), *self._others])
        if combine is not None:
            groups = groups @ combine.T
        if len(groups) < 2:
            return np.full(groups.shape[1], np.nan)
        return student(len(groups)) * groups.std(axis=0, ddof=1) / np.sqrt(len(groups))

    def caution(self) -> str:
        """Where there is no scatter, or hardly any: a note."""
        if self.number >= FEW:
            return ""
        many = f"{self.number} molecules" if self.number > 1 else "one molecule"
        return f"error bar is a lower bound: of {many}"


class MeansOverMolecules(BlockAccumulator):
    """Means of numbers that every molecule has at each sample.

    Two error bars are kept, and the larger counts. Blocks of time show what all molecules do
    together. The scatter of the molecules' own means shows what takes longer than the run, such as
    a chain that is caught behind an obstacle. Where blocks of time differ by rounding alone, the
    mean over all molecules is conserved and has no error.

    Parameters
    ----------
    molecules: how many.
    width: numbers of each.
    everything: whether they are all there is.

    >>> means = MeansOverMolecules(8, 1)
    >>> for time in range(16):
    ...     means.add(np.arange(8.0)[:, None])  # each keeps its own for ever
    >>> means.mean().tolist(), means.error().round(2).tolist()  # 1.08 sqrt(6/8), not 0
    ([3.5], [0.93])
    """

    memory: ClassVar[tuple[str, ...]] = ("blocks", "own")

    def __init__(self, molecules: int, width: int, everything: bool = False) -> None:
        self.blocks, self.own = Blocks((width,)), OwnMeans(molecules, width)
        self.everything = everything

    def add(self, each: Array) -> None:
        """Take one sample, (molecules, width)."""
        self.blocks.add(each.mean(axis=0))
        self.own.add(each)

    def mean(self, combine: Array | None = None) -> Array:
        """Means (width,), or linear combinations (n, width) of them; nan before the first."""
        mean = self.blocks.mean()
        return mean if combine is None else np.asarray(combine @ mean)

    def error(self, combine: Array | None = None) -> Array:
        """Standard errors of the same; nan for fewer than 4 samples."""
        if not self.blocks.count:
            return np.full(len(self.mean(combine)), np.nan)
        found = of_mean(self.blocks)
        if combine is not None:
            found = found.linear(combine)
        error, own = found.error, self.own.error(combine)
        if self.everything:
            own = np.where(error <= ROUNDING * own, ROUNDING * own, own)
        return np.where(np.isnan(error), error, np.fmax(error, own))

    def total(self, weights: Array | None = None) -> tuple[float, float]:
        """The sum of the means times weights (width,), or the only mean, and its standard error."""
        combine = None if weights is None else weights[None]
        return float(self.mean(combine)[0]), float(self.error(combine)[0])

    def caution(self) -> str:
        """Note on error bars that blocks of time alone give."""
        return self.own.caution()
