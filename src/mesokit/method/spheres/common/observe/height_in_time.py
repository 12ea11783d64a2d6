"""Height of the centre of mass of spheres in gravity, in time."""

import math
from collections.abc import Iterator
from typing import Any, ClassVar, Literal, Self

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.method.spheres.common.observe.protocol import OfSpheres, Samples, gravity_axis
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Array, Comparison, Result


@component
class HeightInTime(OfSpheres):
    """Height of the centre of mass above the floor, in time.

    Gravity is along one axis, which plates close. Of one hard sphere that bounces on a floor at
    rest the law of its flights is beside it, with a contact time as well.
    """

    quantity: Literal["height-in-time"] = tag("height-in-time")
    drawing, value_label = "path", "height of the centre of mass"
    units: ClassVar[dict[str, str]] = {"value": "a", "time": "tau"}

    def check(self, case: Case) -> None:
        """Raise CaseError without gravity along one axis that plates close."""
        gravity_axis(case, "height-in-time")


class Ball:
    """One hard sphere that falls from rest on a floor, or would have fallen from there.

    since: time since it was at rest, when one began to look.
    """

    def __init__(self, radius: float, gravity: float, rule: tuple[float, float], first: Array):
        self.radius, self.gravity, (self.restitution, self.contact_time) = radius, gravity, rule
        height, velocity = (float(x) for x in first)
        self.drop = height - radius + velocity**2 / (2 * gravity)
        self.since = -velocity / gravity

    @classmethod
    def of(cls, case: Case, rows: Array, axis: int, stride: int) -> Self | None:
        """The ball of a case; None without a theory of its motion.

        It has to fly below the other plate, and its flights must not have become shorter than the
        contact time before one began to look.
        """
        section, given = case.spheres, case.spheres.instant_collision
        if given is None or given.constant_restitution is None:
            return None
        if case.particles != 1 or section.energy_source or len(case.walls) != 1:
            return None
        gravity, plates = float(section.gravity[axis]), case.walls[0]
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
        flight = math.sqrt(8 * max(ball.drop, 0.0) / ball.gravity)
        early = ball.since != 0 and flight <= ball.contact_time
        below = 0 < ball.drop < case.box.size[axis] - 2 * radius
        return ball if below and not early else None

    def height(self, since: Any) -> Any:
        """Heights of its centre, so long after one began to look."""
        return self.radius + theory.bounce_path(since + self.since, *self._flights())

    def top(self, since: Any) -> Any:
        """Height above the floor of its flight between two bounces."""
        lossy = theory.lossy_bounces(since + self.since, *self._flights())
        return self.drop * self.restitution ** (2.0 * lossy)

    def _flights(self) -> tuple[float, float, float, float]:
        return self.drop, self.gravity, self.restitution, self.contact_time


@accumulator_of(HeightInTime)
class HeightInTimeAccumulator(Samples):
    """The height and the velocity upwards in time."""

    width = 2

    def prepare(self) -> None:
        super().prepare()
        self.axis = gravity_axis(self.case, "height-in-time")
        self.gravity = float(self.case.spheres.gravity[self.axis])

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
        ball = Ball.of(self.case, rows, self.axis, self.series.stride)
        return self.report(
            {"time": time},
            (rows[:, 0], self.series.error()[:, 0]),
            self.comparisons(time, rows, ball),
            expected=None if ball is None else ball.height(time - time[0]),
            theory="" if ball is None else "bouncing ball",
            samples=self.samples,
            extra={"velocity": rows[:, 1].copy()},
        )

    def comparisons(self, time: Array, rows: Array, ball: Ball | None) -> Iterator[Comparison]:
        """The height at the end, and of one ball how high it would still fly."""
        if not len(time):
            return
        height, velocity = rows[-1]
        if ball is None:
            yield Comparison("height at the end", height, self.series.error()[-1, 0], unit="a")
            return
        since, nan = time[-1] - time[0], math.nan
        yield Comparison("height at the end", height, nan, ball.height(since), "a")
        reached = height - ball.radius + velocity**2 / (2 * abs(self.gravity))
        what = "height above the floor that it still reaches"
        yield Comparison(what, reached, nan, ball.top(since), "a")
