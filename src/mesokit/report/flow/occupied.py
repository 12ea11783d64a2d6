"""Oblique view of the sites of a lattice in space that are in some states, as balls."""

from typing import Any

import numpy as np

from mesokit.report.flow.oblique import Box, depth, projected
from mesokit.report.flow.scale import inches_of
from mesokit.report.flow.shaded import Balls, shaded
from mesokit.report.flow.site_frames import SiteFrames
from mesokit.report.flow.site_picture import SitePicture

DPI = 300
RADIUS = 0.5  # neighbours touch
LIGHTEST, DARKEST = 0.92, 0.3  # of the colour map


class Occupied(SitePicture):
    """All states but the first, which is the empty one, unless some are chosen."""

    OF, HEIGHTS, TALL = (3,), False, 0.9

    def __init__(self, frames: SiteFrames) -> None:
        super().__init__(frames)
        from matplotlib import colormaps
        from matplotlib.lines import Line2D

        self.states = frames.chosen()
        self.places = frames.lattice.places()
        self.box = Box(self.places.min(axis=0) - RADIUS, self.places.max(axis=0) + RADIUS)
        shades = np.linspace(LIGHTEST, DARKEST, max(2, len(self.states)))[: len(self.states)]
        self.fills = colormaps["cividis"](shades)[:, :3]
        self.ax = self.figure.subplots()
        self.box.fit(self.ax)
        self.box.frame(self.ax, behind=True)
        self.box.frame(self.ax, behind=False)
        self.box.axes(self.ax)
        look: Any = {"marker": "o", "ls": "", "ms": 7, "mec": "0.3", "mew": 0.5}
        marks = [Line2D([], [], color=fill, **look) for fill in self.fills]
        names = [frames.names[state] for state in self.states]
        self.figure.legend(marks, names, loc="outside right upper", frameon=False)
        corners = np.array([self.box.corner(*divmod(k // 2, 2), k % 2) for k in range(8)])
        near = depth(corners)
        self.room = float(near.min()), float(near.max())
        self.drawn = self.ax.imshow(np.zeros((1, 1, 4)), zorder=2)
        self.box.fit(self.ax)

    def show(self, index: int) -> None:
        states = self.frames.at(index).ravel()
        rows = np.flatnonzero(np.isin(states, self.states))
        places, kinds = self.places[rows], np.searchsorted(self.states, states[rows])
        (left, right), (low, high) = self.ax.get_xlim(), self.ax.get_ylim()
        radii = np.full(len(rows), RADIUS)
        balls = Balls(projected(places), depth(places), radii, self.fills[kinds], self.room)
        dots = inches_of(self.ax)[0] * DPI / (right - left)
        image = shaded(balls, (left, low), (right, high), dots)
        self.drawn.remove()
        extent = (left, right, low, high)
        self.drawn = self.ax.imshow(image, origin="lower", extent=extent, zorder=2)
        self.ax.set(xlim=(left, right), ylim=(low, high))
        share = f"{len(rows)} of {len(states)} sites"
        self.ax.set_title(f"{self.frames.title(index)}, {share}")
