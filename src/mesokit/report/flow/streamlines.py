"""Lines along the velocity, darker where it is high."""

from __future__ import annotations

from typing import Any

import numpy as np

from mesokit.report.flow import speed
from mesokit.report.flow.data import Array, Flow, spacing
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale
from mesokit.report.style import labelled

NEEDS = "velocity"
TITLE = "streamlines"
LINES, FEWEST = 1.3, 0.35  # how close lines lie along the longer side, as Matplotlib counts it
PALEST = 0.2  # of the colour map

reach = speed.reach


def scale(flow: Flow, reach: float) -> Scale:
    """From rest to the highest speed, without the palest colours, which paper swallows."""
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    dark = ListedColormap(colormaps["viridis_r"](np.linspace(PALEST, 1, 256)))
    return Scale(0.0, reach, dark, labelled(speed.label(flow), "a/tau"))


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw it."""
    from matplotlib.colors import Normalize

    x, y, velocity = _nodes(flow, region)
    u, v = (np.ma.masked_invalid(velocity[..., k].T) for k in range(2))
    long = max(region.extent)
    colours = scale(flow, reach)
    ax.streamplot(
        x,
        y,
        u,
        v,
        color=np.ma.hypot(u, v),
        cmap=colours.colours,
        linewidth=0.9,
        arrowsize=0.8,
        density=[max(LINES * side / long, FEWEST) for side in region.extent],
        norm=Normalize(colours.low, colours.high),
    )


def _nodes(flow: Flow, region: Region) -> tuple[Array, Array, Array]:
    """Places x (nx,), y (ny,) and velocities (nx, ny, 2) of bins that reach beyond the region."""
    velocity = flow.velocity
    assert velocity is not None
    bins, places = region.bins(flow.size, velocity.shape), []
    for k in range(2):
        n = velocity.shape[k]
        index = np.arange(bins[k].start - 1, bins[k].stop + 1)
        if not flow.periodic[k]:
            index = index[(index >= 0) & (index < n)]
        places.append((index + 0.5) * spacing(flow, velocity)[k])
        velocity = np.take(velocity, index, axis=k, mode="wrap")
    return places[0], places[1], velocity
