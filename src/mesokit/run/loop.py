"""The loop of a run: from one meeting of replicas and ranks to the next."""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from time import perf_counter

from mesokit.case.kind import note_run
from mesokit.case.run import Run
from mesokit.kernels.kept import counts
from mesokit.processes.alone import Coming, Order
from mesokit.processes.signals import Stopped
from mesokit.processes.world import World
from mesokit.report.progress import Reporter
from mesokit.run.callbacks import Callbacks
from mesokit.run.folder import Folder
from mesokit.run.replicas import Replicas
from mesokit.run.schedule import Leg, Schedule
from mesokit.run.stop import Stop
from mesokit.seam.engine import Interrupted
from mesokit.seam.method import absorbed_words

SILENT = 0.7  # seconds of compiling without a message
CALL_SECONDS = 0.2  # of compiled code at a time, so that Ctrl-C and the progress bar are prompt


class Loop:
    """Steps, samples, frames, callbacks and checkpoints, each when it is due.

    A callback may replace `schedule` and `folder` (None if nothing is written) during the run;
    `call` calls the callbacks that are due.
    """

    def __init__(
        self,
        ranks: World,
        schedule: Schedule,
        replicas: Replicas,
        callbacks: Callbacks,
        stop: Stop,
        call: Callable[[], str | None],
    ) -> None:
        self.ranks, self.schedule, self.replicas = ranks, schedule, replicas
        self.callbacks, self.stop, self.call = callbacks, stop, call
        self.folder: Folder | None = None
        self.absorbed = ""  # what was said of a state that nothing can change

    def tell(self, last: int, progress: Reporter) -> None:
        """Report that the run goes on to a step."""
        case = self.schedule.case
        number = sum(group.number for group in case.groups)
        progress.start(last, number, "running", self.replicas.step, case.noun)

    def compile(self, progress: Reporter) -> None:
        """Load or compile the kernels, with a message if it takes long. A signal ends it at once.

        Rank 0 does so first and keeps them for the other ranks.
        """
        engine = self.replicas.first.engine
        with self.stop.at_once(engine.step), telling(progress.compiling), swallowed(Stopped):
            self.ranks.on_root(lambda: engine.advance(0))
            engine.advance(0)
        note_run(self.schedule.case)

    # Between two meetings replicas and ranks do their steps without waiting for one another. At a
    # meeting they write a frame, call a callback or write a checkpoint; or they receive signals and
    # move the progress bar. Rank 0 decides at which step the next meeting is, by its clock and the
    # signals received. It sends this before the steps to the present meeting, so the message has
    # arrived when the other ranks need it. A signal may act one meeting late, but no step waits.
    def run(self, last: int, progress: Reporter) -> None:
        """Go on to a step, unless the run stops before; write a checkpoint before its end."""
        if self.replicas.step == self.schedule.warmup and not self.replicas.looked:
            self._go([self.schedule.leg(0, self.schedule.warmup)])
        self.callbacks.stopped = None
        self._call_back()
        pace = Pace(self.schedule.case.run)
        coming = self._ahead(pace, self.replicas.step, last)
        while (step := self.replicas.step) < last and not self.stop.due:
            order, began = coming(), perf_counter()
            if order.stop:
                self.stop.by = signal.Signals(order.stop)
                break
            coming = self._ahead(pace, order.target, last)
            try:
                self._go(self.schedule.legs(step, order.target))
            except Interrupted:
                self.stop.by = self.stop.heard
                break
            pace.went(self.replicas.step - step, perf_counter() - began)
            self._call_back()
            self._keep_if_due(order, pace)
            progress.update(self.replicas.step)
            self._tell_absorbed(progress)
        else:
            coming()  # its value is not needed, but the other ranks wait for the message
        if self.folder is not None and self.replicas.step < self.schedule.last_step:
            self.folder.checkpoint(self.replicas)

    def _tell_absorbed(self, progress: Reporter) -> None:
        """Report once that nothing can happen any more. The steps that are left take no time, but
        their samples count: the state lasts."""
        words = absorbed_words(self.replicas.absorbed)
        if words and words != self.absorbed:
            progress.tell(words)
        self.absorbed = words

    def _ahead(self, pace: Pace, step: int, last: int) -> Coming:
        """Send or receive the order for the time after a step."""

        def decide(stop: int) -> Order:
            stops = self.schedule.next_meeting(step), *self.callbacks.next_stops(step)
            return Order(min(step + pace.chunk, last, *stops), pace.save(), stop)

        return self.ranks.ahead(decide, self.stop.number)

    def _go(self, legs: Sequence[Leg]) -> None:
        """Do steps, take samples, and write a frame that is due then."""
        self.replicas.go(legs)
        if self.folder is not None and self.schedule.frame_due(self.replicas.step):
            self.folder.record(self.replicas.first.engine)

    def _call_back(self) -> None:
        """Call callbacks that are due; one that stops the run on any rank stops all ranks."""
        if self.callbacks.due(self.replicas.step):
            reasons = self.ranks.answers(self.call)
            self.callbacks.stopped = next((one for one in reasons if one is not None), None)

    def _keep_if_due(self, order: Order, pace: Pace) -> None:
        """Write a checkpoint that is due by the clock or by steps; a stop writes another one."""
        if self.folder is None or self.stop.due:
            return
        if order.save or self.schedule.checkpoint_due(self.replicas.step):
            self.folder.checkpoint(self.replicas)
            pace.kept()


class Pace:
    """The steps of the next call of compiled code, and the time since the last checkpoint."""

    def __init__(self, run: Run) -> None:
        self.chunk, self.seconds = 1, 60.0 * run.checkpoint_minutes
        self.kept()

    def went(self, steps: int, seconds: float) -> None:
        """Choose the next number of steps from the seconds of these steps."""
        self.chunk = next_chunk(steps, seconds)

    def kept(self) -> None:
        """A checkpoint is written now, or will be after the next steps."""
        self.last = perf_counter()

    def save(self) -> bool:
        """True if a checkpoint is due; the interval restarts, and the caller must write it."""
        due = perf_counter() - self.last > self.seconds
        if due:
            self.kept()
        return due


def next_chunk(steps: int, seconds: float) -> int:
    """The number of steps for a call of CALL_SECONDS, at most four times the present number.

    >>> next_chunk(10, 0.1), next_chunk(10, 0.001), next_chunk(10, 9.0)
    (20, 40, 1)
    """
    return max(1, min(4 * steps, int(steps * CALL_SECONDS / max(seconds, 1e-9))))


@contextlib.contextmanager
def telling(tell: Callable[[str], None]) -> Iterator[None]:
    """Call `tell` with the present activity, if it takes long, and again when it changes."""
    done = threading.Event()
    made, parts, kernels = counts.parts_made, counts.parts_found, counts.kernels_found

    def doing() -> str:
        if counts.parts_made > made or counts.compiles_ahead:
            return "compiling (once; kept for the next runs)"
        if counts.parts_found > parts:
            return "compiling from parts that are kept (once)"
        if counts.kernels_found > kernels:
            return "loading kernels"
        return "loading kernels, or waiting for another process that compiles them"

    def look() -> None:
        last = ""
        while not done.wait(SILENT):
            if (words := doing()) != last:
                tell(words)
            last = words

    threading.Thread(target=look, daemon=True).start()
    try:
        yield
    finally:
        done.set()


@contextlib.contextmanager
def swallowed(kind: type[BaseException]) -> Iterator[None]:
    """Do not print exceptions of a kind that Python drops because C code, such as the compiler,
    cannot pass them on."""
    earlier = sys.unraisablehook
    sys.unraisablehook = lambda raised: (
        None if isinstance(raised.exc_value, kind) else earlier(raised)
    )
    try:
        yield
    finally:
        sys.unraisablehook = earlier
