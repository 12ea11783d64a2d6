"""How many steps are done at a time, and when time has passed for a checkpoint."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mesokit.case.run import Run

CALL_SECONDS = 0.2  # of compiled code at a time, so that Ctrl-C and the progress bar are prompt


class Pace:
    """The steps of the next call, and the time since the last checkpoint."""

    def __init__(self, run: Run) -> None:
        self.chunk, self.seconds = 1, 60.0 * run.checkpoint_minutes
        self.kept()

    def went(self, steps: int, seconds: float) -> None:
        """So many steps took so many seconds."""
        self.chunk = next_chunk(steps, seconds)

    def kept(self) -> None:
        """A checkpoint is written now, or will be after the next steps."""
        self.last = perf_counter()

    def save(self) -> bool:
        """Whether it is time for a checkpoint; who asks will write one."""
        due = perf_counter() - self.last > self.seconds
        if due:
            self.kept()
        return due


def next_chunk(steps: int, seconds: float) -> int:
    """So many steps that the next call takes CALL_SECONDS, growing at most fourfold at a time.

    >>> next_chunk(10, 0.1), next_chunk(10, 0.001), next_chunk(10, 9.0)
    (20, 40, 1)
    """
    return max(1, min(4 * steps, int(steps * CALL_SECONDS / max(seconds, 1e-9))))
