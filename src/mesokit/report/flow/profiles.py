"""Profiles of a surface above a chain: heights along x at several times."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.report.flow.site_frames import PER_DECADE, SiteFrames, evenly, geometric
from mesokit.report.flow.site_picture import SitePicture
from mesokit.report.style import labelled

LINES = 6  # times in one picture
APART = 8.0  # widths of a surface
PALE, DARK = 0.3, 1.0  # of the colour map, from the first to the last time


class Profiles(SitePicture):
    """Heights at several times as steps, from pale to dark; in a film those of one time."""

    OF, HEIGHTS, TALL = (1,), True, 0.62

    def __init__(self, frames: SiteFrames) -> None:
        super().__init__(frames)
        self.ax = self.figure.subplots()
        lattice = frames.lattice
        self.edges = np.linspace(0, float(lattice.edges[0]), lattice.number + 1)
        some = [frames.at(int(k)) for k in evenly(len(frames), LINES * LINES)]
        means = [float(heights.mean()) for heights in some]
        # of surfaces that have grown far apart nothing but their means would be seen
        self.less = max(means) - min(means) > APART * max(float(h.std()) for h in some)
        some = [self._shown(heights) for heights in some]
        low, high = min(h.min() for h in some), max(h.max() for h in some)
        room = 0.05 * max(high - low, 1)
        self.ax.set(xlim=(0, self.edges[-1]), ylim=(low - room, high + room))
        self.ax.set_xlabel(labelled("x", "a"))
        what = "height less its mean $h - \\langle h \\rangle$" if self.less else "height $h$"
        self.ax.set_ylabel(labelled(what, "a"))

    def still(self) -> None:
        """Draw lines of several times, which a legend names from the last, the highest, down."""
        frames = self.frames
        wanted = evenly(len(frames), LINES)
        if frames.view.time == "log":
            every = geometric(frames.time, PER_DECADE)
            wanted = every[evenly(len(every), LINES)]
        from matplotlib import colormaps

        shades = colormaps["cividis_r"](np.linspace(PALE, DARK, len(wanted)))
        for row, colour in zip(wanted, shades, strict=True):
            self._line(int(row), color=colour, label=frames.title(int(row)))
        handles, labels = self.ax.get_legend_handles_labels()
        beside = {"loc": "center left", "bbox_to_anchor": (1.01, 0.5), "borderaxespad": 0.0}
        self.ax.legend(handles[::-1], labels[::-1], fontsize=8, handlelength=1.2, **beside)

    def show(self, index: int) -> None:
        for line in list(self.ax.lines):
            line.remove()
        self._line(index, color="black")
        self.ax.set_title(self.frames.title(index))

    def _shown(self, heights: NDArray[Any]) -> NDArray[Any]:
        return heights - heights.mean() if self.less else heights

    def _line(self, index: int, **style: Any) -> None:
        heights = self._shown(self.frames.at(index))
        steps = np.append(heights, heights[-1])  # from the first edge of each site to its last
        self.ax.step(self.edges, steps, where="post", lw=0.9, **style)
