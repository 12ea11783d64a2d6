"""Running time correlations over many decades of lag, in memory that never grows.

Source: J. Ramirez, S. K. Sukumaran, B. Vorselaars and A. E. Likhtman, J. Chem. Phys. 133,
154103 (2010).
"""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from mesokit.statistics.blocking import correlated_error, merge_pairs


class Correlation(NamedTuple):
    """A correlation function: `lag` (n,) in samples, `value` and `error` (n, ...)."""

    lag: NDArray[np.int64]
    value: NDArray[np.float64]
    error: NDArray[np.float64]


class Products(NamedTuple):
    """Lags (n,) in samples, sums (blocks, n, *shape) and numbers (blocks, n) of products."""

    lag: NDArray[np.int64]
    sums: NDArray[np.float64]
    counts: NDArray[np.float64]


class _Level(NamedTuple):
    """Averages of 1, m, m^2, ... samples. The ring holds every entry twice, `points` apart, so
    that the latest `points` entries always lie together, oldest (longest lag) first."""

    ring: NDArray[np.float64]  # (2 points, parts, *shape)
    sums: NDArray[np.float64]  # (blocks, lags, *kept) of products, longest lag first


class MultipleTau:
    """Correlation C(lag) = <Re a(t) conj a(t + lag)> of many signals at once, with error bars.

    Lags below `points` are exact. Beyond, signals are first averaged over `averages` samples,
    then again, so that the lags grow geometrically and C is smoothed over a fraction of at most
    averages/points of the lag. The mean is not subtracted. The sums are kept in at most `blocks`
    blocks of time, merged pairwise as the run grows, for the error bars.

    Parameters
    ----------
    shape: shape of one sample, () for one signal.
    points: lags per level, a multiple of `averages`.
    averages: samples averaged from one level to the next, at least 2.
    max_lag: longest lag in samples; None lets levels grow with the logarithm of the run.
    dtype: float for real signals, complex for complex ones.
    blocks: largest number of blocks of time, even and at least 16.
    pooled: so many of the last axes of `shape` are averaged over at once: only their mean
        correlation is kept, which takes far less memory.

    Raises ValueError for parameters out of range.
    Source: Ramirez et al. (2010).

    >>> correlator = MultipleTau(shape=(50,), max_lag=100)
    >>> for sample in np.random.default_rng(1).normal(size=(2000, 50)):
    ...     correlator.add(sample)
    >>> lag, value, error = correlator.correlation(average_over=0)
    >>> lag[:18]
    array([ 0,  1,  2,  3,  4,  5,  6,  7,  8,  9, 10, 11, 12, 13, 14, 15, 16,
           18])
    >>> bool(abs(value[0] - 1) < 3 * error[0]), bool(abs(value[1]) < 3 * error[1])
    (True, True)
    """

    def __init__(
        self,
        shape: int | tuple[int, ...] = (),
        points: int = 16,
        averages: int = 2,
        max_lag: int | None = None,
        dtype: DTypeLike = float,
        blocks: int = 32,
        pooled: int = 0,
    ) -> None:
        if averages < 2 or points < averages or points % averages:
            raise ValueError(
                f"points must be a multiple of averages, and averages at least 2, "
                f"got points={points} and averages={averages}"
            )
        if max_lag is not None and max_lag < 0:
            raise ValueError(f"max_lag must not be negative, got {max_lag}")
        if np.dtype(dtype) not in (np.dtype(float), np.dtype(complex)):
            raise ValueError(f"dtype must be float or complex, got {dtype}")
        if blocks < 16 or blocks % 2:
            raise ValueError(f"blocks must be even and at least 16, got {blocks}")
        self.shape: tuple[int, ...] = (shape,) if isinstance(shape, int) else tuple(shape)
        if not 0 <= pooled <= len(self.shape):
            raise ValueError(f"pooled must be from 0 to {len(self.shape)}, got {pooled}")
        self.pooled = pooled
        self.kept = self.shape[: len(self.shape) - pooled]
        self.points = points
        self.averages = averages
        self.max_lag = max_lag
        self.blocks = blocks
        self._count = 0  # samples of this series
        self._others: list[MultipleTau] = []  # pooled with it
        self.block_length = 1
        # A complex signal is two real ones whose products add up.
        self._sample = np.zeros((1 + (np.dtype(dtype).kind == "c"), *self.shape))
        self._levels: list[_Level] = []
        self._grow()

    def _grow(self) -> None:
        """Add a level, unless its shortest lag would be too long."""
        first = self.points // self.averages if self._levels else 0
        if self.max_lag is None or first * self.averages ** len(self._levels) <= self.max_lag:
            ring = np.zeros((2 * self.points, *self._sample.shape))
            sums = np.zeros((self.blocks, self.points - first, *self.kept))
            self._levels.append(_Level(ring, sums))

    def add(self, value: ArrayLike) -> None:
        """Add one sample of shape `shape`.

        Raises ValueError for any other shape, TypeError for a complex sample of real signals.
        """
        if np.shape(value) != self.shape:
            raise ValueError(f"a sample must have shape {self.shape}, got {np.shape(value)}")
        array = np.asarray(value)
        if len(self._sample) == 2:
            self._sample[1] = array.imag
        elif array.dtype.kind == "c":
            raise TypeError("a complex sample needs MultipleTau(..., dtype=complex)")
        self._sample[0] = array.real
        block = self._count // self.block_length
        if block == self.blocks:
            block //= 2
            for _, sums in self._levels:
                sums[:block] = merge_pairs(sums)
                sums[block:] = 0
            self.block_length *= 2
        entry, number = self._sample, self._count  # the entry of the level, and how many before it
        self._count += 1
        depth = 0
        # Up the levels, as long as an average of `averages` entries is complete. At each level the
        # new entry is multiplied with the latest ones of its ring. Level l gets an entry every
        # averages^l samples, so the mean cost of a sample is bounded, however long the run.
        while depth < len(self._levels):
            ring, sums = self._levels[depth]
            slot = number % self.points
            end = slot + self.points + 1
            ring[slot] = ring[end - 1] = entry
            products = ring[slot + 1 : slot + 1 + sums.shape[1]] * entry
            for part in range(products.shape[1]):
                sums[block] += self._average(products[:, part])
            number += 1
            if number % self.averages:
                break
            entry = ring[end - self.averages : end].sum(axis=0) / self.averages
            number = number // self.averages - 1
            depth += 1
            if depth == len(self._levels):
                self._grow()

    @property
    def count(self) -> int:
        """Samples so far, those pooled included."""
        return self._count + sum(other._count for other in self._others)

    @property
    def series(self) -> int:
        """The number of independent series that are pooled in it."""
        return 1 + len(self._others)

    def pool(self, other: "MultipleTau") -> None:
        """Take in the products of another, independent series of the same signals: only to read.

        Raises ValueError for a correlator of other signals or lags.

        >>> one, other = MultipleTau(max_lag=1), MultipleTau(max_lag=1)
        >>> for sample in (1.0, 2.0, 3.0):
        ...     one.add(sample), other.add(2 * sample)
        (None, None)
        (None, None)
        (None, None)
        >>> one.pool(other)
        >>> one.correlation().value  # (1 + 4 + 9) (1 + 4) / 6 and (2 + 6) (1 + 4) / 4
        array([11.66666667, 10.        ])
        """
        alike = ("shape", "pooled", "points", "averages", "max_lag")
        if any(getattr(self, name) != getattr(other, name) for name in alike):
            raise ValueError("cannot pool correlators of different signals or lags")
        self._others.append(other)

    def _average(self, products: NDArray[np.float64]) -> NDArray[np.float64]:
        """Mean over the pooled axes."""
        return products.mean(axis=tuple(range(-self.pooled, 0))) if self.pooled else products

    def correlation(
        self, average_over: int | tuple[int, ...] | None = None, normalised: bool = False
    ) -> Correlation:
        """Correlation at every lag sampled so far, up to `max_lag`.

        Parameters
        ----------
        average_over: axis or axes of `shape`, without those pooled, to average over; the error is
            that of the average, correlations between the signals included.
        normalised: divide by the (averaged) value at lag 0, with the error of the ratio.

        Returns lag (n,), value and error (n, *shape without the averaged axes). The error is
        nan where fewer than 4 blocks of time hold the lag; see `correlated_error`.
        Raises AxisError for an axis that `shape` has not.

        >>> correlator = MultipleTau(max_lag=1)
        >>> for sample in (1.0, -1.0, 1.0, -1.0, 1.0):
        ...     correlator.add(sample)
        >>> correlator.correlation(normalised=True).value
        array([ 1., -1.])
        """
        axes = _axes(average_over, len(self.kept))
        lag: list[NDArray[np.int64]] = []
        value, error = [], []
        zero, zero_residuals = np.ones(()), np.zeros(())
        for lags, sums, counts in self.products():
            sums = sums.mean(axis=axes) if axes else sums
            counts = counts.reshape(counts.shape + (1,) * (sums.ndim - 2))
            total = counts.sum(axis=0)
            mean = sums.sum(axis=0) / total
            residuals = (sums - mean * counts) / total
            if normalised:
                if not lag:
                    zero, zero_residuals = mean[0], residuals[:, :1]
                with np.errstate(divide="ignore", invalid="ignore"):
                    mean = mean / zero
                    residuals = (residuals - mean * zero_residuals) / zero
            lag.append(lags)
            value.append(mean)
            error.append(correlated_error(residuals, counts))
        if not lag:
            kept = [n for axis, n in enumerate(self.kept) if axis + 2 not in axes]
            return Correlation(np.zeros(0, np.int64), np.zeros((0, *kept)), np.zeros((0, *kept)))
        return Correlation(np.concatenate(lag), np.concatenate(value), np.concatenate(error))

    def products(self, within_blocks: bool = False) -> Iterator[Products]:
        """Sums and counts of products, level by level, shortest lags first.

        Parameters: `within_blocks` leaves out levels that average over more samples than a block
        of time holds. Yields the levels that have been sampled: lags (n,), sums of products
        (blocks, n, *shape) and numbers of products (blocks, n).

        >>> correlator = MultipleTau(max_lag=1)
        >>> for sample in (1.0, 2.0, 3.0):
        ...     correlator.add(sample)
        >>> lag, sums, counts = next(correlator.products())
        >>> sums.sum(axis=0), counts.sum(axis=0)
        (array([14.,  8.]), array([3., 2.]))
        """
        series = [self, *self._others]
        for depth in range(max(len(one._levels) for one in series)):
            found = [one._level_products(depth, within_blocks) for one in series]
            if any(len(products.lag) for products in found):
                yield found[0] if len(found) == 1 else _joined(found)

    def _level_products(self, depth: int, within_blocks: bool) -> Products:
        """The products of one level: no lags where it has not been reached, or is left out."""
        step, used = self.averages**depth, -(-self._count // self.block_length)
        if depth >= len(self._levels) or (within_blocks and step > self.block_length):
            none: NDArray[np.int64] = np.zeros(0, np.int64)
            return Products(none, np.zeros((used, 0, *self.kept)), np.zeros((used, 0)))
        sums = self._levels[depth].sums[:, ::-1]  # shortest lag first
        offsets = np.arange(self.points - sums.shape[1], self.points)
        ends = np.minimum(np.arange(1, used + 1) * self.block_length, self._count) // step
        starts = np.arange(used) * self.block_length // step
        counts = np.maximum(ends[:, None] - np.maximum(starts[:, None], offsets), 0)
        keep = offsets < self._count // step  # the entry `offset` before the last exists
        if self.max_lag is not None:
            keep &= offsets * step <= self.max_lag
        return Products(step * offsets[keep], sums[:used, keep], counts[:, keep].astype(float))

    def state(self) -> dict[str, NDArray[Any]]:
        """Everything that `from_state` needs to go on with the same bits, as arrays."""
        max_lag = -1 if self.max_lag is None else self.max_lag
        numbers = [
            self._count, self.block_length, self.points, self.averages, max_lag, self.pooled,
        ]  # fmt: skip
        state: dict[str, NDArray[Any]] = {"numbers": np.array(numbers, np.int64)}
        for depth, (ring, sums) in enumerate(self._levels):
            state[f"ring_{depth}"] = ring[: self.points].copy()
            state[f"sums_{depth}"] = sums.copy()
        return state

    @classmethod
    def from_state(cls, state: Mapping[str, NDArray[Any]]) -> "MultipleTau":
        """Rebuild from `state()`; raises KeyError for a missing entry.

        >>> correlator = MultipleTau()
        >>> correlator.add(3.0)
        >>> MultipleTau.from_state(correlator.state()).correlation().value
        array([9.])
        """
        count, block_length, points, averages, max_lag, pooled = map(int, state["numbers"])
        parts, *shape = state["ring_0"].shape[1:]
        correlator = cls(
            shape=tuple(shape),
            points=points,
            averages=averages,
            max_lag=None if max_lag < 0 else max_lag,
            dtype=complex if parts == 2 else float,
            blocks=len(state["sums_0"]),
            pooled=pooled,
        )
        correlator._count, correlator.block_length = count, block_length
        correlator._levels = []
        while f"ring_{len(correlator._levels)}" in state:
            depth = len(correlator._levels)
            ring = np.tile(state[f"ring_{depth}"], (2,) + (1,) * (1 + len(shape)))
            sums = np.array(state[f"sums_{depth}"], np.float64, order="C")
            correlator._levels.append(_Level(ring, sums))
        return correlator


def _joined(found: list[Products]) -> Products:
    """The blocks of several series one after the other; lags that one has not reached are empty."""
    longest = max(found, key=lambda products: len(products.lag)).lag
    sums, counts = [], []
    for products in found:
        lacking = len(longest) - len(products.lag)
        rest = [(0, 0)] * (products.sums.ndim - 2)
        sums.append(np.pad(products.sums, [(0, 0), (0, lacking), *rest]))
        counts.append(np.pad(products.counts, [(0, 0), (0, lacking)]))
    return Products(longest, np.concatenate(sums), np.concatenate(counts))


def _axes(average_over: int | tuple[int, ...] | None, ndim: int) -> tuple[int, ...]:
    """Axes of (blocks, lags, *shape) to average over, given axes of `shape`."""
    if average_over is None:
        return ()
    axes = (average_over,) if isinstance(average_over, int) else average_over
    for axis in axes:
        if not -ndim <= axis < ndim:
            raise np.exceptions.AxisError(axis, ndim)
    return tuple(axis % ndim + 2 for axis in axes)
