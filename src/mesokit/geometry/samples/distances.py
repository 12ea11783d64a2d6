"""Signed distances on a grid, as files give them, made fit for the box.

Between its points a solid is what `primitive.sampled` makes of them, which is the better the nearer
the gradient is to 1: at edges and tips, and where the distances from two sides meet, samples of a
distance make it steeper. There they are smoothed.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import show
from mesokit.geometry import region
from mesokit.geometry.region import Region, Room

Floats = NDArray[np.float64]
STEEPEST = 1.15  # round surfaces, and all others away from their edges, have less
PASSES = 2
SAME = 1e-3  # spacings by which samples of one place may differ
AVERAGE = (0.25, 0.5, 0.25)


class Grid(NamedTuple):
    """Signed distance, positive outside of the solid, at points of a grid from `origin` on."""

    values: Floats
    origin: tuple[float, ...]
    spacing: float


def spans(count: int, spacing: float, length: int) -> bool:
    """Whether so many points span an axis of the box, so that they can repeat along it.

    >>> spans(20, 0.5, 10), spans(21, 0.5, 10)
    (True, False)
    """
    return math.isclose(count * spacing, length, rel_tol=1e-9)


def fitted(grid: Grid, room: Room) -> Region:
    """The solid that a grid describes: repeating along open axes that it spans.

    A last point that is the image of the first counts as such if their samples agree. Along an
    axis that plates close, the outermost points hold up to the plate. Elsewhere there is fluid
    beyond the grid; raises ValueError if the solid reaches that far.
    """
    values, origin = grid.values, list(grid.origin)
    repeats = []
    for axis, (length, shut) in enumerate(zip(room.size, room.closed, strict=True)):
        again = not shut and spans(values.shape[axis], grid.spacing, length)
        if not shut and spans(values.shape[axis] - 1, grid.spacing, length):
            off = np.abs(values.take(0, axis) - values.take(-1, axis)).max()
            if off <= SAME * grid.spacing:
                values, again = values.take(range(values.shape[axis] - 1), axis), True
            elif values.take([0, -1], axis).min() <= 0.0:
                raise ValueError(
                    f"the first and the last samples along {'xyz'[axis]} are of one place in the "
                    f"periodic box, and differ by up to {off:.3g}; expected the same"
                )
        repeats.append(again)
    for axis, shut in enumerate(room.closed):
        if shut:
            end = origin[axis] + (values.shape[axis] - 1) * grid.spacing
            before = 0.0 < origin[axis] <= grid.spacing
            after = room.size[axis] - grid.spacing <= end < room.size[axis]
            widths = [(0, 0)] * values.ndim
            widths[axis] = (int(before), int(after))
            values = np.pad(values, widths, mode="edge")
            origin[axis] -= before * grid.spacing
        for end in () if shut or repeats[axis] else (0, -1):
            if values.take(end, axis).min() <= 0.0:
                raise ValueError(
                    f"the solid reaches the {'first' if end == 0 else 'last'} samples along "
                    f"{'xyz'[axis]}; expected fluid around it, or a grid that spans the box: the "
                    "length over the spacing as many samples, or one more"
                )
    return region.sampled(smoothed(values, grid.spacing, repeats), origin, grid.spacing, repeats)


def smoothed(values: Floats, spacing: float, repeats: list[bool]) -> Floats:
    """The samples, averaged with their neighbours where the gradient is too steep."""
    from scipy import ndimage

    modes = ["grid-wrap" if again else "nearest" for again in repeats]
    for _ in range(PASSES):
        steep = region.steepness(values, repeats) > STEEPEST * spacing
        for axis in range(values.ndim):
            steep |= np.roll(steep, 1, axis)  # cells to their corners
        mean = values
        for axis, mode in enumerate(modes):
            mean = ndimage.convolve1d(mean, AVERAGE, axis, mode=mode)
        values = np.where(steep, mean, values)
    return values


def slope(grid: Grid) -> float:
    """Size of the gradient where the surface is, in the middle: 1 for a signed distance."""
    values, solid = grid.values, grid.values < 0.0
    edge = np.zeros(solid.shape, bool)
    for axis in range(solid.ndim):
        change = np.diff(solid, axis=axis)
        edge[tuple(slice(-1) if k == axis else slice(None) for k in range(solid.ndim))] |= change
    places = np.nonzero(edge)
    square = np.zeros(len(places[0]))
    for axis, count in enumerate(values.shape):
        low, high = (np.clip(places[axis] + step, 0, count - 1) for step in (-1, 1))
        before, after = (values[*places[:axis], x, *places[axis + 1 :]] for x in (low, high))
        square += ((after - before) / (grid.spacing * (high - low))) ** 2
    return float(np.median(np.sqrt(square))) if len(square) else math.nan


def volume(values: Floats, spacing: float) -> float:
    """Volume of the solid, in cells."""
    return float(np.clip(0.5 - values / spacing, 0.0, 1.0).sum()) * spacing**values.ndim


def extent(values: Floats, axis: int) -> tuple[int, int]:
    """The first and the last points along an axis at which there is solid."""
    other = tuple(k for k in range(values.ndim) if k != axis)
    found = np.flatnonzero((values < 0.0).any(axis=other))
    return int(found[0]), int(found[-1])


def checked(values: object, key: str) -> Floats:
    """An array of finite real numbers in 2 or 3 dimensions. Raises ValueError."""
    array = np.asarray(values)
    if array.dtype.kind not in "iuf" or array.ndim not in (2, 3) or min(array.shape) < 2:
        raise ValueError(
            f"{key}: expected numbers on a grid in 2 or 3 dimensions, not shape "
            f"{show(array.shape)} of {array.dtype.name}"
        )
    if not np.isfinite(array).all():
        raise ValueError(f"{key}: expected finite numbers")
    return np.ascontiguousarray(array, float)
