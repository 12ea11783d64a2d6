"""Particles by their numbers, so many at a time: what is made, sent or written is never all."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

PIECE = 2**18  # particles


class Piece(NamedTuple):
    """Some particles: their numbers (n,), positions, velocities and images (n, d)."""

    ids: NDArray[np.int64]
    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    images: NDArray[np.int32]


def pieces(first: int, last: int, beads: int = 1) -> Iterator[tuple[int, int]]:
    """From `first` to before `last`, of whole molecules.

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
