"""An oblique view from the front, the right and above, with parallel rays, and axes of a box in it.

Parallel rays keep ratios of lengths along each direction, so that numbers can be read off the axes.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.report.flow.data import Array
from mesokit.report.style import labelled

TURN, RISE = math.radians(35), math.radians(32)  # of the eye: to the right of -y, above the plane
# points from an axis: end of a tick, its number, the name; and how much more of that along z
TICK, LETTERS, NAME, FARTHER = 4.0, 7.0, 25.0, 8.0
ROOM = 0.02, 0.14, 0.1  # of the picture: beyond the box, on the left and below for numbers
MANY, FLAT = 5, 0.25  # ticks; height over the longest side, below which there are two
RIGHT = np.array([math.cos(TURN), math.sin(TURN), 0.0])
UP = np.array([-math.sin(TURN) * math.sin(RISE), math.cos(TURN) * math.sin(RISE), math.cos(RISE)])
TOWARDS = np.cross(RIGHT, UP)  # the eye


def projected(points: Array) -> Array:
    """Places (n, 2) in the picture of points (n, 3)."""
    found: Array = np.asarray(points) @ np.stack([RIGHT, UP], axis=1)
    return found


def depth(points: Array) -> Array:
    """How near (n,) points (n, 3) are to the eye."""
    found: Array = np.asarray(points) @ TOWARDS
    return found


class Box:
    """A box between two corners, (3,) each, with axes along its lower front edges and its left one.

    `names` of the axes; `number` turns a place along z into the number at its tick.
    """

    def __init__(
        self,
        low: Array,
        high: Array,
        names: tuple[str, str, str] = ("x", "y", "z"),
        number: Callable[[float], float] = float,
        place: Callable[[float], float] = float,
    ) -> None:
        self.low, self.high, self.names = np.asarray(low, float), np.asarray(high, float), names
        self.number, self.place = number, place

    def corner(self, x: int, y: int, z: int) -> NDArray[np.float64]:
        """One of the corners: 0 for the low end of an axis, 1 for the high one."""
        return np.where([x, y, z], self.high, self.low)

    def frame(self, ax: Any, behind: bool) -> None:
        """Draw the edges behind what is in the box, or those before it."""
        near = self.corner(1, 0, 0), self.corner(1, 0, 1)
        hidden = self.corner(0, 1, 0)
        for axis in range(3):
            for other in range(4):
                ends = np.zeros((2, 3), int)
                ends[1, axis] = 1
                rest = [k for k in range(3) if k != axis]
                ends[:, rest[0]], ends[:, rest[1]] = divmod(other, 2)
                line = np.array([self.corner(*end) for end in ends])
                back = (line == hidden).all(axis=1).any()
                front = any((point == corner).all() for point in line for corner in near[1:])
                if behind != front:
                    look = {"color": "0.6" if back else "0.3", "lw": 0.6, "zorder": 1 + 2 * front}
                    ax.plot(*projected(line).T, **look)

    def axes(self, ax: Any) -> None:
        """Draw ticks, numbers and names of the axes."""
        edges = [
            (self.corner(0, 0, 0), self.corner(1, 0, 0), -np.eye(3)[1]),
            (self.corner(1, 0, 0), self.corner(1, 1, 0), np.eye(3)[0]),
            (self.corner(0, 0, 0), self.corner(0, 0, 1), -RIGHT),
        ]
        line = {"arrowstyle": "-", "lw": 0.7, "shrinkA": 0, "shrinkB": 0}
        offset: Any = {"textcoords": "offset points", "annotation_clip": False}
        for axis, (start, end, outward) in enumerate(edges):
            out = projected(outward[None])[0]
            out = out / np.hypot(*out)
            turned = axis == 2
            beside: Any = {"ha": _side(out[0]), "va": _level(out[1])}
            for place, text in self._ticks(axis):
                point = np.where(np.arange(3) == axis, place, start)
                here = projected(point[None])[0]
                ax.annotate("", here, xytext=out * TICK, arrowprops=line, **offset)
                ax.annotate(text, here, xytext=out * LETTERS, fontsize="small", **beside, **offset)
            middle = projected(0.5 * (start + end)[None])[0]
            if turned:
                beside = {"ha": "center", "va": "center", "rotation": 90}
            name = labelled(self.names[axis], "a")
            ax.annotate(name, middle, xytext=out * (NAME + FARTHER * turned), **beside, **offset)

    def _ticks(self, axis: int) -> list[tuple[float, str]]:
        """Places along an axis, and the numbers there."""
        from matplotlib.ticker import MaxNLocator

        low, high = self.low[axis], self.high[axis]
        if axis == 2:
            low, high = self.number(low), self.number(high)
        slack = 1e-9 * (high - low)
        sides = self.high - self.low
        flat = axis == 2 and sides[2] < FLAT * sides.max()  # little room for numbers
        found = MaxNLocator(2 if flat else MANY, steps=[1, 2, 5, 10]).tick_values(low, high)
        inside = [float(x) for x in found if low - slack <= x <= high + slack]
        return [(self.place(x) if axis == 2 else x, f"{x:g}".replace("-", "−")) for x in inside]

    def fit(self, ax: Any) -> None:
        """Limits of the axes that hold all of it."""
        corners = [self.corner(*divmod(k // 2, 2), k % 2) for k in range(8)]
        flat = projected(np.array(corners))
        low, high = flat.min(axis=0), flat.max(axis=0)
        room, left, below = (part * float((high - low).max()) for part in ROOM)
        ax.set(xlim=(low[0] - left, high[0] + room), ylim=(low[1] - below, high[1] + room))
        ax.set_aspect("equal")
        ax.set_axis_off()


def _side(across: float) -> str:
    return "right" if across < -0.3 else "left" if across > 0.3 else "center"


def _level(up: float) -> str:
    return "top" if up < -0.3 else "bottom" if up > 0.3 else "center"
