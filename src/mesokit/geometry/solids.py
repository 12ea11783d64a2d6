"""Where the solids of a case are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit.box import AXES

if TYPE_CHECKING:
    from mesokit.case import Case

Array = NDArray[np.floating[Any]]


class Solids:
    """All solids of a case, asked for distances.

    Examples
    --------
    >>> from mesokit import Box, Case, Plates, Run
    >>> case = Case(run=Run(steps=1), box=Box([8, 6]), walls=[Plates(axis="y")])
    >>> Solids(case).distance(np.array([[1.0, 2.0], [1.0, 7.0]]))
    array([ 2., -1.])
    """

    def __init__(self, case: Case) -> None:
        self.case = case

    def distance(self, points: Array) -> Array:
        """Distance (n,) of points (n, d) to the nearest surface, negative inside a solid."""
        nearest = np.full(len(points), np.inf)
        for wall in self.case.walls:
            axis = AXES.index(wall.axis)
            height = points[:, axis]
            nearest = np.minimum(nearest, np.minimum(height, self.case.box.size[axis] - height))
        return nearest
