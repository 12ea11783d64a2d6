"""The time that a rank has worked since the last check of borders, by kind of work."""

import contextlib
import time
from collections.abc import Iterator
from typing import Any

from mesokit.loops.clock import BEADS, CELLS, FIRST
from mesokit.scalar.system import TICK


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
