"""Particles that another program has written, from which a case may start."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CaseError

Floats = NDArray[np.float64]


class Snapshot(NamedTuple):
    """Particles of a file, in its own order, in three dimensions.

    `positions` (n, 3); `velocities` (n, 3), `images` (n, 3), `masses` (n,), `diameters` (n,) and
    `spins` (n, 3), angular velocities, or None where the file has none, likewise `orientations`
    (n, 4), quaternions, and `kinds` (n,), names, with `shapes` as GSD has them; `bonds` (b, 2),
    rows of the particles that are linked; `numbers` (n,), what the file calls them; `low` and
    `lengths` (3,) of the box, `tilts` (3,) of its edges.
    """

    positions: Floats
    velocities: Floats | None
    images: NDArray[np.int64] | None
    masses: Floats | None
    bonds: NDArray[np.int64]
    numbers: NDArray[np.int64]
    low: Floats
    lengths: Floats
    tilts: Floats
    diameters: Floats | None = None
    spins: Floats | None = None
    orientations: Floats | None = None
    kinds: NDArray[Any] | None = None
    shapes: Mapping[str, Mapping[str, Any]] = MappingProxyType({})

    def scaled(self, scale: float) -> Snapshot:
        """The same with all lengths times a factor; times and masses stay."""
        lengths = {
            name: scale * getattr(self, name)
            for name in ("positions", "velocities", "low", "lengths", "diameters")
            if getattr(self, name) is not None
        }
        return self._replace(**lengths)


def rows_of(numbers: NDArray[Any], wanted: NDArray[Any]) -> NDArray[np.int64]:
    """Rows in which these numbers of particles are. Raises CaseError for one that is not there.

    >>> rows_of(np.array([7, 5]), np.array([[5, 7]])).tolist()
    [[1, 0]]
    """
    order = np.argsort(numbers, kind="stable")
    place = np.searchsorted(numbers, wanted, sorter=order)
    rows = order[np.minimum(place, len(order) - 1)]
    missing = numbers[rows] != wanted
    if missing.any():
        raise CaseError(f"it links particle {wanted[missing][0]}, which is not there")
    return np.asarray(rows)
