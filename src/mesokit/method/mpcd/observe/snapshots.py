"""Positions and velocities of particles at chosen steps."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.box import Axis
from mesokit.case.case import Case
from mesokit.case.component import component, option, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.groups import groups
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import spread_ids

MOST = 8  # pictures side by side


@component
class Snapshots(Observable):
    """Positions and velocities of particles at chosen steps, each as a scatter plot."""

    quantity: Literal["snapshots"] = tag("snapshots")
    in_open_box: ClassVar[bool] = True
    drawing = "snapshots"
    value_label = "positions and velocities"
    units: ClassVar[dict[str, str]] = {"position": "a", "velocity": "a/tau", "time": "tau"}
    steps: Many[int] = param((0, 1, 10), doc="steps after the warm-up, each a multiple of every")
    axes: tuple[Axis, Axis] = param(("x", "y"), doc="the two axes of the pictures")
    particles: int = param(1000, doc="particles shown, evenly spread over their numbers", ge=1)
    every: int = option(default=1, doc="steps between two looks", ge=1, kw_only=True)

    def check(self, case: Case) -> None:
        """Raise CaseError for steps at which no sample is taken."""
        for axis in self.axes:
            case.box.index(axis, "axes")
        if self.axes[0] == self.axes[1]:
            raise CaseError(f"axes = {show(list(self.axes))}: expected two different axes")
        given = f"steps = {show(list(self.steps))}"
        if not 1 <= len(self.steps) <= MOST:
            raise CaseError(f"{given}: expected 1 to {MOST} steps")
        if list(self.steps) != sorted(set(self.steps)) or self.steps[0] < 0:
            raise CaseError(f"{given}: expected steps from 0 on, each once, in order")
        if any(step % self.every for step in self.steps):
            raise CaseError(f"{given}: expected multiples of every = {self.every}")

    def warnings(self, case: Case) -> Iterator[str]:
        if self.steps[-1] > case.run.steps:
            yield (
                f"steps = {show(list(self.steps))}: not all are reached; run.steps = "
                f"{case.run.steps}"
            )


@accumulator_of(Snapshots)
class SnapshotsAccumulator(BlockAccumulator):
    """Samples so far, (steps, particles, 4): two coordinates and two velocities.

    Of pooled runs those of the first are kept: places of two runs have no mean.
    """

    memory: ClassVar[tuple[str, ...]] = ("seen", "times", "looks")
    added: ClassVar[tuple[str, ...]] = ("looks",)

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.columns = [case.box.index(axis) for axis in observable.axes]
        self.ids = spread_ids(observable.particles, case.particles)
        self.seen = np.zeros((0, len(self.ids), 4))
        self.times = np.zeros((0, 2))  # step and time
        self.looks = 0

    def observe(self, fluid: RunningFluid) -> None:
        self.looks += 1
        step = fluid.step - self.case.run.warmup
        if step not in self.observable.steps or step in self.times[:, 0]:
            return
        r, v = fluid.positions(self.ids), fluid.velocities(self.ids)
        row = np.concatenate([r[:, self.columns], v[:, self.columns]], axis=1)
        self.seen = np.concatenate([self.seen, row[None]])
        self.times = np.concatenate([self.times, [[step, fluid.time]]])

    def result(self) -> Result:
        first, second = self.observable.axes
        names = [first, second, f"v_{first}", f"v_{second}"]
        x = {"step": self.times[:, 0].astype(np.int64), "particle": self.ids}
        # the place of each particle's kind in fluid.species; 0 of a fluid of one kind
        ends = np.cumsum([kind.number for kind in groups(self.case)[0].kinds])
        species = np.searchsorted(ends, self.ids, side="right")
        return self.report(
            x | {"component": np.array(names)},
            self.seen.copy(),
            self._comparisons(),
            samples=self.looks,
            extra={
                "time": self.times[:, 1].copy(),
                "species": species.astype(np.int64),
                "size": np.array([self.case.box.size[k] for k in self.columns], float),
            },
        )

    def _comparisons(self) -> Iterator[Comparison]:
        """Of particles that fly freely nothing but the place changes, and that evenly."""
        case, seen = self.case, self.seen
        free = not (case.fluid.collision.acts or setting.driven(case) or case.walls)
        if not free or case.fluid.molecule is not None or len(seen) < 2:
            return
        exact = "exact: only rounding may show"
        change = abs(seen[:, :, 2:] - seen[0, :, 2:]).max()
        yield Comparison("largest change of a velocity", change, 0.0, 0.0, "a/tau", exact)
        if set(self.observable.axes) <= set(case.box.open):
            since = (self.times[:, 1] - self.times[0, 1])[:, None, None]
            flown = seen[:, :, :2] - seen[0, :, :2] - since * seen[0, :, 2:]
            far = abs(flown).max()
            yield Comparison("largest way off free flight", far, 0.0, 0.0, "a", exact)
