"""At which steps of a run something is due."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.observe.shared.protocol import Observable


class Schedule:
    """When a case samples, writes frames and checkpoints, by the step.

    What is due every n steps is due first where the warm-up ends: the state that the run begins
    with is part of it. Only what is summed up during steps, such as stress, is not yet there then.

    >>> from mesokit import Box, Case, Conservation, Run
    >>> run = Run(steps=20, warmup=5)
    >>> case = Case(run=run, box=Box([8, 8]), observe=[Conservation(every=10)])
    >>> schedule = Schedule(case)
    >>> [step for step in range(26) if schedule.due(step)], schedule.next_stop(6)
    ([5, 15, 25], 15)
    """

    def __init__(self, case: Case) -> None:
        self.case, self.warmup = case, case.run.warmup
        self.last_step = case.run.warmup + case.run.steps

    def next_stop(self, step: int) -> int:
        """The next step at which something is due, or the last one."""
        run = self.case.run
        if step < self.warmup:
            stops = [self.warmup]
        else:
            passed = step - self.warmup
            intervals = [observable.every for observable in self.case.observe]
            if self.case.trajectory is not None:
                intervals.append(self.case.trajectory.every)
            stops = [step + every - passed % every for every in intervals]
        if run.checkpoint_every is not None:
            stops.append(step + run.checkpoint_every - step % run.checkpoint_every)
        return min([self.last_step, *stops])

    def due(self, step: int) -> list[Observable]:
        """The observables that take a sample at this step."""
        passed = step - self.warmup
        return [
            observable
            for observable in self.case.observe
            if passed >= bool(observable.measures) and passed % observable.every == 0
        ]

    def frame_due(self, step: int) -> bool:
        """Whether a frame of the trajectory is written at this step."""
        trajectory, passed = self.case.trajectory, step - self.warmup
        return trajectory is not None and passed >= 0 and passed % trajectory.every == 0

    def checkpoint_due(self, step: int, seconds: float) -> bool:
        """Whether a checkpoint is written at this step, so many seconds after the last one."""
        run = self.case.run
        by_steps = run.checkpoint_every is not None and step % run.checkpoint_every == 0
        return by_steps or seconds > 60.0 * run.checkpoint_minutes
