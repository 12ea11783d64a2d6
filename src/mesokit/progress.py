"""Progress of a run: a bar on a terminal, plain lines in a file, nothing if quiet."""

from __future__ import annotations

import sys
import time
from collections import deque
from typing import TYPE_CHECKING, TextIO

from mesokit.derived import duration_text

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

WINDOW = 10.0  # seconds of the recent past that the rate and the ETA come from
REDRAW = 0.2  # seconds between two states of the bar


class Rate:
    """Steps per second over the recent past."""

    def __init__(self) -> None:
        self.marks: deque[tuple[float, int]] = deque()

    def add(self, now: float, step: int) -> None:
        """Note that `step` was reached at the time `now` (seconds)."""
        self.marks.append((now, step))
        while len(self.marks) > 2 and self.marks[1][0] <= now - WINDOW:
            self.marks.popleft()

    @property
    def steps_per_second(self) -> float | None:
        """None until two moments are known."""
        (start, first), (end, last) = self.marks[0], self.marks[-1]
        return (last - first) / (end - start) if end > start else None


class Reporter:
    """Tell how a run goes.

    Parameters
    ----------
    quiet: say nothing.
    stream: where to (standard error unless said); a terminal gets a bar that is redrawn, anything
        else a line at once and then every `seconds`.

    >>> reporter = Reporter(quiet=True)
    >>> reporter.start(total_steps=10, particles=100)
    >>> reporter.update(10)
    >>> reporter.finish()
    """

    def __init__(
        self, quiet: bool = False, stream: TextIO | None = None, seconds: float = 5.0
    ) -> None:
        self.stream = sys.stderr if stream is None else stream
        self.quiet, self.seconds = quiet, seconds
        self.total = self.particles = self.first = 0
        self.phase = ""
        self.rate = Rate()
        self.spoken = -seconds
        self.bar: Progress | None = None
        self.task: TaskID | None = None

    def start(
        self, total_steps: int, particles: int, phase: str = "running", step: int = 0
    ) -> None:
        """A phase of the run begins at `step` of `total_steps`."""
        self.total, self.particles, self.phase, self.first = total_steps, particles, phase, step
        self.began = time.monotonic()
        self.rate = Rate()
        self.rate.add(self.began, step)
        self.spoken = self.began - self.seconds
        if self.quiet:
            return
        if self.stream.isatty():
            self._draw(step)
        else:
            self._say(f"{phase}: {total_steps - step} steps of {particles} particles")

    def compiling(self) -> None:
        """The first step of a new version takes long: say why."""
        if self.quiet:
            return
        if self.bar is not None and self.task is not None:
            self.bar.update(self.task, words="compiling (once; kept for the next runs)")
        else:
            self._say("compiling (once; kept for the next runs)")

    def update(self, step: int) -> None:
        """`step` steps are done. Cheap: call it as often as you like."""
        if self.quiet:
            return
        now = time.monotonic()
        if self.bar is not None:
            if now - self.spoken >= REDRAW:
                self.rate.add(now, step)
                self.spoken = now
                self._draw(step)
        elif now - self.spoken >= self.seconds or self.rate.steps_per_second is None:
            self.rate.add(now, step)
            self.spoken = now
            self._say(f"{self._share(step)} {self.words(step)}")

    def finish(self) -> None:
        """The phase is over, or the run was stopped."""
        if self.quiet:
            return
        if self.bar is not None:
            self.bar.stop()
            self.bar = self.task = None
        elif self.rate.marks:
            self._say(f"{self.phase}: {duration_text(time.monotonic() - self.began)}")

    def words(self, step: int) -> str:
        """Rates and the time left."""
        rate = self.rate.steps_per_second
        if not rate:
            return f"step {step} of {self.total}"
        left = duration_text((self.total - step) / rate)
        return (
            f"step {step} of {self.total}, {rate:.4g} steps/s, "
            f"{rate * self.particles / 1e6:.3g} million particle-steps/s, {left} left"
        )

    def _share(self, step: int) -> str:
        done = (step - self.first) / max(self.total - self.first, 1)
        return f"{self.phase}: {100 * done:3.0f} %"

    def _say(self, text: str) -> None:
        print(text, file=self.stream, flush=True)

    def _draw(self, step: int) -> None:
        if self.bar is None:
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn

            self.bar = Progress(
                TextColumn("{task.description}"), BarColumn(bar_width=24),
                TextColumn("{task.percentage:3.0f} % {task.fields[words]}"),
                console=Console(file=self.stream), refresh_per_second=4,
            )  # fmt: skip
            self.task = self.bar.add_task(self.phase, total=self.total, words="")
            self.bar.start()
        assert self.task is not None
        self.bar.update(self.task, completed=step, words=self.words(step))
