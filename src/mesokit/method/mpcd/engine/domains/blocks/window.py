"""How long a rank has worked since borders were last looked at, and at what."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from typing import Any

from mesokit.loops.clock import BEADS, CELLS, FIRST
from mesokit.scalar.system import TICK


class Window:
    """Seconds of the first thread: `work` in all, of which for `cells`, `beads` and `particles`.

    Work is time that the thread has had a core and has not waited for messages, so that other
    programs on the machine do not count.
    """

    def __init__(self) -> None:
        self.work = self.cells = self.beads = 0.0

    @property
    def particles(self) -> float:
        """What is neither for cells nor for beads."""
        return max(self.work - self.cells - self.beads, 0.0)

    @contextlib.contextmanager
    def timing(self, engine: Any) -> Iterator[None]:
        """Count what is done now."""
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
    """Where the ticks of waiting are counted: for cells, and for beads."""
    found = [memory.fluid.cells.shared.post.waited]
    return found + ([memory.solutes.roster.post.waited] if memory.solutes else [])
