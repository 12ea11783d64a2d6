"""Tables of what is near, for each offset of the grid of cells from the box.

A cell of the grid lies anywhere: its shift is drawn at each step. Tables are made for OFFSETS
intervals of the shift along each axis, and hold for every shift of the interval.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from mesokit.geometry.solids import survey
from mesokit.geometry.solids.bodies import REACH, Bodies
from mesokit.geometry.solids.contact import MARGIN
from mesokit.geometry.solids.free_planes import planes_above
from mesokit.geometry.solids.solids import Solids
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import by_type, scalar

OFFSETS = {2: 4, 3: 2}  # along each axis, by dimension
PARTS = {2: 4, 3: 2}  # of a cell along each axis, for which a bound of the clearance is kept
COLUMNS = {2: 32, 3: 10}  # along each axis, by which the solid about a cube is probed
PIECES = 5  # along each axis, by which a cell is searched for a surface
SHIFTED_FINE = 4  # parts of a cell along each axis by which its volume is summed, for each shift
EVERYWHERE = 1e30
FAR = 1e6
ROUNDING = 1e-9  # of a share
KEPT = 4  # tables of solids that runs one after the other share: they take a moment to make


class Held(NamedTuple):
    """Cells of the box: from the first along each axis, so many, across an end of it too."""

    first: tuple[int, ...]
    cells: tuple[int, ...]


@by_type
def offsets_along(solid, r):
    """Number of intervals along each axis, for a box of as many axes as r: one between plates."""
    number = OFFSETS[len(r)] if solid.instance_class is Bodies else 1
    return lambda solid, r: number


@scalar
def offset_of(solid, grid):
    """Number of the interval that holds the origin of the grid."""
    number = 0
    for k in range(len(grid.origin)):
        many = offsets_along(solid, grid.origin)
        number = number * many + int(floor(grid.origin[k] * many)) % many
    return number


def origins(closed: tuple[bool, ...]) -> Iterator[tuple[float, ...]]:
    """The middle of each interval: from 0 to 1 along a closed axis, from -1/2 to 1/2 elsewhere."""
    many = OFFSETS[len(closed)]
    along = [
        [((q if shut or q < many // 2 else q - many) + 0.5) / many for q in range(many)]
        for shut in closed
    ]
    return itertools.product(*along)


def corners_of(low: Sequence[int], high: Sequence[int]) -> Any:
    """Lower corners of the cells of a block (cells, d), x varying fastest."""
    grids = [np.arange(float(a), float(b)) for a, b in zip(low, high, strict=True)]
    mesh = np.meshgrid(*reversed(grids), indexing="ij")
    return np.stack([axis.ravel() for axis in reversed(mesh)], axis=-1)


def clear_squares(solids: Solids, bend: float, held: Held | None = None) -> tuple[Any, int]:
    """Square of a lower bound of the clearance in small cubes that fill the box, or the cells held,
    x varying fastest, and then 0; and their number to a cell along each axis.

    No flight is farther than `bend` from the straight way to its end. Plates do not count.
    """
    d = solids.dimension
    held = held or whole(solids)
    parts = PARTS[d]
    sides = [n * parts for n in held.cells]
    layer = math.prod(sides[:-1])
    rows = []
    for n in range(sides[-1]):  # layer by layer, for there may be many
        middles = cube_middles(np.arange(n * layer, (n + 1) * layer), sides, parts, held.first)
        clear = solids.distance(middles, plates=False) - 0.5 * math.sqrt(d) / parts - bend - MARGIN
        squares = np.clip(clear, 0.0, FAR) ** 2
        rows.append(np.nextafter(squares.astype(np.float32), np.float32(0.0)))  # never too large
    return np.concatenate([*rows, np.zeros(1, np.float32)]), parts


def whole(solids: Solids) -> Held:
    """All cells of the box."""
    return Held((0,) * solids.dimension, solids.size)


def cube_middles(
    numbers: Any, sides: Sequence[int], parts: int, first: Sequence[int] | None = None
) -> Any:
    """Middles of small cubes, of which there are so many along each side, from a first cell on."""
    places = []
    for side, begin in zip(sides, first or [0] * len(sides), strict=True):
        places.append(begin + (numbers % side + 0.5) / parts)
        numbers = numbers // side
    return np.stack(places, axis=-1)


def free_planes(
    solids: Solids, clear: Any, stride: float, bend: float, held: Held | None = None
) -> tuple[Any, Any, float]:
    """Planes above which there is no solid, for the small cubes that have some as near as a stride.

    Number of the plane of each cube, or -1; normals and heights; how near to the cube that holds.
    """
    d = solids.dimension
    parts = PARTS[d]
    corner = 0.5 * math.sqrt(d) / parts
    reach = max(min(stride, REACH - corner - bend), 0.0)
    held = held or whole(solids)
    numbers = np.flatnonzero(clear[:-1] < stride * stride)
    middles = cube_middles(numbers, [n * parts for n in held.cells], parts, held.first)
    found = solids.distance(middles, plates=False) > -corner  # the others hold no fluid
    numbers, middles = numbers[found], middles[found]
    planes = np.zeros((len(numbers), d + 1))
    away = corner + reach + bend
    in_box = middles % np.where(solids.room.closed, np.inf, solids.size)
    planes_above(solids.kernel, solids.like, away, COLUMNS[d], in_box, planes)
    planes[:, d] += bend + MARGIN
    plane_of = np.full(len(clear), -1, np.int32)
    plane_of[numbers] = np.arange(len(numbers))
    return plane_of, planes, reach


@functools.lru_cache(maxsize=KEPT)
def cut_cells(
    solids: Solids, cells: tuple[int, ...], block: tuple[Any, Any] | None = None
) -> tuple[Any, Any, Any]:
    """Cells of the grid, or of a block of it (lowest, and beyond the highest), that may hold both
    fluid and solid: where those of each offset start, and their lower corners in the grid
    (entries, d), as whole numbers."""
    starts, numbers, corners = [0], [], []
    every = corners_of(*(block or ((0,) * len(cells), cells)))
    strides = np.cumprod([1, *cells[:-1]])
    half = 0.5 + 0.5 / OFFSETS[solids.dimension]
    for origin in origins(solids.room.closed):
        middle = every + 0.5 - np.array(origin)
        near = np.flatnonzero(np.abs(solids.distance(middle)) <= half * math.sqrt(len(cells)))
        found = np.zeros(len(near), np.int64)
        survey.cut(solids.kernel, solids.like, middle[near], half, PIECES, found)
        chosen = near[found > 0]
        numbers.append(every[chosen] @ strides)
        corners.append(every[chosen])
        starts.append(starts[-1] + len(chosen))
    return (
        np.array(starts, np.int64),
        np.concatenate(numbers).astype(np.int64),
        np.concatenate(corners),
    )


def surface_pieces(solids: Solids) -> tuple[Any, Any, Any, Any]:
    """A piece of surface in each cell of the box that has one, whose body follows the fluid.

    Number of the piece in each cell or -1, then for each piece its normal, the first place to look
    for fluid, and its term.
    """
    d, size = solids.dimension, solids.size
    middle = corners_of((0,) * d, size) + 0.5
    terms = np.zeros(len(middle), np.int64)
    distance, normal = np.zeros(len(middle)), np.zeros(middle.shape)
    survey.who_is_near(solids.kernel, solids.like, middle, terms, distance, normal)
    follows = np.array([body.virtual == "extrapolate" for body in solids.bodies])
    sticks = np.array([body.surface.rule != "slip" for body in solids.bodies])
    near = (terms >= 0) & (np.abs(distance) <= 0.5 * math.sqrt(d))
    near &= (follows & sticks)[solids.body_of_term[terms]]
    where = np.flatnonzero(near)
    pieces = np.full(len(middle), -1, np.int32)
    pieces[where] = np.arange(len(where))
    outward = normal[where]
    feet = middle[where] - distance[where, None] * outward
    probes = feet + (0.3 + 0.5 * math.sqrt(d)) * outward  # with most shifts, that cell is free
    return pieces, outward, probes, terms[where]


def shifts_within(d: int) -> Any:
    """Shifts within an interval over which means are taken (shifts, d): Gauss's points."""
    side = 0.5 / OFFSETS[d] / math.sqrt(3.0)
    return np.array(list(itertools.product((-side, side), repeat=d)))


@functools.lru_cache(maxsize=KEPT)
def cut_planes(
    solids: Solids, cells: tuple[int, ...], block: tuple[Any, Any] | None = None
) -> tuple[Any, Any, Any, Any, Any]:
    """For each cell of `cut_cells` the normal and height of the plane that cuts it, its middle in
    the box, its term, and the cell of the box in which the surface lies nearest to its middle."""
    starts, _, corners = cut_cells(solids, cells, block)
    middles = np.empty(corners.shape)
    for number, origin in enumerate(origins(solids.room.closed)):
        some = slice(starts[number], starts[number + 1])
        middles[some] = corners[some] + 0.5 - np.array(origin)
    for k, (length, shut) in enumerate(zip(solids.size, solids.room.closed, strict=True)):
        middles[:, k] = middles[:, k] if shut else middles[:, k] % length
    shifts = shifts_within(solids.dimension)
    share = np.mean([solids.open_part(middles - x, 1.0, SHIFTED_FINE) for x in shifts], axis=0)
    normals, heights = np.zeros(middles.shape), np.zeros(len(middles))
    terms, feet = np.zeros(len(middles), np.int64), np.zeros(middles.shape)
    away = (0.5 + 0.5 / OFFSETS[solids.dimension]) * math.sqrt(solids.dimension) + MARGIN
    near, like = solids.reaching(away), solids.like
    found = survey.Planes(normals, heights, terms, feet)
    survey.planes(near, like, away, shifts, middles, share, found)
    slippery = np.array([body.surface.rule == "slip" for body in solids.bodies])
    nobody = slippery[solids.body_of_term[terms]] | (share <= ROUNDING) | (share >= 1.0 - ROUNDING)
    heights[nobody | (terms < 0)] = EVERYWHERE
    return normals, heights, middles, terms, cell_numbers(solids, feet)


def cell_numbers(solids: Solids, points: Any) -> Any:
    """Number of the cell of the box that holds each point, which may be in an image."""
    number, stride = np.zeros(len(points), np.int64), 1
    for k, length in enumerate(solids.size):
        cell = np.floor(points[:, k]).astype(np.int64)
        cell = np.clip(cell, 0, length - 1) if solids.room.closed[k] else cell % length
        number += stride * cell
        stride *= length
    return number
