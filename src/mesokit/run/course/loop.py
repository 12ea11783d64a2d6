"""The loop of a run: from one meeting to the next, as rank 0 has decided."""

from __future__ import annotations

import signal
from collections.abc import Sequence
from time import perf_counter

from mesokit.case.kind import note_run
from mesokit.processes.order import Coming, Order
from mesokit.processes.signals import Stopped
from mesokit.report.progress import Reporter
from mesokit.run.compiling import swallowed, telling
from mesokit.run.course.kept import Kept
from mesokit.run.course.stop import Stop
from mesokit.run.pace import Pace
from mesokit.run.schedule import Leg


class Loop(Stop, Kept):
    """Steps, samples, frames, callbacks and checkpoints, each when it is due."""

    def _compile(self, progress: Reporter) -> None:
        """Load or compile the kernels; say so if it takes long. A signal ends it at once.

        Rank 0 does so first, and the others find what it has kept.
        """
        self._compiling = True
        try:
            with telling(progress.compiling), swallowed(Stopped):
                self.ranks.on_root(lambda: self.engine.advance(0))
                self.engine.advance(0)
            if self._stopped_by is not None:  # a signal that the compiler has not handed on
                raise self._stopped
        except RuntimeError:  # what is left of a kernel then
            if self._stopped_by is None:
                raise
            raise self._stopped from None
        finally:
            self._compiling = False
        note_run(self.case)

    def _loop(self, progress: Reporter, last: int) -> None:
        if self.step == self.case.run.warmup and not self._looked:
            self._go([self.schedule.leg(0, self.step)])
        self.callbacks.stopped = None
        self._call_back()
        pace = Pace(self.case.run)
        coming = self._ahead(pace, self.step, last)
        while self.step < last and not self._stopping:
            order, began, step = coming(), perf_counter(), self.step
            if order.stop:
                self._stopped_by = signal.Signals(order.stop)
                break
            coming = self._ahead(pace, order.target, last)
            self._go(self.schedule.legs(step, order.target))
            pace.went(self.step - step, perf_counter() - began)
            self._call_back()
            if self._checkpoint_due(order):
                self.checkpoint()
                pace.kept()
            progress.update(self.step)
        else:
            coming()
        if self.step < self.last_step and self.directory is not None:
            self.checkpoint()

    def _ahead(self, pace: Pace, step: int, last: int) -> Coming:
        """What is to be done from a step on."""

        def decide(stop: int) -> Order:
            stops = self.schedule.next_meeting(step), *self.callbacks.next_stops(step)
            return Order(min(step + pace.chunk, last, *stops), pace.save(), stop)

        return self.ranks.ahead(decide, self._signal)

    def _call_back(self) -> None:
        """Let callbacks look, if one is due; one that stops the run on any rank stops all."""
        if self.callbacks.due(self.step):
            reasons = self.ranks.answers(lambda: self.callbacks.call(self))
            self.callbacks.stopped = next((one for one in reasons if one is not None), None)

    def _go(self, legs: Sequence[Leg]) -> None:
        """Do steps and take samples, and the frame that is due then."""
        self.replicas.go(legs)
        if self.writer and self.schedule.frame_due(self.step):
            self.writer.record(self.engine)
        self._looked = self.step >= self.case.run.warmup

    def _checkpoint_due(self, order: Order) -> bool:
        if self.directory is None or self._stopping:
            return False
        return order.save or self.schedule.checkpoint_due(self.step)
