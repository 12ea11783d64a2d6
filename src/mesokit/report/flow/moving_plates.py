"""Plates that vibrate, where they are at a time."""

from typing import NamedTuple

import numpy as np

from mesokit.case.case import Case
from mesokit.method.spheres.common import walls as columns
from mesokit.method.spheres.common.walls import other_walls, surface_rows
from mesokit.report.flow.data import Array


class Plate(NamedTuple):
    """A point of a plate at rest, its normal, both of the box, and how far it is along this."""

    point: Array
    normal: Array
    shift: float

    def moved(self, points: Array, distance: Array) -> Array:
        """Distances of points (n, d) from all surfaces, if this one were not at rest."""
        rest = (points - self.point) @ self.normal
        nearest = np.isclose(distance, rest, rtol=0, atol=1e-9)
        return np.where(nearest, rest - self.shift, np.minimum(distance, rest - self.shift))


def plates_at(case: Case, time: float) -> tuple[Plate, ...]:
    """Those of spheres that vibrate."""
    rows, d = surface_rows(case, other_walls(case)).rows, case.box.dimension
    return tuple(
        Plate(
            rows[w, columns.PLACE : columns.PLACE + d],
            rows[w, columns.AXIS : columns.AXIS + d],
            columns.vibration(rows, w, time)[0],
        )
        for w in np.flatnonzero(rows[:, columns.AMPLITUDE] > 0)
    )
