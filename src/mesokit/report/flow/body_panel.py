"""Bodies to scale: filled outlines over the flow, and in space shaded ones, before one another."""

from typing import Any

import numpy as np

from mesokit.report.flow.data import Bodies, Flow
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import inches_of
from mesokit.report.flow.shaded_parts import shaded_parts

NEEDS = "bodies"
TITLE = "bodies"
FILLS = (
    "#f0dfae",
    "#dd8f45",
    "#9a5bb0",
    "#3b4a6b",
)  # of kinds (as many as `COLOURS`), far apart in grey
DARK = 2  # from which fill on arrows are white
EDGE, HALO = 0.9, 0.7  # points: of edges, and of white around them, for dark maps
TRACE = 0.7  # points
ABOVE = 5.5  # the solids, below beads
DPI = 200  # of an image of bodies, as figures are saved


def reach(flow: Flow, region: Region) -> float:
    """Nothing is measured."""
    return 1.0


def scale(flow: Flow, reach: float) -> None:
    """No colours of numbers."""


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw them alone, in 3D shaded."""
    from matplotlib.colors import to_rgb

    assert flow.bodies is not None
    if flow.bodies.placed is None:
        draw_over(ax, flow.bodies)
        return
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    dots, corners = inches_of(ax)[0] * DPI / (right - left), ((left, low), (right, high))
    colours = np.array([to_rgb(colour) for colour in FILLS])
    _traces(ax, flow.bodies, 1.5)
    image = shaded_parts(flow.bodies.placed(), colours, flow.bodies.room, *corners, dots)
    ax.imshow(image, origin="lower", extent=(left, right, low, high), zorder=2)


def draw_over(ax: Any, bodies: Bodies) -> None:
    """Fill and outline them, and show where those that swim are headed."""
    from matplotlib.collections import PathCollection
    from matplotlib.path import Path

    _traces(ax, bodies, ABOVE + 0.05)
    if not bodies.outlines:
        return
    paths = [Path.make_compound_path(*map(Path, lines)) for lines in bodies.outlines]
    halo: Any = {"facecolors": "none", "edgecolors": "white", "linewidths": EDGE + 2 * HALO}
    ax.add_collection(PathCollection(paths, zorder=ABOVE - 0.1, **halo), autolim=False)
    fills = [fill(int(kind)) for kind in bodies.kinds]
    look: Any = {"facecolors": fills, "edgecolors": "black", "linewidths": EDGE, "zorder": ABOVE}
    ax.add_collection(PathCollection(paths, **look), autolim=False)
    if len(bodies.arrows):
        tails, tips = bodies.arrows[:, 0], bodies.arrows[:, 1]
        away = tips - tails
        long = float(np.hypot(*away.T).max())
        units = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "units": "xy"}
        shape = {"width": 0.09 * long, "headlength": 4.0, "headaxislength": 3.5, "minlength": 0.0}
        inks = ["white" if kind % len(FILLS) >= DARK else "black" for kind in bodies.swimmers]
        ax.quiver(*tails.T, *away.T, color=inks, zorder=ABOVE + 0.1, **units, **shape)


def _traces(ax: Any, bodies: Bodies, above: float) -> None:
    """The paths of their centres."""
    from matplotlib.collections import LineCollection

    for colour, width in (("white", TRACE + HALO), ("black", TRACE)):
        look: Any = {"colors": colour, "linewidths": width, "zorder": above}
        ax.add_collection(LineCollection(list(bodies.traces), **look), autolim=False)


def fill(kind: int) -> str:
    """Colour of a kind."""
    return FILLS[kind % len(FILLS)]


def keys(bodies: Bodies) -> tuple[list[Any], list[str]]:
    """Marks of a legend of the kinds, and their names."""
    from matplotlib.lines import Line2D

    look: Any = {"ls": "", "marker": "o", "ms": 6, "mec": "black", "mew": EDGE}
    names = list(bodies.names)
    kinds = bodies.shown if names else ()
    return [Line2D([], [], color=fill(kind), **look) for kind in kinds], names
