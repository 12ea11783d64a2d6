"""Force chains: a line between the centres of two grains that touch, as wide as their force.

Disks are drawn to scale below. In space there are lines alone, paler towards the back. A line to a
wall ends at it. A contact that pulls is a dashed line.
"""

from typing import Any

import numpy as np

from mesokit.report.caption import rounded, symbols
from mesokit.report.flow.data import Array, Flow, Links
from mesokit.report.flow.disks import EDGE, EDGED, MANY, RIM
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale, inches_of, points_of

NEEDS = "contacts"
TITLE = "force chains"
LARGE = 5.0  # mean forces that the reach is
WIDE = 0.75  # of a mean diameter: the line of such a force
WIDEST = 1.0  # of a mean diameter: no line is wider
THIN = 0.35  # of these widths in space, where lines lie before others
FILL, EDGE_COLOUR = "#dde5ee", "0.55"  # of disks
LINE, PULL = "#12284c", "#c2410c"  # of lines, by the sign of the force
LAYERS, PALE = 6, 0.7  # of depth in space; part of white at the back
KEY, ABOVE, LEFT = 0.35, 0.14, -0.6  # inches: length and place of the key; where narrow ones start
NARROW, SLIM = 3.2, 2.0  # inches: panels whose key starts outside, and has two lines
FORCE = "m a/tau^2"


def reach(flow: Flow, region: Region) -> float:
    """Some mean forces of a contact; where few touch, the sum is shared by all grains."""
    links, spheres = _links(flow), flow.spheres
    assert spheres is not None
    inside = region.holds(links.ends[:, 0])
    count = max(int(inside.sum()), int(region.holds(spheres.places).sum()))
    return LARGE * float(np.abs(links.forces[inside]).sum()) / max(count, 1) or 1.0


def scale(flow: Flow, reach: float) -> Scale | None:
    """None: widths have a key of their own."""
    return None


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw disks, lines and the key of their widths."""
    spheres, links = flow.spheres, _links(flow)
    assert spheres is not None
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    rows, places = spheres.seen((left, low), (right, high))
    mean = float(spheres.diameters.mean()) if len(spheres.diameters) else 1.0
    unit = mean if spheres.depth is None else THIN * mean
    if spheres.depth is None:
        _disks(ax, places, spheres.diameters[rows])
    ends, which = _seen(links, spheres.repeats, (left, low), (right, high), mean)
    _lines(ax, links, ends, which, widths(links.forces, reach, unit))
    _key(ax, links, reach, unit)


def widths(forces: Array, reach: float, unit: float) -> Array:
    """Widths (m,) of lines, in lengths of the picture; `unit`: the widest.

    >>> widths(np.array([1.0, -1.0, 100.0]), 5.0, 2.0)
    array([0.3, 0.3, 2. ])
    """
    return np.asarray(np.minimum(WIDE * np.abs(forces) / reach, WIDEST) * unit)


def _links(flow: Flow) -> Links:
    assert flow.spheres is not None and flow.spheres.links is not None
    return flow.spheres.links()


def _disks(ax: Any, places: Array, diameters: Array) -> None:
    """Pale disks with thin edges."""
    from matplotlib.collections import EllipseCollection

    size = points_of(ax) * float(diameters.mean()) if len(diameters) else 0.0
    rim = min(EDGE * size, RIM) if size >= EDGED else 0.0
    look: Any = {"units": "xy", "offsets": places, "offset_transform": ax.transData}
    look |= {"facecolors": FILL, "edgecolors": EDGE_COLOUR, "rasterized": len(places) > MANY}
    disks = EllipseCollection(diameters, diameters, 0 * diameters, linewidths=rim, zorder=2, **look)
    ax.add_collection(disks, autolim=False)


def _seen(
    links: Links, repeats: Any, low: tuple[float, float], high: tuple[float, float], margin: float
) -> tuple[Array, Any]:
    """Ends (k, 2, 2) of all lines in view, images included, and their numbers (k,)."""
    found, which = [], []
    for shift in repeats:
        ends = links.ends + np.array(shift)
        over = (ends.max(axis=1) > np.array(low) - margin).all(axis=1)
        near = over & (ends.min(axis=1) < np.array(high) + margin).all(axis=1)
        found.append(ends[near])
        which.append(np.flatnonzero(near))
    return np.concatenate(found), np.concatenate(which)


def _lines(ax: Any, links: Links, ends: Array, which: Any, wide: Array) -> None:
    """The lines, those at the back first and paler."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import to_rgb

    forces, wide = links.forces[which], points_of(ax) * wide[which]
    layers = np.minimum((links.nearness[which] * LAYERS).astype(int), LAYERS - 1)
    for layer in np.unique(layers):
        pale = PALE * (1 - (layer + 1) / LAYERS)
        for colour, style, sign in ((LINE, "solid", 1), (PULL, (0, (1.5, 1.0)), -1)):
            own = (layers == layer) & (np.where(forces < 0, -1, 1) == sign)
            shade = tuple(x + (1 - x) * pale for x in to_rgb(colour))
            look: Any = {"colors": [shade], "linewidths": wide[own], "linestyles": [style]}
            look |= {"capstyle": "round" if sign > 0 else "butt", "rasterized": len(ends) > MANY}
            ax.add_collection(LineCollection(list(ends[own]), zorder=3, **look), autolim=False)


def _key(ax: Any, links: Links, reach: float, unit: float) -> None:
    """A line as wide as the mean force, and that force, above the panel."""
    width, height = inches_of(ax)
    pushing = links.forces[links.forces > 0]
    text, start, space = "no contacts", LEFT * (width < NARROW), "\n" if width < SLIM else " "
    if not len(pushing):
        start -= KEY
    else:
        mean = float(pushing.mean())
        text = f"mean normal force{space}${rounded(mean, 3)}$ {symbols(FORCE)}"
        wide = float(widths(np.array([mean]), reach, unit)[0]) * points_of(ax)
        ends = np.array([start, start + KEY]) / width
        look: Any = {"lw": wide, "solid_capstyle": "butt", "clip_on": False}
        above = [1 + ABOVE / height] * 2
        ax.plot(ends, above, color=LINE, transform=ax.transAxes, zorder=4, **look)
    if (links.forces < 0).any():
        text += "; dashed: pull"
    at: Any = {"transform": ax.transAxes, "va": "center", "size": 8 if width < NARROW else 9}
    ax.text((start + KEY + 0.08) / width, 1 + ABOVE / height, text, **at)
