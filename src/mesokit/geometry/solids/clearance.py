"""Tables of what is near, for each offset of the grid of cells from the box.

A cell of the grid lies anywhere: its shift is drawn at each step. Tables are made for OFFSETS
intervals of the shift along each axis, and hold for every shift of the interval.
"""

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
FAR = 1e6
# the lowest cell along each axis, and the one beyond the last
Block = tuple[tuple[int, ...], tuple[int, ...]]


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


def corners_of(cells: Sequence[int], block: Block | None = None) -> Any:
    """Lower corners (n, d) of so many cells along each axis, or of a block; x varies fastest."""
    low, high = block or ((0,) * len(cells), tuple(cells))
    grids = [np.arange(float(a), float(b)) for a, b in zip(low, high, strict=True)]
    mesh = np.meshgrid(*reversed(grids), indexing="ij")
    return np.stack([axis.ravel() for axis in reversed(mesh)], axis=-1)


def clear_squares(solids: Solids, bend: float, held: Held | None = None) -> tuple[Any, int]:
    """Square of a lower bound of the clearance in small cubes that fill the box, or the cells held,
    x varying fastest, and then 0; and their number to a cell along each axis.

    No flight is farther than `bend` from the straight line to its end. Plates do not count.
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
    planes_above(solids.kernel, solids.pattern, away, COLUMNS[d], in_box, planes)
    planes[:, d] += bend + MARGIN
    plane_of = np.full(len(clear), -1, np.int32)
    plane_of[numbers] = np.arange(len(numbers))
    return plane_of, planes, reach


def surface_pieces(solids: Solids) -> tuple[Any, Any, Any, Any]:
    """A piece of surface in each cell of the box that has one, whose body follows the fluid.

    Number of the piece in each cell or -1, then for each piece its normal, the first place to look
    for fluid, and its term.
    """
    d, size = solids.dimension, solids.size
    middle = corners_of(size) + 0.5
    terms, distance, normal = survey.nearest_surfaces(solids.kernel, middle)
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
