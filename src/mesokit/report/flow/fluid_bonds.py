"""Bonds of the fluid's molecules in a picture of its particles."""

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.report.flow.data import Array
from mesokit.seam.method import method_of


class FluidBonds:
    """Those of which both particles are shown. `ids` are the numbers of the particles shown."""

    def __init__(self, case: Case, ids: NDArray[np.int64], columns: list[int]) -> None:
        method = method_of(case)
        self.case, self.columns = case, columns
        order = np.argsort(ids)
        bonds = method.bonds(case)
        place = np.searchsorted(ids[order], bonds).clip(max=max(len(ids) - 1, 0))
        shown = (ids[order][place] == bonds).all(axis=1) if len(ids) else np.zeros(len(bonds), bool)
        self.rows = order[place[shown]] if len(ids) else np.zeros((0, 2), np.int64)
        self.lengths = np.array(case.box.size, float)
        self.open = np.isin(np.arange(len(self.lengths)), list(method.enclosure.closed_axes(case)))

    def at(self, position: Array, time: float) -> Array | None:
        """Both ends (lines, 2, 2) in the picture of bonds as short as images allow, at a time.

        A bond over an end of the box is drawn at both ends. None where there is no bond.
        """
        if not len(self.rows):
            return None
        first, last = position[self.rows[:, 0]], position[self.rows[:, 1]]
        separation = last - first
        box = self.case.box
        if box.sheared:  # images above and below have slid
            separation[:, 0] -= box.displacement(time) * np.rint(separation[:, 1] / self.lengths[1])
        separation -= np.where(self.open, 0.0, self.lengths * np.rint(separation / self.lengths))
        over = (abs(first + separation - last) > 1e-6 * self.lengths).any(axis=1)
        starts = np.concatenate([first, (last - separation)[over]])
        separations = np.concatenate([separation, separation[over]])
        return np.stack([starts, starts + separations], axis=1)[:, :, self.columns]
