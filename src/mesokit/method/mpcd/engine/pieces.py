"""Particles by their numbers, so many at a time: no rank makes, sends or writes all at once."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

PIECE = 2**18  # particles
ROOT = 0  # the rank that reads and writes files
SPREAD = "positions", "velocities", "images"  # what a state has of each particle
Rows = Callable[[int, int], tuple[NDArray[np.int64], NDArray[Any]]]


class Piece(NamedTuple):
    """Some particles: their numbers (n,), positions, velocities and images (n, d)."""

    ids: NDArray[np.int64]
    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    images: NDArray[np.int32]


def pieces(first: int, last: int, beads: int = 1) -> Iterator[tuple[int, int]]:
    """Ranges of particles from `first` to before `last`, each of whole molecules.

    >>> list(pieces(0, 3))
    [(0, 3)]
    """
    size = max(PIECE // beads, 1) * beads
    for start in range(first, last, size):
        yield start, min(start + size, last)


def of_state(state: Mapping[str, Any], shape: tuple[int, int], beads: int) -> Iterator[Piece]:
    """The particles of a state, piece by piece. Raises ValueError if it is of others."""
    names = "positions", "velocities", "images"
    for name in names:
        if state[name].shape != shape:
            raise ValueError(f"{name} of shape {state[name].shape}, not {shape}")
    for first, last in pieces(0, shape[0], beads):
        yield Piece(np.arange(first, last), *(state[name][first:last] for name in names))


def require_finite(state: Mapping[str, Any]) -> None:
    """Raise ValueError for places and velocities that are no numbers."""
    for name in ("positions", "velocities"):
        for first, last in pieces(0, len(state[name])):
            if not np.isfinite(state[name][first:last].astype(float)).all():
                raise ValueError(f"{name} that are no numbers")


class Spread:
    """An array (n, ...) of which each rank has some rows.

    `rows` returns the numbers of this rank's rows from one number to before another, and these
    rows. All ranks must read the array together.
    """

    def __init__(self, comm: Any, shape: tuple[int, ...], dtype: Any, rows: Rows) -> None:
        self.comm, self.shape, self.dtype, self.rows = comm, shape, np.dtype(dtype), rows

    def blocks(self) -> Iterator[NDArray[Any]]:
        """All rows in order, in blocks, on the first rank; the other ranks receive empty blocks."""
        comm, root = self.comm, self.comm.rank == ROOT
        width = int(np.prod(self.shape[1:], dtype=np.int64)) * self.dtype.itemsize
        for first, last in pieces(0, self.shape[0]):
            here, rows = self.rows(first, last)
            counts = np.array(comm.gather(len(here), ROOT) or [0])
            sent = np.ascontiguousarray(rows, self.dtype).view(np.uint8).reshape(len(here), width)
            ids = np.empty(counts.sum(), np.int64)
            come = np.empty((counts.sum(), width), np.uint8)
            numbers = np.ascontiguousarray(here, np.int64)
            comm.Gatherv(numbers, [ids, counts] if root else None, ROOT)
            comm.Gatherv(sent, [come, counts * width] if root else None, ROOT)
            block = np.empty((last - first if root else 0, width), np.uint8)
            block[ids - first] = come
            yield block.view(self.dtype).reshape(-1, *self.shape[1:])

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """The whole on every rank, for small arrays."""
        blocks = [self.comm.bcast(block, ROOT) for block in self.blocks()]
        return np.concatenate([np.zeros((0, *self.shape[1:]), self.dtype), *blocks]).astype(
            dtype or self.dtype
        )
