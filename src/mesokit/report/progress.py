"""Progress of a run or a film: a bar on a terminal, plain lines in a file, nothing if quiet."""

from __future__ import annotations

import contextlib
import sys
import time
from collections import deque
from typing import TYPE_CHECKING, Any, TextIO

from mesokit.case.amounts import duration_text

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

WINDOW = 10.0  # seconds of the recent past that the rate and the ETA come from
REDRAW = 0.2  # seconds between two states of the bar
FIRST = 1.0  # seconds to measure before the first word about speed
WARM = 0.5  # of them, the last that count: kernels are loaded in the others
STALL = 4.0  # times as long for a step as before: something was compiled, or written
NOTED = 1.0  # seconds without a word from the run, from which on that is looked at


class Rate:
    """Steps per second over the recent past."""

    def __init__(self) -> None:
        self.marks: deque[tuple[float, int]] = deque()

    def add(self, now: float, step: int, window: float = WINDOW) -> None:
        """Note that `step` was reached at the time `now` (seconds); forget what is older."""
        self.marks.append((now, step))
        while len(self.marks) > 2 and self.marks[1][0] <= now - window:
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
        else a line as soon as the speed is known, and then one every `seconds`.

    >>> reporter = Reporter(quiet=True)
    >>> reporter.start(total_steps=10, particles=100)
    >>> reporter.update(10)
    >>> reporter.finish()
    """

    noun = "step"

    def __init__(
        self, quiet: bool = False, stream: TextIO | None = None, seconds: float = 5.0
    ) -> None:
        self.stream = sys.stderr if stream is None else stream
        self.quiet, self.seconds = quiet, seconds
        self.total = self.particles = self.first = self.last = 0
        self.phase = self.line = ""  # what is done, and the last that was said of how far it is
        self.fresh = False  # nothing measured yet, or only the compiler
        self.started = self.began = 0.0  # time of the start, and of the first measured step
        self.next = 0.0  # time of the next line
        self.rate = Rate()
        self.pace: float | None = None  # seconds for a step, between the last two updates
        self.told = 0.0  # time of the last update
        self.bar: Progress | Any = None
        self.task: TaskID | Any = None

    def start(
        self, total_steps: int, particles: int, phase: str = "running", step: int = 0
    ) -> None:
        """A phase of the run begins at `step` of `total_steps`."""
        self.total, self.particles, self.phase = total_steps, particles, phase
        self.first = self.last = step
        self.started = time.monotonic()
        self._measure_anew(step)
        if self.quiet:
            return
        if self.has_bar():
            self._open_bar()
        else:
            self._say(f"{phase}: {self.amount(total_steps - step)}")

    def has_bar(self) -> bool:
        """Whether a bar can be redrawn where this tells it."""
        return self.stream.isatty()

    def lengthen(self, total_steps: int) -> None:
        """There is more to do than was thought."""
        self.total = total_steps
        if self.bar is not None and self.task is not None:
            self.bar.update(self.task, total=total_steps)

    def compiling(self, words: str) -> None:
        """Kernels are compiled or loaded: say so, and leave it out of the rates."""
        if self.quiet:
            return
        self.fresh = True
        if self.bar is not None and self.task is not None:
            self.bar.update(self.task, words=words)
        else:
            self._say(words)

    def update(self, step: int) -> None:
        """`step` steps are done. Cheap: call it as often as you like."""
        steps, self.last = step - self.last, step
        if self.quiet:
            return
        if self.fresh:
            self._measure_anew(step)
            return
        now = time.monotonic()
        if self._stalled(now, steps):
            self._measure_anew(step)
            return
        if now < self.next:
            if now < self.began + FIRST:
                self.rate.add(now, step, WARM)
            return
        self.rate.add(now, step)
        if self.bar is not None and self.task is not None:
            self.next = now + REDRAW
            self.bar.update(self.task, completed=step, words=self.words(step))
        else:
            self.next = now + self.seconds
            done = (step - self.first) / max(self.total - self.first, 1)
            line = f"{self.phase}: {100 * done:3.0f} %, {self.words(step)}"
            if line != self.line:  # there is news
                self._say(line)
            self.line = line

    def tell(self, line: str) -> None:
        """Say a line that stays, above the bar if there is one."""
        if self.quiet:
            return
        if self.bar is not None:
            self.bar.console.print(line, markup=False, highlight=False, soft_wrap=True)
        else:
            self._say(line)

    def finish(self) -> None:
        """The phase is over, or the run was stopped."""
        if self.quiet or not self.phase:
            return
        took = duration_text(time.monotonic() - self.started)
        if self.bar is not None and self.task is not None:
            self.bar.update(self.task, completed=self.last, words=took)
            self.bar.stop()
            self.bar = self.task = None
        else:
            self._say(f"{self.phase}: {self.noun} {self.last} of {self.total} after {took}")
        self.phase = ""

    def words(self, step: int) -> str:
        """Rates and the time left."""
        rate = self.rate.steps_per_second
        if not rate:
            return f"{self.noun} {step}"
        return f"{self.speed(rate)}, {duration_text((self.total - step) / rate)} left"

    def amount(self, steps: int) -> str:
        """How much there is to do."""
        return f"{steps} steps of {self.particles} particles"

    def speed(self, rate: float) -> str:
        """So many steps per second, in the units that users compare."""
        return f"{rate:.4g} steps/s, {rate * self.particles / 1e6:.3g} M particle-steps/s"

    def _stalled(self, now: float, steps: int) -> bool:
        """Whether the last steps took so long for another reason: observables are compiled in their
        first sample. What they took says nothing about the rest of the run.
        """
        took, before = now - self.told, self.pace
        self.told, self.pace = now, took / max(steps, 1)
        return took > NOTED and before is not None and self.pace > STALL * before

    def _measure_anew(self, step: int) -> None:
        self.fresh, self.rate = False, Rate()
        self.began = self.told = time.monotonic()
        self.rate.add(self.began, step)
        self.next = self.began + FIRST

    def _say(self, text: str) -> None:
        with contextlib.suppress(OSError):  # a run does not end because nobody can be told of it
            print(text, file=self.stream, flush=True)

    def _open_bar(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn

        self.bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(bar_width=16),
            TextColumn("{task.percentage:3.0f} % {task.fields[words]}"),
            console=Console(file=self.stream, highlight=False),
            refresh_per_second=4,
        )
        self.task = self.bar.add_task(self.phase, total=self.total, completed=self.first, words="")
        self.bar.start()


class FilmReporter(Reporter):
    """Tell how the drawing of a film goes: its steps are frames."""

    noun = "frame"

    def amount(self, steps: int) -> str:
        """How much there is to do."""
        return f"{steps} frames"

    def speed(self, rate: float) -> str:
        """Frames per second."""
        return f"{rate:.3g} frames/s"
