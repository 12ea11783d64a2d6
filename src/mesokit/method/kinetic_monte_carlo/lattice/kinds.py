"""Kinds of lattices: the neighbours of a site, and where sites are in space.

Sites have whole coordinates (x, y, z) along the axes of a rectangular box. Where two neighbouring
rows or layers are shifted by half a site, the steps to the neighbours depend on the parity of the
site: of y in a triangular lattice, of z in bcc and fcc, of x + y in a honeycomb.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.sites import SiteLattice

Steps = tuple[tuple[int, ...], ...]


class Kind(NamedTuple):
    """Steps to the neighbours of even and of odd sites, the axes whose coordinates make the parity,
    the distances of rows along each axis in distances of neighbours, and the shift of odd sites."""

    even: Steps
    odd: Steps
    parity: tuple[int, ...]  # 1 for an axis that counts
    spacing: tuple[float, ...]
    shift: tuple[float, ...]

    @property
    def dimension(self) -> int:
        """1, 2 or 3."""
        return len(self.parity)

    @property
    def neighbours(self) -> int:
        """How many each site has."""
        return len(self.even)

    @property
    def shifts(self) -> NDArray[np.int64]:
        """Steps (2, neighbours, d) from even and odd sites."""
        return np.array([self.even, self.odd], np.int64)

    @property
    def back(self) -> NDArray[np.int64]:
        """The direction (neighbours,) from a neighbour back: the same of even and odd sites."""
        changes = [
            sum(x * axis for x, axis in zip(step, self.parity, strict=True)) % 2
            for step in self.even
        ]
        return np.array(
            [
                (self.odd if change else self.even).index(tuple(-x for x in step))
                for step, change in zip(self.even, changes, strict=True)
            ]
        )

    def sites(self, size: tuple[int, ...], closed: tuple[bool, ...] = ()) -> SiteLattice:
        """A lattice of so many sites along each axis, which ends along some."""
        return SiteLattice(size, self.spacing, self.parity, self.shift, closed)

    def places(self, size: tuple[int, ...]) -> NDArray[np.float64]:
        """Places (n, d) of all sites, by number, in distances of neighbours."""
        return self.sites(size).places()


def _bravais(*steps: tuple[int, ...]) -> Kind:
    """A lattice whose sites are all alike: steps and their opposites."""
    both = tuple(one for step in steps for one in (step, tuple(-x for x in step)))
    d = len(steps[0])
    return Kind(both, both, (0,) * d, (1.0,) * d, (0.0,) * d)


_SQUARE: Steps = ((1, 0), (-1, 0), (0, 1), (0, -1))
_ROW: Steps = ((1, 0), (-1, 0))
# from a layer to those above and below, which are shifted by half a site along x and y: even layers
# step to x - 1 or x, odd ones to x or x + 1
_DOWN: Steps = tuple((x, y, z) for z in (1, -1) for x in (-1, 0) for y in (-1, 0))
_UP: Steps = tuple((x, y, z) for z in (1, -1) for x in (0, 1) for y in (0, 1))
_LAYER: Steps = tuple((*step, 0) for step in _SQUARE)
_HALF, _ROOT = 0.5, 3**0.5

KINDS: dict[str, Kind] = {
    "chain": _bravais((1,)),
    "square": _bravais((1, 0), (0, 1)),
    "triangular": Kind(
        (*_ROW, (-1, 1), (0, 1), (-1, -1), (0, -1)),
        (*_ROW, (0, 1), (1, 1), (0, -1), (1, -1)),
        (0, 1),
        (1.0, 0.5 * _ROOT),
        (0.5, 0.0),
    ),
    # a wall of bricks: even sites have a neighbour above, odd ones one below
    "honeycomb": Kind((*_ROW, (0, 1)), (*_ROW, (0, -1)), (1, 1), (0.5 * _ROOT, 1.5), (0.0, -0.5)),
    "cubic": _bravais((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "bcc": Kind(
        _DOWN, _UP, (0, 0, 1), (2 / _ROOT, 2 / _ROOT, 1 / _ROOT), (1 / _ROOT, 1 / _ROOT, 0.0)
    ),
    "fcc": Kind(
        (*_LAYER, *_DOWN), (*_LAYER, *_UP), (0, 0, 1), (1.0, 1.0, 0.5 * 2**0.5), (0.5, 0.5, 0.0)
    ),
}
