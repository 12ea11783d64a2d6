"""Disks to scale, in colours of what they do; in 3D spheres, shaded and one before the other."""

from typing import Any

import numpy as np

from mesokit.report.flow.data import Array, Flow, Spheres
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale, inches_of, points_of, reach_of
from mesokit.report.flow.shaded import Balls, shaded

NEEDS = "spheres"
TITLE = "spheres"
MANY = 5000  # disks, beyond which a vector file holds an image of them
EDGED = 4.0  # points of a mean diameter, from which on disks have an edge
EDGE, RIM = 0.04, 0.6  # its width, of the diameter; points at most
SIGNED = 9.0  # points of a mean diameter, from which on disks show which way they turn
MARK = 0.22  # of the diameter: the size of that mark
PLAIN = "#7d9cc0"  # of all, where colours mean nothing
DPI = 200  # of an image of spheres, as figures are saved


def reach(flow: Flow, region: Region) -> float:
    """The largest number of a sphere in the region."""
    spheres = _of(flow)
    values = spheres.values[region.holds(spheres.places)]
    return float(values.max(initial=1.0)) if spheres.counted else reach_of(values)


def scale(flow: Flow, reach: float) -> Scale | None:
    """The scale of the numbers; none where all spheres have one colour."""
    spheres = _of(flow)
    return None if spheres.scale is None else spheres.scale(reach)


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw the spheres in view, images over the edges of a periodic box included."""
    from matplotlib.colors import to_rgb

    spheres, colours = _of(flow), scale(flow, reach)
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    rows, places = spheres.seen((left, low), (right, high))
    fills: Any = np.tile(to_rgb(PLAIN), (len(rows), 1))
    if colours is not None:
        fills = colours.mappable().to_rgba(spheres.values[rows])[:, :3]
    if spheres.depth is None:
        _flat(ax, places, spheres.diameters[rows], fills)
        if colours is not None and colours.low < 0 and not colours.names:
            _turning(ax, places, spheres.diameters[rows], spheres.values[rows] / reach)
        return
    balls = Balls(places, spheres.depth[rows], 0.5 * spheres.diameters[rows], fills, spheres.room)
    dots = inches_of(ax)[0] * DPI / (right - left)
    image = shaded(balls, (left, low), (right, high), dots)
    ax.imshow(image, origin="lower", extent=(left, right, low, high), zorder=2)


def _of(flow: Flow) -> Spheres:
    assert flow.spheres is not None
    return flow.spheres


def _flat(ax: Any, places: Array, diameters: Array, fills: Any) -> None:
    """Disks in units of the axes, with edges where these would not hide them."""
    from matplotlib.collections import EllipseCollection

    size = points_of(ax) * float(diameters.mean()) if len(diameters) else 0.0
    look: Any = {"units": "xy", "offsets": places, "offset_transform": ax.transData}
    look |= {"facecolors": fills, "edgecolors": "black", "rasterized": len(places) > MANY}
    rim, angles = min(EDGE * size, RIM) if size >= EDGED else 0.0, np.zeros(len(diameters))
    disks = EllipseCollection(diameters, diameters, angles, linewidths=rim, zorder=2, **look)
    ax.add_collection(disks, autolim=False)


def _turning(ax: Any, places: Array, diameters: Array, turning: Array) -> None:
    """Mark disks that turn counterclockwise by a dot and others by a cross, for pictures in grey.

    Disks that turn by less than a tenth of the scale have no mark.
    """
    size = points_of(ax) * float(diameters.mean()) if len(places) else 0.0
    if size < SIGNED:
        return
    for marker, which in ((".", turning > 0.1), ("x", turning < -0.1)):
        ax.plot(*places[which].T, marker, color="black", ms=MARK * size, mew=0.05 * size, zorder=3)
