"""Lines along the velocity, coloured by its size as the map of the speed is.

Each line goes on until it leaves the region, comes to a solid or to rest, or closes. Of many lines
the longest are kept first, and then those that keep their distance.
Source: B. Jobard and W. Lefer, Visualization in Scientific Computing '97, 43 (1997), with lines
kept whole.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mesokit.report.flow import speed
from mesokit.report.flow.data import Array, Flow, spacing
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale
from mesokit.report.flow.smooth import smoothed
from mesokit.report.style import labelled

STEPS = 500  # of a line in each direction
STEP = 0.25  # of the distance between lines
SEEDS = 1.3  # for each distance
CLOSED, BACK = 8, 0.3  # steps and distance after which a line that is back at its start has closed
NEAR, CROWDED = 0.45, 0.3  # of the distance: too near; part of a line that may be
SHORTEST = 1.5  # distances


class Nodes(NamedTuple):
    """Places x (nx,), y (ny,), evenly spaced, and velocities (nx, ny, 2) there, nan in solids."""

    x: Array
    y: Array
    velocity: Array

    def at(self, places: Array) -> Array:
        """Velocities (n, 2) at places (n, 2), nan next to solids and outside."""
        from scipy.ndimage import map_coordinates

        first = np.array([self.x[0], self.y[0]])
        spacing = np.array([self.x[1], self.y[1]]) - first
        index = ((places - first) / spacing).T
        return np.stack(
            [map_coordinates(self.velocity[..., k], index, order=1, cval=np.nan) for k in range(2)],
            axis=1,
        )


def lines(nodes: Nodes, low: Array, high: Array, distance: float) -> list[Array]:
    """Lines (n, 2) inside a rectangle, about a `distance` apart, in the direction of the flow."""
    counts = np.maximum(np.round(SEEDS * (high - low) / distance), 2).astype(int)
    sides = [
        a + (b - a) * (np.arange(n) + 0.5) / n for a, b, n in zip(low, high, counts, strict=True)
    ]
    seeds = np.stack([axis.ravel() for axis in np.meshgrid(*sides, indexing="ij")], axis=1)
    step = STEP * distance
    onward, closed = _followed(nodes, seeds, step, low, high)
    back, _ = _followed(nodes, seeds, -step, low, high)
    found = []
    for k in range(len(seeds)):
        ahead = onward[:, k][np.isfinite(onward[:, k, 0])]
        behind = back[1:, k][np.isfinite(back[1:, k, 0])]
        found.append(ahead if closed[k] else np.concatenate([behind[::-1], ahead]))
    return _spread(found, distance, step)


def _followed(
    nodes: Nodes, seeds: Array, step: float, low: Array, high: Array
) -> tuple[Array, Array]:
    """Places (steps + 1, n, 2), nan from where a line ends, and which have closed (n,)."""
    path = np.full((STEPS + 1, *seeds.shape), np.nan)
    closed, going = np.zeros(len(seeds), bool), np.arange(len(seeds))
    path[0], here = seeds, seeds.copy()
    for number in range(1, STEPS + 1):
        middle = here + 0.5 * step * _direction(nodes.at(here))
        ahead = here + step * _direction(nodes.at(middle))
        with np.errstate(invalid="ignore"):
            inside = ((ahead >= low) & (ahead <= high)).all(axis=1)
        going, here = going[inside], ahead[inside]
        path[number, going] = here
        if number >= CLOSED:
            back = np.hypot(*(here - seeds[going]).T) < BACK / STEP * abs(step)
            closed[going[back]] = True
            going, here = going[~back], here[~back]
        if not len(going):
            break
    return path, closed


def _direction(velocity: Array) -> Array:
    """Of length 1; nan at rest."""
    size = np.hypot(velocity[:, 0], velocity[:, 1])
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(size > 0, 1.0, np.nan)[:, None] * velocity / size[:, None]


def _spread(found: list[Array], distance: float, step: float) -> list[Array]:
    """The longest, and all others that keep their distance from those before."""
    from scipy.spatial import cKDTree

    found = [line for line in found if len(line) * step > SHORTEST * distance]
    kept: list[Array] = []
    trees: list[cKDTree] = []  # of all that is kept, each more than twice as large as the next
    for line in sorted(found, key=len, reverse=True):
        some = line[::2]
        away = np.full(len(some), np.inf)
        for tree in trees:
            away = np.minimum(away, tree.query(some, distance_upper_bound=distance)[0])
        far = np.median(away) >= 0.9 * distance
        if far and np.mean(away < NEAR * distance) <= CROWDED:
            kept.append(line)
            places = line
            while trees and trees[-1].n <= 2 * len(places):
                places = np.concatenate([trees.pop().data, places])
            trees.append(cKDTree(places))
    return kept


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
    return Scale(0.0, reach, dark, labelled(speed.label(flow), "a/tau"))


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
