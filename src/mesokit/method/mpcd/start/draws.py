"""Random numbers of each particle or molecule by its id: in any part, in any order."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.kernel import kernel
from mesokit.scalar.random import Counter, normals, unit, words

Floats = NDArray[np.float64]


@kernel
def draw_units(seed, purpose, ids, draw, units):
    """Numbers (n, m) uniform in [0, 1) for those with these numbers (n,), from this draw on."""
    counter = Counter(np.uint64(seed), np.uint64(0))
    for i in range(len(ids)):
        for k in range(0, units.shape[1], 2):
            a, b, c, d = words(counter, purpose, ids[i], draw + k // 2)
            units[i, k] = unit(a, b)
            if k + 1 < units.shape[1]:
                units[i, k + 1] = unit(c, d)


@kernel
def draw_normals(seed, purpose, ids, draw, zero, vectors):
    """Vectors (n, d) of standard normal numbers for those with these numbers (n,), at this draw."""
    counter = Counter(np.uint64(seed), np.uint64(0))
    for i in range(len(ids)):
        a, b, c, d = words(counter, purpose, ids[i], draw)
        v = normals(zero, a, b, c, d)
        for k in range(len(zero)):
            vectors[i, k] = v[k]


class Draws:
    """Random numbers of one purpose for those with some numbers, each from a sequence of its own.

    Parameters: `seed` of the run; `purpose`, one of those in `mesokit.scalar.random`; `ids` (n,) of
    the particles or molecules; `draw`, how many times these have drawn before.

    >>> from mesokit.scalar.random import INITIAL_POSITION
    >>> all_four = Draws(1, INITIAL_POSITION, range(4)).units(3)
    >>> bool((Draws(1, INITIAL_POSITION, [2]).units(3) == all_four[2]).all())
    True
    """

    def __init__(self, seed: int, purpose: np.uint64, ids: Any, draw: int = 0) -> None:
        self.seed, self.purpose, self.draw = seed, purpose, draw
        self.ids = np.asarray(ids, np.int64)

    def of(self, rows: Any) -> Draws:
        """The same draws for some of the ids."""
        return Draws(self.seed, self.purpose, self.ids[rows], self.draw)

    def units(self, columns: int) -> Floats:
        """Numbers (n, columns) uniform in [0, 1) for each."""
        found = np.empty((len(self.ids), columns))
        draw_units(self.seed, self.purpose, self.ids, self.draw, found)
        self.draw += (columns + 1) // 2
        return found

    def normals(self, d: int) -> Floats:
        """A vector (n, d) of standard normal numbers for each; d is 2 or 3."""
        found = np.empty((len(self.ids), d))
        draw_normals(self.seed, self.purpose, self.ids, self.draw, (0.0,) * d, found)
        self.draw += 1
        return found
