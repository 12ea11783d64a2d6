"""The course of a run from where it is to its end, whatever comes between."""

from __future__ import annotations

import warnings

from mesokit.case.outside import blaming
from mesokit.processes.signals import catching
from mesokit.report.progress import Reporter
from mesokit.run import record
from mesokit.run.course.loop import Loop
from mesokit.run.longer import require_steps
from mesokit.run.on_ranks import shared_work
from mesokit.run.results import write_results
from mesokit.run.until import Goal, limit_of, next_length


class Course(Loop):
    """It ends with results, with an error on record, or stopped at a checkpoint."""

    def _carry_on(self, steps: int | None, until: str | None, progress: Reporter) -> None:
        goal = None if until is None else Goal.parse(until, self.case)
        ended = self._looked and self.step == self.last_step
        if goal is not None and (ended or (self._looked and self[goal.observable].comparisons)):
            goal.found(self[goal.observable])
        limit = None if steps is None else self.step + require_steps(steps) - self.case.run.warmup
        last = self.last_step
        if limit is not None and goal is None:
            last = limit + self.case.run.warmup
            if last > self.last_step:
                self.lengthen(limit)
        self.log.tell = progress.tell
        if self.step < last or not self._looked:
            self._tell_start(progress, last)
        self._stopped_by = self._asked_by = None
        self.ranks.begin()
        try:
            with blaming(self.case), catching(self._stop):
                if self.step < last:
                    self._compile(progress)
                if self.step < last or not self._looked:
                    self._loop(progress, last)
                if goal is not None:
                    self._reach(goal, limit_of(self.case, limit), progress)
                if self.step == self.last_step:
                    self._end()
        except Exception as error:
            reason, directory = str(error) or repr(error), self.directory
            self.ranks.failed(lambda who: record.note_failed(directory, f"{who}{reason}"))
            raise
        finally:
            progress.finish()
        if self._stopped_by is not None and self.step < max(last, self.last_step):
            raise self._stopped

    def _reach(self, goal: Goal, limit: int, progress: Reporter) -> None:
        """Go on until the goal is reached, or so many steps after the warm-up are done."""
        every = next(o.every for o in self.case.observe if o.label == goal.observable)
        while self.step == self.last_step and not self._asked():
            excess, done = goal.excess(self[goal.observable]), self.case.run.steps
            said = f"{goal.said(self[goal.observable])} after {done} steps"
            if excess <= 1:
                return progress.tell(said)
            if done >= limit:
                return warnings.warn(f"{said}: more is needed", stacklevel=4)
            self.lengthen(next_length(excess, done, every, limit))
            if progress.phase:
                progress.lengthen(self.last_step)
            else:
                self._tell_start(progress, self.last_step)
            self._compile(progress)
            self._loop(progress, self.last_step)

    def _tell_start(self, progress: Reporter, last: int) -> None:
        particles = sum(group.number for group in self.case.groups)
        progress.start(last, particles, "running", self.step)

    def _end(self) -> None:
        self.replicas.check()
        if self.directory is None:
            return
        self.checkpoint()
        spent = {"timings": self.timings, "shared_work": shared_work(self.ranks, self.engine)}
        what = self.directory, self.case, self.results, spent, self.writer
        self.ranks.on_root(lambda: write_results(*what))
