"""Speeds that change twice at most, each time at once or evenly, and begin anew with each period.

Start-up, cessation, ramp and step strain are all of this kind, so that one kernel serves them.
"""

from abc import abstractmethod
from collections.abc import Iterator
from typing import NamedTuple

from mesokit.case.component import component, option, show
from mesokit.case.shear.protocol import ShearHistory, slid, speed
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import scalar


class Ramp(NamedTuple):
    """A speed that changes by so much from `begin` to `end`, at once where these are the same."""

    change: float
    begin: float
    end: float


NOTHING = Ramp(0.0, 0.0, 0.0)


class TwoRamps(NamedTuple):
    """The speed before the ramps, and the period after which it is that again, 0 for never."""

    before: float
    first: Ramp
    second: Ramp
    period: float


@component
class InStages(ShearHistory):
    """A history of at most three stages, which may begin anew with each period."""

    period: float | None = option(
        default=None,
        doc="the stages begin anew after so long (never unless said)",
        unit="time",
        kw_only=True,
        gt=0,
    )

    @abstractmethod
    def stages(self) -> tuple[float, Ramp, Ramp | None]:
        """The shear rate at first, and how it changes once and, if it does, again."""

    @property
    def largest(self) -> float:
        before, first, second = self.stages()
        later = before + first.change
        return max(map(abs, (before, later, later + (second.change if second else 0.0))))

    @property
    def repeats_after(self) -> float | None:
        return self.period

    def problems(self) -> Iterator[str]:
        """A period that ends before the last change."""
        _, first, second = self.stages()
        end = (second or first).end
        if self.period is not None and self.period <= end:
            yield (
                f"period = {show(self.period)}: expected more than {end:g}, when the shear rate "
                "changes last"
            )

    def kernel(self, height: float) -> TwoRamps:
        before, first, second = self.stages()
        first, second = (
            Ramp(ramp.change * height, ramp.begin, ramp.end) for ramp in (first, second or NOTHING)
        )
        return TwoRamps(before * height, first, second, self.period or 0.0)


@scalar
def changed(ramp, time):
    """By how much the speed has changed at a time."""
    if time >= ramp.end:
        return ramp.change
    if time <= ramp.begin:
        return 0.0
    return ramp.change * (time - ramp.begin) / (ramp.end - ramp.begin)


@scalar
def covered(ramp, time):
    """How far that has gone."""
    if time >= ramp.end:
        return ramp.change * (time - 0.5 * (ramp.begin + ramp.end))
    if time <= ramp.begin:
        return 0.0
    return 0.5 * ramp.change * (time - ramp.begin) * (time - ramp.begin) / (ramp.end - ramp.begin)


@scalar
def covered_once(history, time):
    """How far it goes in the first period."""
    both = covered(history.first, time) + covered(history.second, time)
    return history.before * time + both


@scalar
def periods(history, time):
    """Whole periods that have passed."""
    if history.period > 0.0:
        return floor(time / history.period)
    return 0.0


@speed.register(TwoRamps)
def _(history, time):
    now = time - periods(history, time) * history.period
    return history.before + changed(history.first, now) + changed(history.second, now)


@slid.register(TwoRamps)
def _(history, time):
    passed = periods(history, time)
    once = covered_once(history, time - passed * history.period)
    return passed * covered_once(history, history.period) + once
