"""Space-time diagram of a chain: sites across, time downwards."""

import numpy as np

from mesokit.report.flow.palette import colours, deviations, named_bar
from mesokit.report.flow.site_frames import SiteFrames, evenly
from mesokit.report.flow.site_picture import SitePicture
from mesokit.report.style import labelled

MOST = 2000  # rows: frames beyond are left out evenly


class SpaceTime(SitePicture):
    """States of a chain as colours; of heights their deviation from the mean at each time."""

    OF, HEIGHTS, MOVES, TALL = (1,), None, False, 1.1

    def __init__(self, frames: SiteFrames) -> None:
        super().__init__(frames)
        ax = self.figure.subplots()
        rows = evenly(len(frames), MOST)
        states = np.array([frames.at(int(row)) for row in rows])
        time, length = frames.time[rows], float(frames.lattice.edges[0])
        step = time[-1] - time[-2] if len(time) > 1 else 1.0
        edges = np.append(time, time[-1] + step)  # a row lasts until the next
        across = np.linspace(0, length, states.shape[1] + 1)
        if frames.names:
            number = len(frames.names)
            look = {"cmap": colours(number), "vmin": -0.5, "vmax": number - 0.5}
            drawn = ax.pcolormesh(across, edges, states, rasterized=True, **look)
            named_bar(self.figure, drawn, ax, frames.names)
        else:
            away, reach = deviations(states)
            look = {"cmap": "cividis", "vmin": -reach, "vmax": reach}
            drawn = ax.pcolormesh(across, edges, away, rasterized=True, **look)
            self.figure.colorbar(drawn, ax=ax, label=labelled("height less its mean", "a"))
        ax.set(xlim=(0, length), ylim=(edges[-1], edges[0]))
        ax.set_xlabel(labelled("x", "a"))
        ax.set_ylabel(labelled("time $t$", "tau"))
        ax.tick_params(direction="out", top=False, right=False)
        first, last = frames.title(0), frames.title(len(frames) - 1)
        ax.set_title(f"{first} to {last}" if len(frames) > 1 else first)
