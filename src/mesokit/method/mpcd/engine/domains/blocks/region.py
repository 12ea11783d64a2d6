"""The cells that a rank holds: its block and the halo around it, and the owners of these."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.mpcd.engine.domains.blocks.tree import Block, Cells

Numbers = NDArray[np.int64]


class Space(NamedTuple):
    """All cells: their number along each axis, and the images beyond the ends.

    wraps: whether the first cell along an axis comes after the last one; slides: whether images
    along y are displaced, so that nothing there has a neighbour that stays.
    """

    cells: Cells
    wraps: tuple[bool, ...]
    slides: bool

    def repeats(self, axis: int) -> bool:
        """Whether the cells beyond an end are those at the other end."""
        return self.wraps[axis] and not (self.slides and axis == 1)


class Region(NamedTuple):
    """First cell along each axis (below 0 across an end of the box), and number of cells held."""

    first: Cells
    known: Cells

    @property
    def number(self) -> int:
        """Number of cells held."""
        return math.prod(self.known)


def region_of(block: Block, space: Space, halo: int) -> Region:
    """A block and its halo, each cell once."""
    first, known = [], []
    # Axis by axis. A halo continues across an end of the box, unless a wall or sliding images are
    # there. Where block and halo are as long as the box, the region is the whole axis, so that no
    # cell is there twice.
    for k, (low, high) in enumerate(zip(*block, strict=True)):
        whole = space.cells[k]
        if low == 0 and high == whole:
            a, n = 0, whole
        elif not space.repeats(k):
            a = max(low - halo, 0)
            n = min(high + halo, whole) - a
        elif high - low + 2 * halo >= whole:
            a, n = 0, whole
        else:
            a, n = low - halo, high - low + 2 * halo
        first.append(a)
        known.append(n)
    return Region(tuple(first), tuple(known))


def _along(region: Region, space: Space, block: Block) -> list[Numbers]:
    """Along each axis, the held cells that are in the block."""
    found = []
    for k, (low, high) in enumerate(zip(*block, strict=True)):
        i = (region.first[k] + np.arange(region.known[k])) % space.cells[k]
        found.append(np.flatnonzero((i >= low) & (i < high)))
    return found


def numbered(indices: Sequence[Numbers], lengths: Cells) -> Numbers:
    """Numbers of the cells with these places along each axis; x varies fastest."""
    total = np.zeros((1,) * len(lengths), np.int64)
    stride = 1
    for k, (index, length) in enumerate(zip(indices, lengths, strict=True)):
        shape = [1] * len(lengths)
        shape[len(lengths) - 1 - k] = -1
        total = total + (index * stride).reshape(shape)
        stride *= length
    return total.ravel()


def keys(region: Region, space: Space) -> Numbers:
    """The number of every held cell in the whole box."""
    return numbered(_global(region, space), space.cells)


def _global(region: Region, space: Space) -> list[Numbers]:
    return [
        (first + np.arange(known)) % whole
        for first, known, whole in zip(*region, space.cells, strict=True)
    ]


def own(region: Region, space: Space, block: Block) -> Numbers:
    """Numbers, among the held cells, of those in the block."""
    return numbered(_along(region, space, block), region.known)


def shared(mine: Region, theirs: Region, space: Space, block: Block) -> tuple[Numbers, Numbers]:
    """The cells of another rank's block in the halo of this one: their numbers here and there."""
    here = _along(mine, space, block)
    places = _global(mine, space)
    there = [(places[k][index] - theirs.first[k]) % space.cells[k] for k, index in enumerate(here)]
    return numbered(here, mine.known), numbered(there, theirs.known)


def partners(rank: int, blocks: Sequence[Block], space: Space, reach: int) -> list[int]:
    """The other ranks whose blocks are within `reach` cells of the block of a rank."""
    return [
        other
        for other, block in enumerate(blocks)
        if other != rank and any(_overlap(blocks[rank], block, space, reach))
    ]


def _overlap(one: Block, two: Block, space: Space, reach: int) -> Iterator[bool]:
    """Whether two blocks come near one another: as they lie, and across images that slide."""
    inside = [_near(one, two, space, k, reach, space.repeats(k)) for k in range(len(space.cells))]
    yield all(inside)
    if space.slides:
        others = [inside[k] for k in range(2, len(inside))]
        yield all(others) and _near(one, two, space, 1, reach, True)


def _near(one: Block, two: Block, space: Space, k: int, reach: int, wraps: bool) -> bool:
    whole = space.cells[k]
    images = (-whole, 0, whole) if wraps else (0,)
    return any(
        one.low[k] - reach < two.high[k] + image and two.low[k] + image < one.high[k] + reach
        for image in images
    )
