"""Lines along the velocity, coloured by its size as the map of the speed is."""

from typing import Any

import numpy as np

from mesokit.report.flow.data import Array, Flow, spacing
from mesokit.report.flow.follow import Nodes, lines
from mesokit.report.flow.maps import speed, speed_label
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale
from mesokit.report.flow.smooth import smoothed

NEEDS = "velocity"
TITLE = "streamlines"
LINES, FEWEST = 38.0, 8.0  # lines along the longer side, were they to stand so; the shorter
DARK = 0.85  # of the colour map: paper swallows what is paler
SMOOTH, LOST = 1.0, 0.5  # bins over which noise is smoothed; speed in units of it with no direction
WIDTH, HEAD = 0.9, 0.09  # of a line, points; of its arrow, inches

reach = speed.reach


def scale(flow: Flow, reach: float) -> Scale:
    """From rest to the highest speed, without the palest colours."""
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    dark = ListedColormap(colormaps["viridis"](np.linspace(0, DARK, 256)))
    return Scale(0.0, reach, dark, speed_label(flow))


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw it: whole lines, with an arrow in the middle of each."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import Normalize

    nodes = Nodes(*_nodes(flow, region))
    distance = min(max(region.extent) / LINES, min(region.extent) / FEWEST)
    found = lines(nodes, np.array(region.low), np.array(region.high), distance)
    if not found:
        return
    colours = scale(flow, reach)
    look = {"cmap": colours.colours, "norm": Normalize(colours.low, colours.high)}
    pieces = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in found])
    size = np.hypot(*nodes.at(pieces.mean(axis=1)).T)
    drawn = LineCollection(list(pieces), array=size, linewidths=WIDTH, **look)
    drawn.set_capstyle("round")
    ax.add_collection(drawn, autolim=False)
    middle = np.array([line[len(line) // 2] for line in found])
    direction = nodes.at(middle)
    size = np.hypot(*direction.T)
    direction = direction / np.maximum(size, 1e-300)[:, None]
    shape = {"width": 0.012, "headwidth": 5, "headlength": 7.5, "headaxislength": 7.5}
    inches = {"units": "inches", "scale_units": "inches", "scale": 1 / HEAD}
    ax.quiver(*middle.T, *direction.T, size, angles="xy", pivot="mid", **inches, **shape, **look)


def _nodes(flow: Flow, region: Region) -> tuple[Array, Array, Array]:
    """Places x (nx,), y (ny,) and velocities (nx, ny, 2) of bins that reach beyond the region."""
    velocity = quiet(flow)
    bins, places = region.bins(flow.size, velocity.shape), []
    for k in range(2):
        n = velocity.shape[k]
        index = np.arange(bins[k].start - 1, bins[k].stop + 1)
        if not flow.periodic[k]:
            index = index[(index >= 0) & (index < n)]
        places.append((index + 0.5) * spacing(flow, velocity)[k])
        velocity = np.take(velocity, index, axis=k, mode="wrap")
    return places[0], places[1], velocity


def quiet(flow: Flow) -> Array:
    """The velocity (nx, ny, 2), smoothed a little where it is noisy; nan where it is only noise."""
    velocity = flow.velocity
    assert velocity is not None
    if flow.noise is None:
        return velocity
    velocity, noise = (
        np.stack([smoothed(v[..., k], flow.periodic, SMOOTH) for k in range(2)], axis=-1)
        for v in (velocity, flow.noise)
    )
    known = np.isfinite(noise)
    level = float(np.sqrt(2 * np.mean(noise[known] ** 2))) if known.any() else 0.0
    lost = np.hypot(velocity[..., 0], velocity[..., 1]) < LOST * level
    return np.where(lost[..., None], np.nan, velocity)
