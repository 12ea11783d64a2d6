"""Many particles change hands at once: at the start, and when borders move."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Rows = NDArray[np.int64]  # number, bits of place and velocity, images: (n, 1 + 3 d)


def packed(who: NDArray[np.int64], positions: Floats, velocities: Floats, images: Any) -> Rows:
    """Particles as rows of whole numbers."""
    d = positions.shape[1]
    rows = np.empty((len(who), 1 + 3 * d), np.int64)
    rows[:, 0] = who
    rows[:, 1 : 1 + d] = np.ascontiguousarray(positions).view(np.int64)
    rows[:, 1 + d : 1 + 2 * d] = np.ascontiguousarray(velocities).view(np.int64)
    rows[:, 1 + 2 * d :] = images
    return rows


def unpacked(rows: Rows) -> tuple[NDArray[np.int64], Floats, Floats, NDArray[np.int32]]:
    """Numbers, positions, velocities and images."""
    d = (rows.shape[1] - 1) // 3
    floats = np.ascontiguousarray(rows[:, 1 : 1 + 2 * d]).view(float)
    return rows[:, 0].copy(), floats[:, :d], floats[:, d:], rows[:, 1 + 2 * d :].astype(np.int32)


def given_away(rows: Rows, owner: NDArray[np.int64], comm: Any) -> Rows:
    """Rows go to their owners, those of one rank in their order; what has come here."""
    order = np.argsort(owner, kind="stable")
    sent = np.ascontiguousarray(rows[order])
    counts = np.bincount(owner, minlength=comm.size)
    come = np.empty_like(counts)
    comm.Alltoall(counts, come)
    out = np.empty((int(come.sum()), rows.shape[1]), np.int64)
    comm.Alltoallv([sent, counts * rows.shape[1]], [out, come * rows.shape[1]])
    return out
