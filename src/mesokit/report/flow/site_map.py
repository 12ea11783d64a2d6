"""Sites of a lattice on a grid of bins over two axes: each bin shows the site that is nearest.

Where rows are not shifted, bins are sites. Else they are finer, so that sites are the patches of
points that are nearest to them: hexagons on a triangular lattice, triangles on a honeycomb.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.sites import SiteLattice
from mesokit.report.flow.data import Array

FINEST, FINE = 1400, 64  # bins along the longer axis at most, and for each row there


class SiteMap:
    """Sites over two axes of a lattice; of three axes the layer with a number along the third.

    size: lengths along the axes. Of more than `most` bins along an axis, some are left out.
    """

    def __init__(
        self,
        lattice: SiteLattice,
        axes: tuple[int, int],
        layer: int | None = None,
        most: int = FINEST,
    ) -> None:
        a, b = axes
        numbers: NDArray[Any] = np.arange(lattice.number).reshape(lattice.size)
        rest = next(iter({*range(lattice.dimension)} - {a, b}), None)
        if rest is not None:
            assert layer is not None
            numbers = numbers.take(layer, axis=rest)
        if a > b:
            numbers = numbers.T
        columns = [a, b]
        shifts = np.array(lattice.shift or (0.0,) * lattice.dimension)[columns]
        ends = np.array(lattice.ends)[columns]
        room = np.where(ends, abs(shifts), 0.0)  # for odd rows beyond the end
        lengths = lattice.edges[columns] + room
        self.size = float(lengths[0]), float(lengths[1])
        if not lattice.shifted:
            picked = [np.arange(n)[:: -(-n // most)] for n in numbers.shape]
            self.index = numbers[np.ix_(*picked)]
            return
        steps = lattice.steps[columns]
        first = 0.5 * steps - np.where(ends, np.minimum(shifts, 0.0), 0.5 * shifts)
        places = lattice.places()[numbers.ravel()][:, columns] + first
        fine = min(most, FINE * max(numbers.shape))
        self.index = numbers.ravel()[_nearest(places, lengths, ends, fine)]

    def of(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values of all sites (in the shape of the lattice) on the bins (nx, ny)."""
        return np.asarray(values).ravel()[self.index]

    def steps(self, shape: tuple[int, ...]) -> tuple[float, float]:
        """Lengths of a bin along the two axes."""
        return self.size[0] / shape[0], self.size[1] / shape[1]


def _nearest(
    places: Array, lengths: Array, ends: NDArray[np.bool_], most: int
) -> NDArray[np.int64]:
    """Numbers (nx, ny) of the places (n, 2) that are nearest to the middles of bins."""
    from scipy.spatial import cKDTree

    fine = np.maximum(1, np.round(most * lengths / lengths.max())).astype(int)
    boxes = np.where(ends, 0.0, lengths)  # 0: no images
    tree = cKDTree(np.where(ends, places, places % lengths), boxsize=boxes)
    x, y = ((np.arange(n) + 0.5) * length / n for n, length in zip(fine, lengths, strict=True))
    middles = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.asarray(tree.query(middles)[1], np.int64).reshape(tuple(fine))
