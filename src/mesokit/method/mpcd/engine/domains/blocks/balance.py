"""When and where to the borders between ranks move, so that all ranks have the same work.

Each rank times its own work, without waiting. The times of a window are sent at a sort and used at
the next one, so no rank waits for them. A branch of the tree whose two sides differ by more than a
limit is cut anew, with all below it. More particles move at a high branch, so its limit is larger.
Source: the tree of cuts of Shojaaee, Shaebani, Brendel, Torok and Wolf, J.
Comput. Phys. 231, 612 (2012): sigma_T = sqrt(<T^2> - <T>^2) / <T> of the branches of a node.
"""

import contextlib
import time
import weakref
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.loops.clock import BEADS, CELLS, FIRST
from mesokit.method.mpcd.engine.domains.blocks.tree import Block, Node, Tree
from mesokit.scalar.system import TICK

HIGHER = 0.5  # of the limit, more for each level above the lowest branches
PATIENCE = 1  # windows after a move that are not looked at
LEAST = 0.02  # seconds of work: a shorter window is too noisy


class Balance:
    """Times of the work of all ranks, and the number of moves of borders.

    `limit` is the relative difference of the branches of a node above which borders move.
    """

    def __init__(self, comm: Any, limit: float) -> None:
        self.comm, self.limit = comm, limit
        self.moves = 0
        self.first = self.last = np.nan  # imbalance of the first and the last window
        self._times, self._earlier = np.zeros(comm.size), np.zeros(0)
        self._pending: list[Any] = []
        weakref.finalize(self, finish_agreement, self._pending)
        self._wait = 1  # windows to let pass: the first has the compiling in it

    def send_time(self, seconds: float) -> None:
        """Begin to send the work of this rank in the last window, in seconds, to all ranks."""
        self._own = np.array([seconds])
        self._pending.append(self.comm.Iallgather(self._own, self._times))

    def received_times(self) -> list[NDArray[np.float64]]:
        """Times (ranks,) of the last two windows, the same on all ranks; empty if there are none.

        Two windows, because one alone may be an accident.
        """
        if not finish_agreement(self._pending):
            return []
        if self._wait > 0:
            self._wait -= 1
            return []
        earlier, times = self._earlier, self._times.copy()
        if times.mean() < LEAST:
            return []
        self.last = imbalance(times)
        if np.isnan(self.first):
            self.first = self.last
        self._earlier = times
        return [earlier, times] if len(earlier) else []

    def moved(self) -> None:
        """Note that borders have moved: times of the present window are of the old borders."""
        self.moves += 1
        finish_agreement(self._pending)
        self._wait, self._earlier = PATIENCE, np.zeros(0)


def finish_agreement(pending: list[Any]) -> bool:
    """Wait for the times of all ranks, if they are on their way; also where a run ends."""
    if not pending:
        return False
    pending.pop().Wait()
    return True


def imbalance(times: NDArray[np.float64]) -> float:
    """Most over mean."""
    return float(times.max() / times.mean()) if times.mean() > 0 else 1.0


def relative_spread(node: Node, windows: Sequence[NDArray[np.float64]]) -> float:
    """sigma_T of the two branches of a node, from the mean times of their ranks: the least of some
    windows, 0 if these do not agree on which side has more to do."""
    few, found = node.ranks // 2, []
    for times in windows:
        low = times[node.first : node.first + few].mean()
        high = times[node.first + few : node.first + node.ranks].mean()
        found.append(float((high - low) / (high + low)) if high + low > 0 else 0.0)
    agreed = all(x > 0 for x in found) or all(x < 0 for x in found)
    return min(abs(x) for x in found) if agreed else 0.0


def still_good(tree: Tree, windows: Sequence[NDArray[np.float64]], limit: float) -> Tree:
    """The nodes whose branches differ by less than their limits, and so do those above them."""
    kept: list[tuple[Node, ...]] = []
    bad: list[tuple[int, int]] = []  # ranks of branches that are cut anew
    # From the root down: below a branch that is cut anew no plane stays, because it would divide
    # another block. All ranks have the same times, so all keep the same nodes.
    for n, level in enumerate(tree.nodes):
        above = len(tree.nodes) - 1 - n
        stay = []
        for node in level:
            inside = any(a <= node.first < b for a, b in bad)
            if inside or relative_spread(node, windows) > min(limit * (1.0 + HIGHER * above), 1.0):
                bad.append((node.first, node.first + node.ranks))
            else:
                stay.append(node)
        kept.append(tuple(stay))
    return Tree(tuple(kept), tree.blocks)


class Load:
    """The work in each cell of a rank's block, as whole numbers of nanoseconds."""

    def __init__(self, block: Block, cells: NDArray[np.float64], comm: Any) -> None:
        self.block, self.comm = block, comm
        self.cells = np.rint(cells * 1e9).astype(np.int64).reshape(block.lengths[::-1])

    def layers(self, wanted: Sequence[tuple[Block, int]]) -> list[NDArray[np.float64]]:
        """The work of all ranks in the layers of some blocks across an axis."""
        parts = [self._own(block, axis) for block, axis in wanted]
        together = np.concatenate([np.zeros(0, np.int64), *parts])
        total = np.empty_like(together)
        self.comm.Allreduce(together, total)
        ends = np.cumsum([len(part) for part in parts])
        return [
            total[end - len(part) : end].astype(float)
            for end, part in zip(ends, parts, strict=True)
        ]

    def _own(self, block: Block, axis: int) -> NDArray[np.int64]:
        out, d = np.zeros(block.lengths[axis], np.int64), len(block.low)
        low = [max(a, b) for a, b in zip(block.low, self.block.low, strict=True)]
        high = [min(a, b) for a, b in zip(block.high, self.block.high, strict=True)]
        if all(a < b for a, b in zip(low, high, strict=True)):
            inside = tuple(
                slice(low[k] - self.block.low[k], high[k] - self.block.low[k])
                for k in reversed(range(d))
            )
            others = tuple(n for n in range(d) if n != d - 1 - axis)
            start = low[axis] - block.low[axis]
            out[start : start + high[axis] - low[axis]] = self.cells[inside].sum(axis=others)
        return out


class Window:
    """Seconds of the first thread: `work` in all, of which for `cells`, `beads` and `particles`.

    Work is time of the thread on a core without waiting for messages, so other programs on the
    machine do not count.
    """

    def __init__(self) -> None:
        self.work = self.cells = self.beads = 0.0

    @property
    def particles(self) -> float:
        """Seconds of work that is neither for cells nor for beads."""
        return max(self.work - self.cells - self.beads, 0.0)

    @contextlib.contextmanager
    def timing(self, engine: Any) -> Iterator[None]:
        """Count the work that is done in this context."""
        clock, waits = engine.threads.clock, waiting(engine.memory)
        stages, waited = clock[FIRST:].copy(), [int(post[2]) for post in waits]
        began = time.thread_time()
        yield
        idle = [TICK * (int(post[2]) - before) for post, before in zip(waits, waited, strict=True)]
        spent = time.thread_time() - began
        gone = TICK * (clock[FIRST:] - stages)
        work, beads = max(spent - sum(idle), 0.0), max(float(gone[BEADS]) - sum(idle[1:]), 0.0)
        busy = max(float(gone.sum()) - sum(idle), 1e-12)  # by the clock on the wall
        self.work += work
        self.cells += work * min(float(gone[CELLS]) / busy, 1.0)
        self.beads += work * min(beads / busy, 1.0)


def waiting(memory: Any) -> list[Any]:
    """The counters of ticks of waiting: for cells, and for beads."""
    found = [memory.fluid.cells.shared.post.waited]
    return found + ([memory.solutes.halo.post.waited] if memory.solutes else [])
