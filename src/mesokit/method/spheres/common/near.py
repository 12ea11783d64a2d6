"""Near spheres in a box that repeats along some axes."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesokit.scalar.elementary import rint  # noqa: F401  of `nearest_image`
from mesokit.scalar.jit import elementwise
from mesokit.seam.engine import Array, Integers


@elementwise
def nearest_image(box, r):
    """The shortest of the vectors that differ from r by whole boxes along axes that repeat."""
    return "r[{k}] - rint(r[{k}] * box.inverse[{k}]) * box.size[{k}]"


def near_pairs(
    places: Array, size: Array, closed: Sequence[bool] | NDArray[np.bool_], reach: float
) -> tuple[Integers, Array]:
    """Pairs (m, 2) of places (n, d) whose nearest images are within `reach`, and distances (m,).

    The box of lengths `size` (d,) repeats along all axes that are not `closed` (d,).
    """
    from scipy.spatial import cKDTree

    around = np.where(closed, 3 * size, size)  # images along closed axes are out of reach
    inside = np.where(closed, places, np.mod(places, size))
    inside = np.where(inside < around, np.maximum(inside, 0.0), 0.0)
    pairs = cKDTree(inside, boxsize=around).query_pairs(reach, output_type="ndarray")
    separation = inside[pairs[:, 0]] - inside[pairs[:, 1]]
    separation -= around * np.rint(separation / around)
    return pairs, np.linalg.norm(separation, axis=1)
