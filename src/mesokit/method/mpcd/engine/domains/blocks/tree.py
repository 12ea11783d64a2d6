"""The block of each rank, by recursive bisection, so that planes follow the work.

A node of the tree is a block of cells and the ranks that share it; a plane across its longest side
gives each half of these ranks its part of the work. Leaves are single ranks. Source: Berger and
Bokhari, IEEE Trans. Comput. C-36, 570 (1987); moved while it runs as by Shojaaee, Shaebani,
Brendel, Török and Wolf, J. Comput. Phys. 231, 612 (2012).
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Cells = tuple[int, ...]


class Block(NamedTuple):
    """Cells from `low` to before `high` along each axis."""

    low: Cells
    high: Cells

    @property
    def lengths(self) -> Cells:
        """Number of cells along each axis."""
        return tuple(b - a for a, b in zip(self.low, self.high, strict=True))


class Node(NamedTuple):
    """A block, and the ranks from the first on that share it; cut at a plane across an axis."""

    block: Block
    first: int
    ranks: int
    axis: int
    plane: int

    def halves(self) -> tuple[tuple[Block, int, int], tuple[Block, int, int]]:
        """Block, first rank and number of ranks on both sides of the plane."""
        low, high = list(self.block.low), list(self.block.high)
        high[self.axis] = low[self.axis] = self.plane
        below = Block(self.block.low, tuple(high))
        above = Block(tuple(low), self.block.high)
        few = self.ranks // 2
        return (below, self.first, few), (above, self.first + few, self.ranks - few)


Work = Callable[[Sequence[tuple[Block, int]]], Sequence[NDArray[np.float64]]]


class Tree(NamedTuple):
    """The nodes that are cut, level after level from the root, and the block of each rank."""

    nodes: tuple[tuple[Node, ...], ...]
    blocks: tuple[Block, ...]


def even(blocks: Sequence[tuple[Block, int]]) -> list[NDArray[np.float64]]:
    """The work in each layer of blocks across an axis where all cells are alike."""
    return [np.ones(block.lengths[axis]) for block, axis in blocks]


def divided(
    cells: Cells, ranks: int, weights: Sequence[float], work: Work = even, kept: Tree | None = None
) -> Tree:
    """The tree of blocks for a number of ranks.

    Parameters
    ----------
    cells : tuple of int
        Number along each axis.
    ranks : int
        How many there are.
    weights : sequence of float
        By which lengths are compared: a small one for an axis that is better not cut.
    work : function
        The work in each layer of some blocks across an axis; called once for each level.
    kept : Tree, optional
        Nodes that stay as they are, by level; a node is cut anew if it, or one above it, is not
        among them.

    Raises
    ------
    ValueError
        If there are too few cells.
    """
    found: list[tuple[Node, ...]] = []
    blocks: dict[int, Block] = {}
    open_ = [(Block((0,) * len(cells), tuple(cells)), 0, ranks)]
    # Level by level, because `work` is a reduction over all ranks: one for each level, not for each
    # node. All ranks receive the same integers, so all have the same tree.
    while open_:
        blocks |= {first: block for block, first, number in open_ if number == 1}
        parts = [part for part in open_ if part[2] > 1]
        stay = {node[:3]: node for node in (kept.nodes[len(found)] if kept and parts else ())}
        axes = [_longest(block, weights) for block, _, _ in parts]
        cut = [part not in stay for part in parts]
        loads = iter(work([(p[0], a) for p, a, new in zip(parts, axes, cut, strict=True) if new]))
        level = tuple(
            _cut(part, axis, next(loads)) if new else stay[part]
            for part, axis, new in zip(parts, axes, cut, strict=True)
        )
        if level:
            found.append(level)
        open_ = [half for node in level for half in node.halves()]
    return Tree(tuple(found), tuple(blocks[rank] for rank in range(ranks)))


def _longest(block: Block, weights: Sequence[float]) -> int:
    """The axis to cut across: of equal ones the last, whose layers lie in one piece in memory."""
    lengths = [n * w for n, w in zip(block.lengths, weights, strict=True)]
    return max(range(len(lengths)), key=lambda k: (lengths[k], k))


def _cut(part: tuple[Block, int, int], axis: int, load: NDArray[np.float64]) -> Node:
    """The plane nearest to where each half of the ranks has its part of the work."""
    block, first, ranks = part
    few, cells = ranks // 2, block.lengths[axis]
    if cells < 2:
        raise ValueError(f"a block of {block.lengths} cells for {ranks} ranks")
    upto = np.concatenate([[0.0], np.cumsum(load)])
    share = few / ranks * upto[-1] if upto[-1] > 0 else few / ranks * cells
    upto = upto if upto[-1] > 0 else np.arange(cells + 1.0)
    plane = int(np.argmin(np.abs(upto - share)))
    return Node(block, first, ranks, axis, block.low[axis] + min(max(plane, 1), cells - 1))
