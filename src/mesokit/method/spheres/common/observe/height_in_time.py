"""Height of the centre of mass of spheres in gravity, in time."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.observe.samples import Samples
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.method import method_of
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result


@component
class HeightInTime(Observable):
    """Height of the centre of mass above the floor, in time.

    Gravity is along one axis, which plates close. Of one hard sphere that bounces on a floor at
    rest the law of its flights is beside it, with a contact time as well.
    """

    quantity: Literal["height-in-time"] = tag("height-in-time")
    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres")
    of_methods_alone: ClassVar[bool] = True
    needs_fluid: ClassVar[bool] = False

    def check(self, case: Case) -> None:
        """Raise CaseError without gravity along one axis that plates close."""
        along = np.flatnonzero(case.spheres.gravity)
        if len(along) != 1 or int(along[0]) not in method_of(case).enclosure.closed_axes(case):
            raise CaseError("height-in-time: expected gravity along one axis, which plates close")


@accumulator_of(HeightInTime)
class HeightInTimeAccumulator(Samples):
    """The series in time."""

    def __init__(self, observable: HeightInTime, case: Case) -> None:
        self.name, self.case = observable.label, case
        self.axis = _axis(case)
        self.gravity = float(case.spheres.gravity[self.axis])
        super().__init__(2)  # height, velocity upwards

    def observe(self, spheres: RunningSpheres) -> None:
        masses, up = spheres.masses(), -math.copysign(1.0, self.gravity)
        place = spheres.positions(unwrapped=True)[:, self.axis]
        height = place if up > 0 else self.case.box.size[self.axis] - place
        velocity = up * spheres.totals()[1][self.axis] / masses.sum()
        self.series.add(spheres.time, [masses @ height / masses.sum(), velocity])
        self.samples += 1

    def result(self) -> Result:
        """The series, with error bars where four runs or more are pooled."""
        time, rows = self.series.time(), self.series.values()
        ball = Ball.of(self.case, rows, self.gravity, self.series.stride)
        expected = None if ball is None else ball.height(time - time[0])
        return Result(
            quantity="height-in-time",
            drawing="path",
            name=self.name,
            x={"time": time},
            value=rows[:, 0],
            error=self.series.error()[:, 0],
            label="height of the centre of mass",
            units={"value": "a", "time": "tau"},
            expected=expected,
            theory="" if ball is None else "bouncing ball",
            comparisons=tuple(self.comparisons(time, rows, ball)),
            samples=self.samples,
            extra={"velocity": rows[:, 1].copy()},
        )

    def comparisons(self, time: Array, rows: Array, ball: Ball | None) -> list[Comparison]:
        """The height at the end, and of one ball how high it would still fly."""
        if not len(time):
            return []
        nan, (height, velocity) = math.nan, rows[-1]
        if ball is None:
            error = float(self.series.error()[-1, 0])
            return [Comparison("height at the end", float(height), error, unit="a")]
        since = time[-1] - time[0]
        known, top = float(ball.height(since)), float(ball.top(since))
        reached = float(height - ball.radius + velocity**2 / (2 * abs(self.gravity)))
        return [
            Comparison("height at the end", float(height), nan, known, "a"),
            Comparison("height above the floor that it still reaches", reached, nan, top, "a"),
        ]


class Ball:
    """One hard sphere that falls from rest, as theory knows it, or would have fallen from there.

    since: time since it was at rest, when one began to look.
    """

    def __init__(self, radius: float, gravity: float, rule: tuple[float, float], first: Array):
        self.radius, self.gravity, (self.restitution, self.contact_time) = radius, gravity, rule
        height, velocity = (float(x) for x in first)
        self.drop = height - radius + velocity**2 / (2 * gravity)
        self.since = -velocity / gravity

    @classmethod
    def of(cls, case: Case, rows: Array, gravity: float, stride: int) -> Ball | None:
        """The ball of a case, None where theory knows nothing of what it does."""
        section, given = case.spheres, case.spheres.instant_collision
        if given is None or given.constant_restitution is None:
            return None
        if case.particles != 1 or section.energy_source or len(case.walls) != 1:
            return None
        plates = case.walls[0]
        floor = plates.lower if gravity < 0 else plates.upper
        contact, e = floor.contact, given.constant_restitution
        if contact is not None:
            e = e if contact.restitution is None else contact.restitution
            if contact.amplitude or contact.temperature is not None:
                return None
        if floor.rule == "diffuse" or stride > 1 or not len(rows) or e == 0:
            return None
        radius = 0.5 * section.kinds[0].diameter * section.scale(case.box)
        ball = cls(radius, abs(gravity), (e, given.contact_time), rows[0])
        return ball if ball.known(case) else None

    def known(self, case: Case) -> bool:
        """Whether it flies below the other plate, and bounces have not come within the contact
        time before one began to look."""
        room = case.box.size[_axis(case)]
        flight = math.sqrt(8 * max(self.drop, 0.0) / self.gravity)
        early = self.since != 0 and flight <= self.contact_time
        return 0 < self.drop < room - 2 * self.radius and not early

    def height(self, since: Any) -> Array:
        """Heights of its centre, so long after one began to look."""
        return self.radius + theory.bounce_path(since + self.since, *self._flights())

    def top(self, since: Any) -> Array:
        """How high above the floor it flies, or has flown, between two bounces."""
        lossy = theory.lossy_bounces(since + self.since, *self._flights())
        return np.asarray(self.drop * self.restitution ** (2.0 * lossy))

    def _flights(self) -> tuple[float, float, float, float]:
        return self.drop, self.gravity, self.restitution, self.contact_time


def _axis(case: Case) -> int:
    """The axis of gravity."""
    return int(np.flatnonzero(case.spheres.gravity)[0])
