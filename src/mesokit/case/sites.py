"""Where the sites of a lattice are."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class SiteLattice(NamedTuple):
    """Sites of a lattice, numbered along the last axis first.

    size: (d,) sites along each axis. spacing: (d,) distances of rows along each axis, 1 unless
    said. parity: (d,) 1 for the axes whose coordinates make the parity of a site, and shift: (d,)
    of odd sites; none is shifted unless said. closed: (d,) axes along which the lattice ends; it is
    periodic unless said. Lengths are in distances of neighbours.
    """

    size: tuple[int, ...]
    spacing: tuple[float, ...] = ()
    parity: tuple[int, ...] = ()
    shift: tuple[float, ...] = ()
    closed: tuple[bool, ...] = ()

    @property
    def number(self) -> int:
        """How many sites."""
        return math.prod(self.size)

    @property
    def dimension(self) -> int:
        """How many axes."""
        return len(self.size)

    @property
    def steps(self) -> NDArray[np.float64]:
        """Distances (d,) of rows along each axis."""
        return np.array(self.spacing or (1.0,) * self.dimension)

    @property
    def edges(self) -> NDArray[np.float64]:
        """Lengths (d,) of the box in which it repeats."""
        return self.steps * np.array(self.size)

    @property
    def ends(self) -> tuple[bool, ...]:
        """Axes (d,) along which it ends."""
        return self.closed or (False,) * self.dimension

    @property
    def shifted(self) -> bool:
        """True if rows or layers are shifted by half a site in turn."""
        return any(self.shift) and any(self.parity)

    def places(self) -> NDArray[np.float64]:
        """Places (n, d) of all sites, by number.

        >>> SiteLattice((1, 2), (1.0, 0.75**0.5), (0, 1), (0.5, 0.0)).places().tolist()
        [[0.0, 0.0], [0.5, 0.8660254037844386]]
        """
        whole = np.indices(self.size).reshape(self.dimension, -1).T
        found: NDArray[np.float64] = whole * self.steps
        if self.shifted:
            odd = (whole @ np.array(self.parity)) % 2
            found = found + odd[:, None] * np.array(self.shift)
        return found
