"""The contacts of the present state, in one order whatever the engine and its threads."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.engine import Array


class Contacts(NamedTuple):
    """All contacts of the present state, sorted by pair.

    Parameters
    ----------
    pairs: (m, 2) particle numbers. A pair of spheres occurs once, the smaller number first; of a
        contact with a wall the second is -1 less the number of the surface.
    normals: (m, d) unit vectors from the second to the first.
    forces: (m, d) on the first, all parts together.
    places: (m, d) of the points of contact, in the box.
    gaps: (m,) between the surfaces, negative where they overlap.
    """

    pairs: NDArray[np.int64]
    normals: Array
    forces: Array
    places: Array
    gaps: Array

    @property
    def normal_forces(self) -> Array:
        """Forces along the normals (m,), positive where the two repel."""
        return np.asarray((self.forces * self.normals).sum(axis=1))

    @property
    def tangential_forces(self) -> Array:
        """Sizes of the forces along the surfaces (m,)."""
        along = self.forces - self.normal_forces[:, None] * self.normals
        return np.asarray(np.linalg.norm(along, axis=1))

    @property
    def at_walls(self) -> NDArray[np.bool_]:
        """Which contacts (m,) are those with a wall."""
        return self.pairs[:, 1] < 0


NORMAL, FORCE, PLACE, GAP, COLUMNS = 0, 3, 6, 9, 10  # columns of one contact, three for a vector


def in_order(pairs: NDArray[np.int64], values: Array, dimension: int, inside: Any) -> Contacts:
    """Contacts from rows in any order.

    Parameters
    ----------
    pairs: (m, 2) as of `Contacts`.
    values: (m, COLUMNS) with three components of each vector.
    dimension: of the box.
    inside: function that moves places (m, d) into the box.
    """
    # One sphere may touch two faces of one surface: then places decide.
    keys = (*values[:, PLACE : PLACE + 3].T, pairs[:, 1], pairs[:, 0])
    pairs, values = pairs[order := np.lexsort(keys)], values[order]
    vectors = (values[:, first : first + dimension] for first in (NORMAL, FORCE, PLACE))
    normals, forces, places = (np.ascontiguousarray(vector) for vector in vectors)
    return Contacts(pairs, normals, forces, inside(places), values[:, GAP].copy())
