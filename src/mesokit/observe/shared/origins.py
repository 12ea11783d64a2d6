"""Two-time averages over particles with many origins, in memory that the longest lag bounds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import State

Array = NDArray[np.floating[Any]]
POINTS = 16  # kept per level; lags are at most 1/8 apart
GROUPS = 32  # of particles, for the error bars
BLOCKS = 32  # of time, for the same


class Origins:
    """Averages over particles and origins of a function of a quantity at two times.

    Level l keeps every 2^l-th sample, POINTS of them: lags 0 to 15, 16, 18 ... 30, 32, 36 ...
    Nothing is averaged in time, every value is exact. Error bars come from the scatter between
    groups of particles, and from that between blocks of time, to which a product belongs by the
    later of its two times (see `Estimate`).

    Parameters
    ----------
    particles: how many.
    dimension: numbers per particle.
    max_lag: longest lag in samples.
    groups: how many, particle i in group i modulo them.
    """

    def __init__(self, particles: int, dimension: int, max_lag: int, groups: int = GROUPS) -> None:
        self.groups = min(groups, particles)
        self.particles = particles // self.groups * self.groups
        self.max_lag, self.added, levels = max_lag, 0, 1
        self.others: list[Origins] = []  # pooled with it
        while POINTS // 2 << levels <= max_lag:
            levels += 1
        self.memory = np.zeros((levels, POINTS, self.particles, dimension))
        self.lags = np.array(
            [0]
            + [
                j << level
                for level in range(levels)
                for j in range(POINTS // 2 if level else 1, POINTS)
                if j << level <= max_lag
            ]
        )
        self.sums = np.zeros((len(self.lags), self.groups))
        self.block_length = 1  # samples
        self.in_time = np.zeros((2, BLOCKS, len(self.lags)))  # sums and counts of blocks
        self.counts = np.zeros(len(self.lags), np.int64)

    def add(self, sample: Array, product: Any) -> None:
        """Add a sample (particles, dimension); `product(old, new)` gives (particles,)."""
        sample = sample[: self.particles]
        if self.added == BLOCKS * self.block_length:
            self.in_time[:, : BLOCKS // 2] = self.in_time[:, ::2] + self.in_time[:, 1::2]
            self.in_time[:, BLOCKS // 2 :] = 0
            self.block_length *= 2
        self._average(0, product(sample, sample))
        index = 1
        # Level l stores every 2^l-th sample and has lags that are multiples of 2^l: all lags of
        # level 0, the longer half of the others. Samples are not averaged, as displacements must be
        # exact.
        for level in range(len(self.memory)):
            first = POINTS // 2 if level else 1
            number, rest = divmod(self.added, 1 << level)
            for j in range(first, POINTS):
                if j << level > self.max_lag:
                    break
                if rest == 0 and number >= j:
                    old = self.memory[level, (number - j) % POINTS]
                    self._average(index, product(old, sample))
                index += 1
            if rest == 0:
                self.memory[level, number % POINTS] = sample
        self.added += 1

    def _average(self, index: int, values: Array) -> None:
        means = values.reshape(-1, self.groups).mean(axis=0)
        self.sums[index] += means
        self.counts[index] += 1
        self.in_time[:, self.added // self.block_length, index] += means.mean(), 1

    @property
    def count(self) -> int:
        """Samples so far, those pooled included."""
        return self.added + sum(other.added for other in self.others)

    @property
    def series(self) -> int:
        """Number of independent series that are pooled in it."""
        return 1 + len(self.others)

    def pool(self, other: Origins) -> None:
        """Take in the groups of another, independent system of the same kind: only to read.

        Raises ValueError for other lags.
        """
        if not np.array_equal(other.lags, self.lags):
            raise ValueError("cannot pool averages over other lags")
        self.others.append(other)

    def sampled(self) -> NDArray[np.int64]:
        """The lags that all have reached."""
        return self.lags[self._reached()]

    def _reached(self) -> NDArray[np.bool_]:
        return np.all([one.counts > 0 for one in (self, *self.others)], axis=0)

    def estimate(self) -> Estimate:
        """Value at each lag that has been reached, in groups of particles and in blocks of time."""
        reached = self._reached()
        systems = (self, *self.others)
        means = np.concatenate([(o.sums[reached] / o.counts[reached, None]).T for o in systems])
        # what a group counts for: products that its mean is over, relative to those of all
        weights = np.concatenate([np.tile(o.counts[reached], (o.groups, 1)) for o in systems])
        share = weights / weights.mean(axis=0)
        value = (means * share).mean(axis=0)
        return Estimate(
            value, (means - value) * share / len(means), share, in_time=self._in_time(value)
        )

    def _in_time(self, value: Array) -> Estimate:
        """The same in blocks of time: those of several systems one after the other."""
        reached = self._reached()
        sums, counts = np.concatenate(
            [one.in_time[:, : -(-one.added // one.block_length)] for one in (self, *self.others)],
            axis=1,
        )[:, :, reached]
        residuals = (sums - value * counts) / counts.sum(axis=0)
        return Estimate(value, residuals, counts, spans=self.lags[reached] / self.added)

    def state(self) -> State:
        """All it has to remember."""
        return {
            "memory": self.memory,
            "sums": self.sums.copy(),
            "counts": self.counts.copy(),
            "in_time": self.in_time.copy(),
            "block_length": np.array(self.block_length),
            "count": np.array(self.added),
        }

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.memory[:] = state["memory"]
        self.sums[:], self.counts[:] = state["sums"], state["counts"]
        self.in_time[:] = state["in_time"]
        self.added, self.block_length = int(state["count"]), int(state["block_length"])
