"""A time series in memory that never grows: averages over so many samples that it fits."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.statistics.blocking import FEWEST_BLOCKS


class TimeSeries:
    """Rows of numbers in time; neighbours are averaged in pairs whenever the memory is full.

    Averages, unlike every other sample, keep fast motion from showing as slow.

    Parameters
    ----------
    width: numbers in a row.
    rows: largest number of rows kept, even.

    Raises ValueError for an odd number of rows.

    >>> series = TimeSeries(1, rows=4)
    >>> for time in range(6):
    ...     series.add(time, [2 * time])
    >>> series.time(), series.values()[:, 0], series.stride
    (array([0.5, 2.5, 4.5]), array([1., 5., 9.]), 2)
    """

    def __init__(self, width: int, rows: int = 4096) -> None:
        if rows < 2 or rows % 2:
            raise ValueError(f"rows must be even and at least 2, got {rows}")
        self._rows = np.zeros((rows, 1 + width))  # time first
        self._full = 0  # rows that are complete
        self._partial = 0  # samples in the row being filled
        self._stride = 1  # samples in a row
        self._others: list[TimeSeries] = []  # pooled with it

    def add(self, time: float, values: ArrayLike) -> None:
        """Add one row; raises ValueError for another number of values."""
        if self._full == len(self._rows):
            self._full //= 2
            self._rows[: self._full] = (self._rows[0::2] + self._rows[1::2]) / 2
            self._rows[self._full :] = 0
            self._stride *= 2
        row = self._rows[self._full]
        row[0] += time
        row[1:] += values
        self._partial += 1
        if self._partial == self._stride:
            row /= self._stride
            self._full += 1
            self._partial = 0

    def pool(self, other: "TimeSeries") -> None:
        """Take in another, independent series that began at the same time: `time` and `values` are
        then the mean of both, as far as the shorter one goes.

        >>> one, other = TimeSeries(1), TimeSeries(1)
        >>> one.add(0, [1]), one.add(1, [2]), other.add(0, [3])
        (None, None, None)
        >>> one.pool(other)
        >>> one.time(), one.values()
        (array([0.]), array([[2.]]))
        """
        self._others.append(other)

    @property
    def stride(self) -> int:
        """Samples that a row is the mean of."""
        return max(series._stride for series in (self, *self._others))

    def time(self) -> NDArray[np.float64]:
        """Mean time of each complete row, (n,)."""
        return self._pooled()[:, 0]

    def values(self) -> NDArray[np.float64]:
        """The complete rows, oldest first, (n, width)."""
        return self._pooled()[:, 1:]

    @property
    def series(self) -> int:
        """The number of independent series that are pooled in it."""
        return 1 + len(self._others)

    def each(self) -> NDArray[np.float64]:
        """The values of every series, as far as the shortest goes, (series, n, width).

        >>> one, other = TimeSeries(1), TimeSeries(1)
        >>> one.add(0, [1]), other.add(0, [3]), one.pool(other)
        (None, None, None)
        >>> one.each()[:, 0, 0]
        array([1., 3.])
        """
        return self._aligned()[:, :, 1:]

    def error(self) -> NDArray[np.float64]:
        """Standard errors of `values`, (n, width), by how the pooled series scatter; nan for fewer
        than 4.

        >>> series = [TimeSeries(1) for _ in range(4)]
        >>> for one, value in zip(series, (1, 2, 3, 6)):
        ...     one.add(0, [value])
        >>> for other in series[1:]:
        ...     series[0].pool(other)
        >>> float(series[0].values()[0, 0]), round(float(series[0].error()[0, 0]), 3)
        (3.0, 1.08)
        """
        rows = self._aligned()[:, :, 1:]
        if len(rows) < FEWEST_BLOCKS:
            return np.full(rows.shape[1:], np.nan)
        return np.asarray(rows.std(axis=0, ddof=1) / np.sqrt(len(rows)))

    def _pooled(self) -> NDArray[np.float64]:
        """The mean of all series."""
        if not self._others:
            return self._rows[: self._full].copy()
        return np.asarray(self._aligned().mean(axis=0))

    def _aligned(self) -> NDArray[np.float64]:
        """The rows of all series, (series, n, 1 + width), as far as the shortest goes."""
        all_rows = [series._coarse(self.stride) for series in (self, *self._others)]
        shortest = min(map(len, all_rows))
        return np.array([rows[:shortest] for rows in all_rows])

    def _coarse(self, stride: int) -> NDArray[np.float64]:
        """Complete rows that are means over `stride` samples, a power of two times its own."""
        rows, many = self._rows[: self._full], stride // self._stride
        return rows[: len(rows) // many * many].reshape(-1, many, rows.shape[1]).mean(axis=1)

    def state(self) -> dict[str, NDArray[Any]]:
        """Everything that `from_state` needs to go on with the same bits, as arrays."""
        used = self._full + (self._partial > 0)
        counts = [len(self._rows), self._full, self._partial, self._stride]
        return {"rows": self._rows[:used].copy(), "counts": np.array(counts, np.int64)}

    @classmethod
    def from_state(cls, state: Mapping[str, NDArray[Any]]) -> "TimeSeries":
        """Rebuild from `state()`; raises KeyError for a missing entry.

        >>> series = TimeSeries(1)
        >>> series.add(0.5, [3.0])
        >>> TimeSeries.from_state(series.state()).values()
        array([[3.]])
        """
        rows, full, partial, stride = (int(number) for number in state["counts"])
        series = cls(state["rows"].shape[1] - 1, rows)
        series._rows[: len(state["rows"])] = state["rows"]
        series._full, series._partial, series._stride = full, partial, stride
        return series
