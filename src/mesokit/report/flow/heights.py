"""Oblique view of a surface: a column at each site of a plane, as high as the surface is there."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.report.flow.data import Array
from mesokit.report.flow.oblique import TOWARDS, Box, projected
from mesokit.report.flow.palette import deviations
from mesokit.report.flow.site_frames import SiteFrames, evenly
from mesokit.report.flow.site_map import SiteMap
from mesokit.report.flow.site_picture import SitePicture
from mesokit.report.style import labelled

MOST = 256  # columns along an axis: of more, some are left out evenly
PART = 0.22  # of the longer side, which the highest column nearly has
SHADES = np.array([1.0, 0.7, 0.48])  # of tops, fronts and right sides
SAMPLES = 24  # frames that the range of heights is taken from


class Heights(SitePicture):
    """Heights less their mean, as columns lit from the left; light ones are high."""

    OF, HEIGHTS, TALL = (2,), True, 0.72

    def __init__(self, frames: SiteFrames) -> None:
        super().__init__(frames)
        self.map = SiteMap(frames.lattice, (0, 1), None, MOST)
        some = [self._away(int(k)) for k in evenly(len(frames), SAMPLES)]
        self.low = float(np.floor(min(away.min() for away in some)))
        self.high = float(np.ceil(max(away.max() for away in some)))
        self.high = max(self.high, self.low + 1)
        sides = np.array(self.map.size)
        self.factor = _exaggeration(PART * float(sides.max()) / (self.high - self.low))
        self.ax = self.figure.subplots()
        self.drawn_as = rf"heights $\times\,{self.factor:g}$" * (self.factor != 1)
        self.box = Box(
            np.zeros(3),
            np.array([*sides, self.factor * (self.high - self.low)]),
            ("x", "y", "height"),
            lambda z: z / self.factor + self.low,
            lambda number: (number - self.low) * self.factor,
        )
        self.box.fit(self.ax)
        self.box.frame(self.ax, behind=True)
        self.box.axes(self.ax)
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize

        self.colours = ScalarMappable(Normalize(self.low, self.high), "cividis")
        label = labelled("height less its mean", "a")
        self.figure.colorbar(self.colours, ax=self.ax, shrink=0.7, aspect=30, label=label)
        self.drawn: Any = None

    def _away(self, index: int) -> Array:
        """Heights of the columns less the mean of all sites."""
        away, _ = deviations(self.frames.at(index)[None])
        return self.map.of(away[0])

    def show(self, index: int) -> None:
        from matplotlib.collections import PolyCollection

        if self.drawn is not None:
            self.drawn.remove()
        away = self._away(index)
        corners, column, side = faces(
            (away - self.low).clip(0.0) * self.factor, self.map.steps(away.shape)
        )
        fills = self.colours.to_rgba(away.ravel())[:, :3][column] * SHADES[side][:, None]
        look = {"facecolors": fills, "edgecolors": fills, "linewidths": 0.15, "zorder": 2}
        flat = projected(corners.reshape(-1, 3)).reshape(-1, 4, 2)
        self.drawn = self.ax.add_collection(
            PolyCollection(list(flat), rasterized=True, **look), False
        )
        mean = float(self.frames.at(index).mean())
        words = [self.frames.title(index), f"mean height {mean:.4g}", self.drawn_as]
        self.ax.set_title(", ".join(filter(None, words)))


def faces(
    heights: Array, steps: tuple[float, float]
) -> tuple[Array, NDArray[np.int64], NDArray[np.int64]]:
    """Faces of columns that can be seen, from the back to the front.

    Returns corners (faces, 4, 3), the number of the column of each (faces,), and which side it is:
    0 the top, 1 the front (towards -y), 2 the right one (towards +x).

    >>> corners, column, side = faces(np.array([[1.0, 2.0]]), (1.0, 1.0))
    >>> sorted(zip(column.tolist(), side.tolist()))  # the second stands behind the first
    [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)]
    >>> front = corners[(column == 1) & (side == 1)][0]
    >>> float(front[:, 2].min()), float(front[:, 2].max())  # what stands out above the first
    (1.0, 2.0)
    """
    # Each column hides only what stands behind it, and is drawn after that: sorted by the depth of
    # the column, faces cover one another rightly.
    nx, ny = heights.shape
    i, j = (a.ravel() for a in np.indices((nx, ny)))
    high = heights.ravel()
    x, y = i * steps[0], j * steps[1]
    right, back = x + steps[0], y + steps[1]
    before = np.pad(heights, ((0, 0), (1, 0)))[:, :-1].ravel()  # the floor before the first
    beside = np.pad(heights, ((0, 1), (0, 0)))[1:].ravel()
    left_front, right_front = [(a, y, high) for a in (x, right)]
    right_back = (right, back, high)
    shapes = [
        (high > -np.inf, [left_front, right_front, right_back, (x, back, high)]),
        (high > before, [(x, y, before), (right, y, before), right_front, left_front]),
        (high > beside, [(right, y, beside), (right, back, beside), right_back, right_front]),
    ]
    corners, columns, sides = [], [], []
    for side, (seen, points) in enumerate(shapes):
        chosen = np.flatnonzero(seen)
        corners.append(np.stack([np.stack(p, axis=1)[chosen] for p in points], axis=1))
        columns.append(chosen)
        sides.append(np.full(len(chosen), side))
    column, near = np.concatenate(columns), x * TOWARDS[0] + y * TOWARDS[1]
    order = np.argsort(near[column], kind="stable")
    return np.concatenate(corners)[order], column[order], np.concatenate(sides)[order]


def _exaggeration(largest: float) -> float:
    """The largest of ..., 0.5, 1, 2, 5, 10, ... that is not above a number.

    >>> _exaggeration(7.0), _exaggeration(1.0), _exaggeration(0.3)
    (5.0, 1.0, 0.2)
    """
    power = 10.0 ** np.floor(np.log10(largest) + 1e-9)
    return float(max(m * power for m in (1, 2, 5) if m * power <= largest * (1 + 1e-9)))
