"""Lines along a velocity, followed all at once, and those of them that fill a picture evenly.

Each line goes on until it leaves the region, comes to a solid or to rest, or closes. Of many lines
the longest are kept first, and then those that keep their distance.
Source: B. Jobard and W. Lefer, Visualization in Scientific Computing '97, 43 (1997), with lines
kept whole.
"""

from typing import NamedTuple

import numpy as np

from mesokit.report.flow.data import Array

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
        parts = (self.velocity[..., k] for k in range(2))
        return np.stack([map_coordinates(v, index, order=1, cval=np.nan) for v in parts], axis=1)


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
