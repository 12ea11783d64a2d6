"""Where sites are in memory, and the way from a site to its neighbours.

Memory is cut into tiles of 256 sites: 16 x 16 of them in 2D, 8 x 8 x 4 in 3D. What an event reads
and writes then lies in few cache lines, however large the lattice is.
"""

import itertools
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.prefetch import LINE, prefetch

TILE = 256  # sites
BITS = {1: (8,), 2: (4, 4), 3: (3, 3, 2)}  # of coordinates within a tile
SMALL = 2**31  # places in memory that numbers of 32 bits can tell apart


class Grid(NamedTuple):
    """A lattice in memory; d is the dimension.

    size, bits, tiles: (d,) sites along each axis, bits of a coordinate within a tile, and tiles.
    neighbours: of each site. jumps: (kinds of tiles * 256 * neighbours,) how far on in memory a
    neighbour is, by the place in the tile; the lowest number where there is none. kinds: (tiles,)
    where the jumps from a tile begin: tiles at the two ends of an axis differ from those within.
    back: (neighbours,) the direction from a neighbour back.
    """

    size: tuple[int, ...]
    bits: tuple[int, ...]
    tiles: tuple[int, ...]
    neighbours: int
    jumps: NDArray[np.integer]
    kinds: NDArray[np.int32]
    back: NDArray[np.int64]


def grid_of(kind: Kind, size: tuple[int, ...], closed: tuple[bool, ...]) -> Grid:
    """The grid of a lattice."""
    bits = BITS[len(size)]
    sides = [1 << b for b in bits]
    tiles = tuple(-(-length // side) for length, side in zip(size, sides, strict=True))
    memory = TILE * int(np.prod(tiles))
    number = np.int32 if memory < SMALL else np.int64
    grid = Grid(
        size, bits, tiles, kind.neighbours, np.zeros(0, number), np.zeros(0, np.int32), kind.back
    )
    # a tile of each kind: the first, one within, and the last along each axis
    samples = [sorted({0, min(1, most - 1), most - 1}) for most in tiles]
    within = np.indices(sides).reshape(len(size), -1).T  # (256, d), by place in the tile
    odd = (within @ np.array(kind.parity)) % 2  # sides are even: the parity is that of the lattice
    jumps = [
        _jumps(grid, np.array(sides) * np.array(tile) + within, kind.shifts[odd], closed)
        for tile in itertools.product(*samples)
    ]
    nth = np.zeros(tiles, np.int64)
    for axis, (some, most) in enumerate(zip(samples, tiles, strict=True)):
        along = np.clip(np.arange(most), 0, 1)
        along[-1] = len(some) - 1
        nth = nth * len(some) + along.reshape([-1 if k == axis else 1 for k in range(len(size))])
    kinds = (nth.ravel() * TILE * kind.neighbours).astype(np.int32)
    return grid._replace(jumps=np.concatenate(jumps).astype(number), kinds=kinds)


def _jumps(
    grid: Grid, r: NDArray[np.int64], steps: NDArray[np.int64], closed: tuple[bool, ...]
) -> NDArray[np.int64]:
    """How far on in memory the neighbours of sites r (256, d) are, flat, by their steps (256,
    neighbours, d)."""
    size = np.array(grid.size)
    there = r[:, None, :] + steps
    outside = (there < 0) | (there >= size)
    missing = np.any(outside & np.array(closed), axis=-1)
    jump = places(grid, there % size) - places(grid, r)[:, None]
    lowest = np.iinfo(grid.jumps.dtype).min
    # places beyond the end of the lattice hold no sites: their jumps are never taken
    return np.where(missing | np.any(r >= size, axis=-1, keepdims=True), lowest, jump).ravel()


def places(grid: Grid, r: NDArray[np.int64]) -> NDArray[np.int64]:
    """Where the sites with coordinates r (..., d) are in memory."""
    tile = within = np.zeros(r.shape[:-1], np.int64)
    for k, bits in enumerate(grid.bits):
        tile = tile * grid.tiles[k] + (r[..., k] >> bits)
        within = (within << bits) | (r[..., k] & ((1 << bits) - 1))
    return (tile << 8) | within


@scalar
def place(grid, r):
    """Where the site with coordinates r (d,) is in memory."""
    tile, within = 0, 0
    for k in range(len(r)):
        bits = grid.bits[k]
        tile = tile * grid.tiles[k] + (r[k] >> bits)
        within = (within << bits) | (r[k] & ((1 << bits) - 1))
    return (tile << 8) | within


@scalar
def coordinates(grid, i):
    """Coordinates (d,) of the site at a place in memory."""
    tile, within = i >> 8, i & 255
    r = grid.size
    for back in range(len(r)):
        k = len(r) - 1 - back
        bits, rest = grid.bits[k], tile // grid.tiles[k]
        r = with_item(r, k, ((tile - rest * grid.tiles[k]) << bits) | (within & ((1 << bits) - 1)))
        tile, within = rest, within >> bits
    return r


@scalar
def neighbour(grid, i, direction):
    """Where a neighbour of the site at a place is in memory; negative where there is none."""
    return i + jump(grid, first_jump(grid, i), direction)


@scalar
def first_jump(grid, i):
    """Where the jumps from the site at a place begin."""
    # indices without a sign: negative ones would be counted from the end
    return np.int64(grid.kinds[np.uint64(i >> 8)]) + (i & 255) * grid.neighbours


@scalar
def jump(grid, first, direction):
    """How far on in memory a neighbour is; the lowest number where there is none."""
    return np.int64(grid.jumps[np.uint64(first + direction)])


class Sites(NamedTuple):
    """A lattice, and of each place in memory (n,) the state of the site there and the number of its
    surroundings (see `model/protocol.py`); and what else is recorded of it (`engine/record.py`)."""

    grid: Grid
    states: NDArray[np.integer]
    around: NDArray[np.uint16]
    record: Any


@scalar
def fetch_site(sites, i):
    """Have memory fetch what is kept of a site and of those beside it."""
    for line in range(-1, 2):
        prefetch(sites.states, i, LINE * line)
        prefetch(sites.around, i, LINE * line)


def by_number(grid: Grid) -> NDArray[np.int64]:
    """Places in memory (n,) of all sites, by number: along the last axis first."""
    return places(grid, np.moveaxis(np.indices(grid.size), 0, -1)).ravel()


def length_of(grid: Grid) -> Any:
    """Places in memory, those of tiles that stick out included."""
    return TILE * int(np.prod(grid.tiles))
