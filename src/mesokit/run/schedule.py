"""Steps of a run at which samples, frames and checkpoints are due."""

from typing import NamedTuple

from mesokit.case.case import Case
from mesokit.seam.observable import Observable


class Leg(NamedTuple):
    """Steps without a pause. The last one measures `measure` (`Observable.measures`). After it the
    warm-up may end, which resets counters, and observables of the names in `samples` sample."""

    steps: int
    measure: frozenset[str]
    ends_warmup: bool
    samples: tuple[str, ...]


class Schedule:
    """Steps at which a case samples, and writes frames and checkpoints.

    Samples every n steps begin at the end of the warm-up, with the state there. Only observables of
    sums over steps, such as stress, begin n steps later.

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
        """The next step at which replicas wait for one another: a frame, a checkpoint, the end of
        the warm-up or of the run."""
        run, trajectory = self.case.run, self.case.trajectory
        stops = [self.warmup if step < self.warmup else self.last_step]
        if trajectory is not None and step >= self.warmup:
            stops.append(self.warmup + trajectory.next_after(step - self.warmup))
        if run.checkpoint_every is not None:
            stops.append(step + run.checkpoint_every - step % run.checkpoint_every)
        return min(stops)

    def _after(self, step: int, intervals: list[int]) -> list[int]:
        passed = step - self.warmup
        return [step + every - passed % every for every in intervals]

    def legs(self, step: int, target: int) -> list[Leg]:
        """Legs between samples, from a step to a target no later than the next meeting."""
        found = []
        while step < target:
            end = min(self.next_stop(step), target)
            found.append(self.leg(end - step, end))
            step = end
        return found

    def leg(self, steps: int, end: int) -> Leg:
        """The leg of so many steps that ends at step `end`."""
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
        """True if a frame of the trajectory is written at this step."""
        trajectory = self.case.trajectory
        return trajectory is not None and trajectory.due(step - self.warmup)

    def checkpoint_due(self, step: int) -> bool:
        """True if a checkpoint is written at this step, independently of the clock."""
        every = self.case.run.checkpoint_every
        return every is not None and step % every == 0
