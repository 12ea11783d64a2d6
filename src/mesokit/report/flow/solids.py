"""The solids of a case, drawn over a picture as a section through them."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mesokit.case.box import AXES
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import solids_left
from mesokit.report.caption import in_cells
from mesokit.report.flow.data import Array
from mesokit.report.flow.region import Region
from mesokit.seam.method import method_of

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.geometry.solids.solids import Solids
    from mesokit.seam.method import Plate

POINTS = 600  # along the longer side of a picture
BEYOND = 0.02, 0.08  # of the longer and the shorter side: the strip of a plate that is shown
FILL, EDGE, HATCH = "0.85", "black", "////"


def solids_of(case: Case) -> Solids | None:
    found: Solids | None = method_of(case).enclosure.solids(case)
    return found


class Section:
    """The plane of a picture: two axes of the box, and a place `at` along the third.

    Raises CaseError for a place that the box has not. Without a case nothing is known of solids.
    """

    third: int | None = None

    def __init__(self, case: Case | None, axes: tuple[str, str], at: float | None = None) -> None:
        self.solids: Solids | None = None
        if case is None:
            return
        self.case, self.solids = case, solids_of(case)
        self.columns = [case.box.axes.index(axis) for axis in axes]
        self.third = next((k for k in range(case.box.dimension) if k not in self.columns), None)
        if self.third is None:
            if at is not None:
                raise CaseError(f"at = {show(at)}: a 2D box has no third axis; leave it out")
            return
        length = case.box.size[self.third]
        self.at = length / 2 if at is None else at
        if not 0 <= self.at <= length:
            raise CaseError(
                f"at = {show(at)}: expected a place along {AXES[self.third]}, from 0 to {length}"
            )

    @property
    def plane(self) -> float | None:
        """The place along the third axis, None in 2D."""
        return None if self.third is None else self.at

    def note(self, how: str = "mean") -> str:
        """Caption of a 3D picture: a mean along the third axis, but a cut of the solids."""
        if self.third is None:
            return ""
        axis = AXES[self.third]
        at = f"; solids at ${axis} = {self.at:g}{in_cells()}$"
        return f"{how} along ${axis}$" + at * bool(self.solids)

    @cached_property
    def opens(self) -> bool:
        """Whether a solid is taken away in time."""
        return self.solids is not None and any(wall.opens is not None for wall in self.case.walls)

    def distance(
        self, x: Array, y: Array, plates: tuple[Plate, ...] = (), time: float | None = None
    ) -> Array:
        """Signed distance from the nearest surface at points of the plane, negative in a solid;
        `plates` are not where they are at rest, and some solids may be taken away at a time."""
        solids = self.solids
        if time is not None and self.opens:
            solids = solids_left(self.case, time)
        if solids is None:
            return np.full(x.shape, np.inf)
        points = np.zeros((x.size, self.case.box.dimension))
        points[:, self.columns] = np.stack([x.ravel(), y.ravel()], axis=1)
        if self.third is not None:
            points[:, self.third] = self.at
        found: Array = np.asarray(solids.distance(points))
        for plate in plates:
            found = plate.moved(points, found)
        return found.reshape(x.shape)

    def closed(self) -> tuple[bool, bool]:
        """Whether a solid closes the box along each axis: all beyond its end is solid."""
        if self.solids is None:
            return False, False
        found = []
        for axis in range(2):
            length = self.case.box.size[self.columns[1 - axis]]
            along = np.linspace(0, length, 2 * math.ceil(length) + 1)
            x, y = (np.full_like(along, -0.25), along)[:: 1 - 2 * axis]
            found.append(bool((self.distance(x, y) < 0).all()))
        return found[0], found[1]

    def view(self, region: Region) -> Region:
        """The region, and a strip of each plate that it touches."""
        strip = min(BEYOND[0] * max(region.extent), BEYOND[1] * min(region.extent))
        low, high = list(region.low), list(region.high)
        for axis, closed in enumerate(self.closed()):
            if closed and low[axis] == 0:
                low[axis] -= strip
            if closed and high[axis] == self.case.box.size[self.columns[axis]]:
                high[axis] += strip
        return Region((low[0], low[1]), (high[0], high[1]))

    def draw(
        self, ax: Any, view: Region, plates: tuple[Plate, ...] = (), time: float | None = None
    ) -> None:
        """Fill and outline what is solid in the view at a time; `plates` are not where they are at
        rest."""
        if self.solids is None:
            return
        step = max(view.extent) / POINTS
        x, y = (
            np.linspace(a, b, max(2, round((b - a) / step) + 1))
            for a, b in zip(view.low, view.high, strict=True)
        )
        distance = self.distance(*np.meshgrid(x, y), plates, time)
        if not (distance < 0).any():
            return
        filled = ax.contourf(x, y, distance, [-np.inf, 0], colors=[FILL], hatches=[HATCH], zorder=4)
        filled.set_edgecolor("0.55")
        filled.set_linewidth(0)
        if (distance > 0).any():
            ax.contour(x, y, distance, [0], colors=EDGE, linewidths=1.2, zorder=5)
