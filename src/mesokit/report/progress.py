"""Progress of a run or a film: a bar on a terminal, plain lines in a file, nothing if quiet."""

from __future__ import annotations

import contextlib
import sys
import time
from typing import TYPE_CHECKING, TextIO

from mesokit.case.amounts import duration_text

if TYPE_CHECKING:
    from rich.progress import Progress, Task

WINDOW = 10.0  # seconds of the recent past that the rate and the time left come from
REDRAW = 0.2  # seconds between two states of the bar
FIRST = 1.0  # seconds to measure before the first word about speed
WARM = 0.5  # of them, the last that count: kernels are loaded in the others
STALL = 4.0  # times as long for a step as before: something was compiled, or written
NOTED = 1.0  # seconds without a word from the run, from which on that is looked at


class Reporter:
    """Progress of a run, in words.

    Parameters
    ----------
    quiet: write nothing.
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
        self.phase = self.line = ""  # what is done, and the last line that was said of it
        self.what = "particle"  # or "site"
        self.fresh = False  # nothing measured yet, or only the compiler
        self.started = self.began = 0.0  # time of the start, and of the first measured step
        self.now = self.next = 0.0  # time of the last update, and of the next word
        self.pace: float | None = None  # seconds for a step, between the last two updates
        self.bar: Progress | None = None  # it measures, and is drawn on a terminal only
        self.task: Task | None = None

    def start(
        self,
        total_steps: int,
        particles: int,
        phase: str = "running",
        step: int = 0,
        what: str = "particle",
    ) -> None:
        """A phase of the run begins at `step` of `total_steps`; `what` there are so many of."""
        self.total, self.particles, self.phase, self.what = total_steps, particles, phase, what
        self.first = self.last = step
        self.started = self.now = time.monotonic()
        if not self.quiet:
            self._open()
            self._measure_anew()
            self._show("", f"{phase}: {self.amount(total_steps - step)}")

    def lengthen(self, total_steps: int) -> None:
        """Set a larger number of steps."""
        self.total = total_steps
        if self.task is not None:
            self.task.total = total_steps  # `bar.update` would reset the rate

    def compiling(self, words: str) -> None:
        """Write that kernels are compiled or loaded, which does not count in the rates."""
        if not self.quiet:
            self.fresh = True
            self._show(words, words)

    def update(self, step: int) -> None:
        """Set the number of steps done. Cheap: call it as often as you like."""
        steps, self.last = step - self.last, step
        if self.quiet or self.bar is None or self.task is None:
            return
        before, self.now = self.now, time.monotonic()
        took, pace = self.now - before, self.pace
        self.pace = took / max(steps, 1)
        # observables are compiled in their first sample, which is no measure of the rest
        stalled = took > NOTED and pace is not None and self.pace > STALL * pace
        if self.fresh or stalled:
            self._measure_anew()
            return
        warm = self.now < self.began + FIRST
        if self.now < self.next and not warm:
            return
        self.bar.speed_estimate_period = WARM if warm else max(WINDOW, 2 * self.seconds, 2 * took)
        self.bar.advance(self.task.id, step - self.task.completed)
        if not warm:
            self.next = self.now + (REDRAW if self.has_bar() else self.seconds)
            done, words = (step - self.first) / max(self.total - self.first, 1), self.words(step)
            self._show(words, f"{self.phase}: {100 * done:3.0f} %, {words}")

    def tell(self, line: str) -> None:
        """Write a line that stays, above the bar if there is one."""
        if self.bar is not None and self.has_bar():
            self.bar.console.print(line, markup=False, highlight=False, soft_wrap=True)
        elif not self.quiet:
            self._say(line)

    def finish(self) -> None:
        """The phase is over, or the run was stopped."""
        if self.bar is not None and self.task is not None:
            took = duration_text(time.monotonic() - self.started)
            self.task.completed = self.last
            said = f"{self.count()} after {took}"
            self._show(said, f"{self.phase}: {said}")
            self.bar.stop()
        self.bar, self.phase = None, ""

    def words(self, step: int) -> str:
        """Rates and the time left."""
        rate = self.rate()
        if not rate:
            return f"{self.noun} {step}"
        return f"{self.speed(rate)}, {duration_text((self.total - step) / rate)} left"

    def amount(self, steps: int) -> str:
        """How much there is to do."""
        return f"{steps} steps of {self.particles} {self.what}s"

    def count(self) -> str:
        """How much is done."""
        return f"{self.noun} {self.last} of {self.total}"

    def speed(self, rate: float) -> str:
        """So many steps per second, in the units that users compare."""
        return f"{rate:.4g} steps/s, {rate * self.particles / 1e6:.3g} M {self.what}-steps/s"

    def rate(self) -> float | None:
        """Steps per second over the recent past, None until two moments are known."""
        return None if self.task is None else self.task.speed

    def has_bar(self) -> bool:
        """Whether a bar is redrawn in the stream."""
        return self.stream.isatty()

    def _measure_anew(self) -> None:
        assert self.bar is not None and self.task is not None
        self.fresh, self.began, self.next = False, self.now, self.now + FIRST
        self.bar.reset(self.task.id, completed=self.last)
        self.bar.advance(self.task.id, 0)  # the first moment

    def _show(self, words: str, line: str) -> None:
        """The words beside the bar, or elsewhere the line, if there is news in it."""
        if self.bar is not None and self.task is not None and self.has_bar():
            self.bar.update(self.task.id, words=words)
        elif line != self.line:
            self._say(line)
        self.line = line

    def _say(self, text: str) -> None:
        with contextlib.suppress(OSError):  # a run goes on if its progress cannot be written
            print(text, file=self.stream, flush=True)

    def _open(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn

        self.bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(bar_width=16),
            TextColumn("{task.percentage:3.0f} % {task.fields[words]}"),
            console=Console(file=self.stream, highlight=False),
            refresh_per_second=4,
            get_time=lambda: self.now,
            disable=not self.has_bar(),
        )
        self.bar.add_task(self.phase, total=self.total, completed=self.first, words="")
        [self.task] = self.bar.tasks
        self.bar.start()


class FilmReporter(Reporter):
    """Progress of the drawing of a film: its steps are frames."""

    noun = "frame"

    def amount(self, steps: int) -> str:
        return f"{steps} frames"

    def speed(self, rate: float) -> str:
        return f"{rate:.3g} frames/s"
