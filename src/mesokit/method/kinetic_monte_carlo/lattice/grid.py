"""Where sites are in memory, and the way from a site to its neighbours.

Memory is cut into tiles of 256 sites: 16 x 16 of them in 2D, 8 x 8 x 4 in 3D. What an event reads
and writes then lies in few cache lines, however large the lattice is.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar, seldom

TILE = 256  # sites
FAR = -(2**31)
BITS = {1: (8,), 2: (4, 4), 3: (3, 3, 2)}  # of coordinates within a tile


class Grid(NamedTuple):
    """A lattice in memory; d is the dimension.

    size, bits, tiles: (d,) sites along each axis, bits of a coordinate within a tile, and tiles.
    parity: (d,) -1 for the axes that make the parity of a site. closed: (d,) axes that end.
    neighbours: of each site. steps: (2, neighbours, d) from even and odd sites. near: (256 *
    neighbours,) how far on in memory a neighbour is, by place in the tile; FAR where it is in
    another tile, or may be beyond the end of the lattice. back: (neighbours,) the direction from
    a neighbour back.
    """

    size: tuple[int, ...]
    bits: tuple[int, ...]
    tiles: tuple[int, ...]
    parity: tuple[int, ...]
    closed: tuple[bool, ...]
    neighbours: int
    steps: NDArray[np.int64]
    near: NDArray[np.int32]
    back: NDArray[np.int64]


def grid_of(kind: Kind, size: tuple[int, ...], closed: tuple[bool, ...]) -> Grid:
    """The grid of a lattice."""
    d = len(size)
    bits = BITS[d]
    sides = np.array([1 << b for b in bits])
    tiles = tuple(int(-(-length // side)) for length, side in zip(size, sides, strict=True))
    parity = tuple(-axis for axis in kind.parity)
    within = np.indices(tuple(sides.tolist())).reshape(d, -1).T  # (256, d), by place in the tile
    odd = (within @ np.array(kind.parity)) % 2  # sides are even: the parity is that of the lattice
    towards = within[:, None, :] + kind.shifts[odd]
    inside = ((towards >= 0) & (towards < sides)).all(axis=-1)
    ends = (np.array(size) - 1) % sides  # where the lattice ends within a tile
    inside &= ~((within[:, None, :] == ends) & (kind.shifts[odd] > 0)).any(axis=-1)
    strides = np.cumprod([1, *sides[:0:-1]])[::-1]
    near = np.where(inside, (kind.shifts[odd] * strides).sum(axis=-1), FAR)
    near = near.astype(np.int32).ravel()
    return Grid(size, bits, tiles, parity, closed, kind.neighbours, kind.shifts, near, kind.back)


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
    """Where a neighbour of the site at a place is in memory; -1 where there is none."""
    step = np.int64(grid.near[(i & 255) * grid.neighbours + direction])
    return i + step if step != FAR else _far_neighbour(grid, i, direction)


@seldom
def _far_neighbour(grid, i, direction):
    """The same, of a site at the edge of its tile."""
    r, odd = coordinates(grid, i), 0
    for k in range(len(r)):
        odd ^= r[k] & grid.parity[k]
    for k in range(len(r)):
        x, length = r[k] + grid.steps[odd & 1, direction, k], grid.size[k]
        if x < 0 or x >= length:
            if grid.closed[k]:
                return np.int64(-1)
            x += length if x < 0 else -length
        r = with_item(r, k, x)
    return place(grid, r)


class Sites(NamedTuple):
    """A lattice, and of each place in memory (n,) the state of the site there and the number of its
    surroundings (see `model/protocol.py`)."""

    grid: Grid
    states: NDArray[np.integer]
    around: NDArray[np.uint16]


def by_number(grid: Grid) -> NDArray[np.int64]:
    """Places in memory (n,) of all sites, by number: along the last axis first."""
    r = np.indices(grid.size)
    tile, within = np.zeros(grid.size, np.int64), np.zeros(grid.size, np.int64)
    for x, bits, tiles in zip(r, grid.bits, grid.tiles, strict=True):
        tile = tile * tiles + (x >> bits)
        within = (within << bits) | (x & ((1 << bits) - 1))
    return ((tile << 8) | within).ravel()


def length_of(grid: Grid) -> Any:
    """Places in memory, those of tiles that stick out included."""
    return TILE * int(np.prod(grid.tiles))
