"""At which steps of a run something is due."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.seam.observable import Observable


class Leg(NamedTuple):
    """So many steps, what the last of them measures (`Observable.measures`), and what is done after
    it: what was counted is forgotten where the warm-up ends, and samples are taken by observables
    of these names."""

    steps: int
    measure: frozenset[str]
    ends_warmup: bool
    samples: tuple[str, ...]


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
        if step < self.warmup:
            return self.next_meeting(step)
        intervals = [observable.every for observable in self.case.observe]
        return min([self.next_meeting(step), *self._after(step, intervals)])

    def next_meeting(self, step: int) -> int:
        """The next step at which something is due that replicas do together: a frame, a checkpoint,
        the end of the warm-up or of the run."""
        run, trajectory = self.case.run, self.case.trajectory
        stops = [self.warmup if step < self.warmup else self.last_step]
        if trajectory is not None and step >= self.warmup:
            stops += self._after(step, [trajectory.every])
        if run.checkpoint_every is not None:
            stops.append(step + run.checkpoint_every - step % run.checkpoint_every)
        return min(stops)

    def _after(self, step: int, intervals: list[int]) -> list[int]:
        passed = step - self.warmup
        return [step + every - passed % every for every in intervals]

    def legs(self, step: int, target: int) -> list[Leg]:
        """The way from a step to another one that is no farther than the next meeting, from one
        sample to the next."""
        found = []
        while step < target:
            end = min(self.next_stop(step), target)
            found.append(self.leg(end - step, end))
            step = end
        return found

    def leg(self, steps: int, end: int) -> Leg:
        """So many steps that end at this one."""
        due = self.due(end)
        measure = frozenset(name for observable in due for name in observable.measures)
        return Leg(steps, measure, end == self.warmup, tuple(one.label for one in due))

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

    def checkpoint_due(self, step: int) -> bool:
        """Whether a checkpoint is written at this step, whenever the last one was."""
        every = self.case.run.checkpoint_every
        return every is not None and step % every == 0
