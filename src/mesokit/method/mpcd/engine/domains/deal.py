"""Particles that are made or read piece by piece are sent to the ranks of their blocks."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.method.mpcd.engine.pieces import Piece

DONE, MORE, FAILED = range(3)

Owners = Callable[[NDArray[np.float64]], NDArray[np.int64]]


def distributed(
    comm: Any, particles: Iterable[Piece], owners: Owners, beads: int, d: int
) -> Iterator[Piece]:
    """The particles of this rank out of the pieces of all ranks, in rounds, in d dimensions.

    Pieces hold whole molecules, which belong to the block of their first bead; `owners` returns the
    rank of each place (n, d). All ranks call this together; their numbers of pieces may differ. An
    error of one rank while it makes its pieces is raised on every rank.
    """
    left = iter(particles)
    # Collective rounds: each rank sends one piece, or an empty one when it has no more. The rounds
    # end on all ranks together, so none waits in `Alltoall` for one that has finished.
    while True:
        piece, error = None, None
        try:
            piece = next(left, None)
            to = np.repeat(owners(piece.positions[::beads]), beads) if piece else np.zeros(0, int)
        except Exception as reason:
            error = reason
        if not _any_left(comm, piece is not None, error):
            return
        rows = np.zeros((0, 1 + 3 * d), np.int64)
        if piece is not None:  # all numbers of each particle in a row, as their bits
            reals = np.concatenate([piece.positions, piece.velocities], axis=1, dtype=float)
            columns = piece.ids[:, None], reals.view(np.int64), piece.images
            rows = np.concatenate(columns, axis=1, dtype=np.int64)
        come = _sent(comm, rows, to)
        reals = np.ascontiguousarray(come[:, 1 : 1 + 2 * d]).view(float)
        images = come[:, 1 + 2 * d :].astype(np.int32)
        yield Piece(come[:, 0], reals[:, :d], reals[:, d:], images)


def _any_left(comm: Any, here: bool, error: Exception | None) -> bool:
    """True if any rank has a piece. Raises if a rank has failed."""
    worst = max(comm.allgather(FAILED if error else MORE if here else DONE))
    if worst == FAILED:
        said = comm.allgather(None if error is None else str(error))
        if error is not None:
            raise error
        rank = next(k for k, text in enumerate(said) if text is not None)
        raise RunError(f"rank {rank}: {said[rank]}")
    return bool(worst == MORE)


def _sent(comm: Any, rows: NDArray[np.int64], to: NDArray[np.int64]) -> NDArray[np.int64]:
    """Send each row to a rank; returns the rows received, in the order of the senders."""
    words = rows.shape[1]
    sent = np.bincount(to, minlength=comm.size).astype(np.int64)
    come = np.empty_like(sent)
    comm.Alltoall(sent, come)
    out = np.empty((int(come.sum()), words), np.int64)
    ordered = np.ascontiguousarray(rows[np.argsort(to, kind="stable")])
    comm.Alltoallv([ordered, sent * words], [out, come * words])
    return out
