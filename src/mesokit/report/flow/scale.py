"""Colours of a picture: their range and meaning, and bins drawn in them."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mesokit.report.flow.data import Array, Flow, spacing
from mesokit.report.flow.region import Region

ENOUGH = 99.5  # percent of the bins that the colours span; the few beyond are noise


@dataclass(frozen=True)
class Scale:
    """Colours (a name or a map of Matplotlib) from `low` to `high`, and what they show.

    `names`: of whole numbers from 0, each of which has a colour of its own. `logarithmic`: numbers
    below `low` have the colour of `low`.
    """

    low: float
    high: float
    colours: Any
    label: str
    names: tuple[str, ...] = ()
    logarithmic: bool = False

    def mappable(self) -> Any:
        """The object from which Matplotlib draws a colour bar."""
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import LogNorm, Normalize

        if self.logarithmic:
            return ScalarMappable(LogNorm(self.low, self.high, clip=True), self.colours)
        return ScalarMappable(Normalize(self.low, self.high), self.colours)


def reach_of(values: Array) -> float:
    """The size that nearly all of the values keep within, 1 where there are none or all are 0."""
    finite = abs(values[np.isfinite(values)])
    return float(np.percentile(finite, ENOUGH)) or 1.0 if len(finite) else 1.0


def inches_of(ax: Any) -> tuple[float, float]:
    """Width and height of axes, in inches."""
    (width, height), box = ax.figure.get_size_inches(), ax.get_position()
    return float(box.width * width), float(box.height * height)


def points_of(ax: Any) -> float:
    """Points of a length of 1 along the first axis."""
    return float(72.0 * inches_of(ax)[0] / np.ptp(ax.get_xlim()))


def heat_map(ax: Any, flow: Flow, values: Array, region: Region, scale: Scale) -> None:
    """Colour the bins of `values` (nx, ny) that overlap with the region; nan stays white."""
    x, y = region.bins(flow.size, values.shape)
    dx, dy = spacing(flow, values)
    extent = (x.start * dx, x.stop * dx, y.start * dy, y.stop * dy)
    look = {"cmap": scale.colours, "vmin": scale.low, "vmax": scale.high}
    ax.imshow(values[x, y].T, origin="lower", extent=extent, interpolation="nearest", **look)
