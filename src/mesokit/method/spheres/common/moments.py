"""Sums over spheres in equal bins of the box."""

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.engine import Array, RunningSpheres

Floats = NDArray[np.float64]


def moments(
    spheres: RunningSpheres,
    axes: tuple[int, ...],
    bins: tuple[int, ...],
    ids: NDArray[np.int64] | None = None,
) -> tuple[Floats, Floats, Floats, Floats]:
    """Number (*bins), mass (*bins), momentum (d, *bins) and sum of m v^2 (*bins) in equal bins over
    the whole box along `axes`, of some spheres (all unless said) of an engine."""
    number = np.array(bins)
    places = spheres.positions(ids)[:, list(axes)] / spheres.box[list(axes)]
    cell = np.clip(np.floor(places * number), 0, number - 1).astype(np.int64)
    at, size = np.ravel_multi_index(tuple(cell.T), bins), int(number.prod())
    v, m = spheres.velocities(ids), spheres.masses(ids)

    def summed(values: Array) -> Floats:
        return np.asarray(np.bincount(at, values, size).reshape(bins), float)

    momentum = np.stack([summed(m * column) for column in v.T])
    return summed(np.ones(len(at))), summed(m), momentum, summed(m * (v * v).sum(axis=1))
