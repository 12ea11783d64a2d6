"""The state of all ranks as arrays that come piece by piece: no rank holds the whole."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.method.mpcd.engine.pieces import pieces

ROOT = 0  # the rank that reads and writes files
SPREAD = "positions", "velocities", "images"  # what a state has of each particle
Rows = Callable[[int, int], tuple[NDArray[np.int64], NDArray[Any]]]


class Spread:
    """An array (n, ...) of which each rank has some rows.

    `rows` returns the numbers of this rank's rows from one number to before another, and these
    rows. All ranks must read the array together.
    """

    def __init__(self, comm: Any, shape: tuple[int, ...], dtype: Any, rows: Rows) -> None:
        self.comm, self.shape, self.dtype, self.rows = comm, shape, np.dtype(dtype), rows

    def blocks(self) -> Iterator[NDArray[Any]]:
        """All rows in order, in blocks, on the first rank; the other ranks receive empty blocks."""
        for first, last in pieces(0, self.shape[0]):
            yield self._block(first, last)

    def _block(self, first: int, last: int) -> NDArray[Any]:
        comm = self.comm
        here, rows = self.rows(first, last)
        counts = np.array(comm.gather(len(here), ROOT) or [0])
        width = int(np.prod(self.shape[1:], dtype=np.int64)) * self.dtype.itemsize
        sent = np.ascontiguousarray(rows, self.dtype).view(np.uint8).reshape(len(here), width)
        ids = np.empty(counts.sum(), np.int64)
        come = np.empty((counts.sum(), width), np.uint8)
        root = comm.rank == ROOT
        comm.Gatherv(np.ascontiguousarray(here, np.int64), [ids, counts] if root else None, ROOT)
        comm.Gatherv(sent, [come, counts * width] if root else None, ROOT)
        block = np.empty((last - first if root else 0, width), np.uint8)
        block[ids - first] = come
        return block.view(self.dtype).reshape(-1, *self.shape[1:])

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """The whole on every rank, for small arrays."""
        blocks = [self.comm.bcast(block, ROOT) for block in self.blocks()]
        return np.concatenate([np.zeros((0, *self.shape[1:]), self.dtype), *blocks]).astype(
            dtype or self.dtype
        )
