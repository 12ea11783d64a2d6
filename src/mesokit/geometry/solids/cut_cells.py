"""The cells that surfaces cut, for each offset of the grid of cells from the box (`clearance`).

A search takes a moment. That of the whole grid is kept for runs that follow; that of a block, which
a rank has, is put together from tiles, so that a block that moves a little is soon known.
"""

import functools
import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from mesokit.geometry.solids import survey
from mesokit.geometry.solids.clearance import OFFSETS, Block, corners_of, origins
from mesokit.geometry.solids.contact import MARGIN
from mesokit.geometry.solids.solids import Solids

PIECES = 5  # along each axis, by which a cell is searched for a surface
SHIFTED_FINE = 4  # parts of a cell along each axis by which its volume is summed, for each shift
EVERYWHERE = 1e30
ROUNDING = 1e-9  # of a share
LARGE = 2**19  # cells: of more, one period of walls that repeat is searched
TILE = 16  # cells along each axis
KEPT, KEPT_TILES = 4, 128  # of whole grids and of tiles, of which each has two tables


def cut_cells(
    solids: Solids, cells: tuple[int, ...], block: Block | None = None
) -> tuple[Any, Any, Any]:
    """Cells of the grid, or of a block of it, that may hold both fluid and solid: where those of
    each offset start, their numbers in the grid (entries,), and their lower corners there
    (entries, d), as whole numbers; by offset, and then by number."""
    if block is None:
        return _of_all(_found, solids, cells, None)
    chosen, offsets = _of_tiles(solids, cells, block)
    _, numbers, corners = _joined(_found, solids, cells, block)
    number = math.prod([OFFSETS[solids.dimension]] * solids.dimension)
    counts = np.bincount(offsets[chosen], minlength=number)
    starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    return starts, numbers[chosen], corners[chosen]


def cut_planes(
    solids: Solids, cells: tuple[int, ...], block: Block | None = None
) -> tuple[Any, ...]:
    """Planes that cut the cells of `cut_cells`, as columns with a row for each cell.

    Normal (entries, d) and height of the plane, middle of the cell in the box, number of the term,
    and the cell of the box in which the surface lies nearest to that middle.
    """
    if block is None:
        return _of_all(_planes, solids, cells, None)
    chosen, _ = _of_tiles(solids, cells, block)
    return tuple(column[chosen] for column in _joined(_planes, solids, cells, block))


def _kept(make: Any, solids: Solids, cells: tuple[int, ...], block: Block | None) -> Any:
    return make(solids, cells, block)


_of_all = functools.lru_cache(maxsize=2 * KEPT)(_kept)
_of_tile = functools.lru_cache(maxsize=2 * KEPT_TILES)(_kept)


def _tiles(cells: tuple[int, ...], block: Block) -> Iterator[Block]:
    """The tiles that have cells of a block; none reaches beyond the grid."""
    along = [range(a // TILE, (b - 1) // TILE + 1) for a, b in zip(*block, strict=True)]
    for at in itertools.product(*along):
        low = tuple(TILE * i for i in at)
        yield low, tuple(min(a + TILE, n) for a, n in zip(low, cells, strict=True))


def _joined(make: Any, solids: Solids, cells: tuple[int, ...], block: Block) -> list[Any]:
    tables = [_of_tile(make, solids, cells, tile) for tile in _tiles(cells, block)]
    return [np.concatenate(columns) for columns in zip(*tables, strict=True)]


def _of_tiles(solids: Solids, cells: tuple[int, ...], block: Block) -> tuple[Any, Any]:
    """The rows of all tiles that belong to the block, in order, and the offset of each row."""
    offsets = [
        np.repeat(np.arange(len(starts) - 1), np.diff(starts))
        for starts, _, _ in (_of_tile(_found, solids, cells, tile) for tile in _tiles(cells, block))
    ]
    _, numbers, corners = _joined(_found, solids, cells, block)
    offset, (low, high) = np.concatenate(offsets), block
    order = np.lexsort((numbers, offset))
    inside = ((corners >= low) & (corners < high)).all(axis=1)
    return order[inside[order]], offset


def _found(solids: Solids, cells: tuple[int, ...], block: Block | None) -> tuple[Any, Any, Any]:
    """As `cut_cells`, found by a search, or by that of one period of a large box."""
    starts, numbers, corners = [0], [], []
    every = corners_of(cells, block)
    own = (every @ np.cumprod([1, *cells[:-1]])).astype(np.int64)
    again = _alike(solids, every) if _repeats(solids, cells) else None
    for number, origin in enumerate(origins(solids.room.closed)):
        if again is None:
            chosen = _search(solids, every, origin)
        else:
            chosen = np.flatnonzero(_of_period(solids)[0][number][again] >= 0)
        numbers.append(own[chosen])
        corners.append(every[chosen])
        starts.append(starts[-1] + len(chosen))
    return np.array(starts, np.int64), np.concatenate(numbers), np.concatenate(corners)


def _search(solids: Solids, every: Any, origin: tuple[float, ...]) -> Any:
    """Find those of these cells (n, d) that a surface may cut, by their lower corners."""
    half = 0.5 + 0.5 / OFFSETS[solids.dimension]
    middle = every + 0.5 - np.array(origin)
    near = np.flatnonzero(np.abs(solids.distance(middle)) <= half * math.sqrt(solids.dimension))
    found = np.zeros(len(near), np.int64)
    survey.cut(solids.kernel, solids.pattern, middle[near], half, PIECES, found)
    return near[found > 0]


def _repeats(solids: Solids, cells: tuple[int, ...]) -> bool:
    """Whether one period of the solids is searched for all. The places of copies are rounded, so
    that this may change last digits."""
    return math.prod(cells) >= LARGE and math.prod(solids.period) < math.prod(cells)


def _alike(solids: Solids, corners: Any) -> Any:
    """Number, in the first period, of the cell that looks as each of these does."""
    period = solids.period
    return (corners % period).astype(np.int64) @ np.cumprod([1, *period[:-1]])


@functools.lru_cache(maxsize=KEPT)
def _of_period(solids: Solids) -> tuple[Any, Any]:
    """For each offset the rows (offsets, cells) of the cells of the first period, -1 for cells that
    nothing cuts; and for each row the height of its plane."""
    every = corners_of(solids.period)
    every_origin = list(origins(solids.room.closed))
    rows, middles, total = np.full((len(every_origin), len(every)), -1), [], 0
    for number, origin in enumerate(every_origin):
        chosen = _search(solids, every, origin)
        rows[number, chosen] = total + np.arange(len(chosen))
        middles.append((every[chosen] + 0.5 - np.array(origin)) % solids.size)
        total += len(chosen)
    return rows, _surveyed(solids, np.concatenate(middles)).heights


def _planes(solids: Solids, cells: tuple[int, ...], block: Block | None) -> tuple[Any, ...]:
    """As `cut_planes`, of the cells that a search finds."""
    starts, _, corners = (_of_all if block is None else _of_tile)(_found, solids, cells, block)
    middles = np.empty(corners.shape)
    for number, origin in enumerate(origins(solids.room.closed)):
        some = slice(starts[number], starts[number + 1])
        middles[some] = corners[some] + 0.5 - np.array(origin)
    for k, (length, shut) in enumerate(zip(solids.size, solids.room.closed, strict=True)):
        middles[:, k] = middles[:, k] if shut else middles[:, k] % length
    if _repeats(solids, cells):
        rows, heights = _of_period(solids)
        offset = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
        found = _nearest(solids, middles, heights[rows[offset, _alike(solids, corners)]])
    else:
        found = _surveyed(solids, middles)
    # The cell of the box that holds each foot, which may be in an image.
    cell, stride = np.zeros(len(middles), np.int64), 1
    for k, (length, shut) in enumerate(zip(solids.size, solids.room.closed, strict=True)):
        index = np.floor(found.feet[:, k]).astype(np.int64)
        cell += stride * (np.clip(index, 0, length - 1) if shut else index % length)
        stride *= length
    return found.normals, found.heights, middles, found.terms, cell


def _nearest(solids: Solids, middles: Any, heights: Any) -> survey.Planes:
    """The planes of cells about these middles, whose heights are known."""
    away = _away(solids.dimension)
    terms, clearance, normals = survey.nearest_surfaces(_reaching(solids, away), middles, away)
    return survey.Planes(normals, heights, terms, middles - clearance[:, None] * normals)


def _away(d: int) -> float:
    """The longest distance of a surface that cuts a cell from the middle of the cell."""
    return (0.5 + 0.5 / OFFSETS[d]) * math.sqrt(d) + MARGIN


def _surveyed(solids: Solids, middles: Any) -> survey.Planes:
    # Means over the shifts of an interval are taken at Gauss's points.
    side = 0.5 / OFFSETS[solids.dimension] / math.sqrt(3.0)
    shifts = np.array(list(itertools.product((-side, side), repeat=solids.dimension)))
    share = np.mean([solids.open_part(middles - x, 1.0, SHIFTED_FINE) for x in shifts], axis=0)
    normals, heights = np.zeros(middles.shape), np.zeros(len(middles))
    terms, feet = np.zeros(len(middles), np.int64), np.zeros(middles.shape)
    away = _away(solids.dimension)
    found = survey.Planes(normals, heights, terms, feet)
    survey.planes(_reaching(solids, away), solids.pattern, away, shifts, middles, share, found)
    slippery = np.array([body.surface.rule == "slip" for body in solids.bodies])
    empty = slippery[solids.body_of_term[terms]] | (share <= ROUNDING) | (share >= 1.0 - ROUNDING)
    heights[empty | (terms < 0)] = EVERYWHERE
    return found


@functools.lru_cache(maxsize=KEPT)
def _reaching(solids: Solids, away: float) -> Any:
    """Lists of what is so near to each cell of the box: once for all tiles."""
    return solids.reaching(away)
