"""Start-up, cessation, ramp and step strain: shear rates that change once or twice.

Each change is sudden or even in time, and all may begin anew with each period: one kernel is for
all of them.
"""

from abc import abstractmethod
from collections.abc import Iterator
from typing import Literal, NamedTuple

from mesokit.case.component import component, option, param, show, tag
from mesokit.case.shear.protocol import ShearHistory, slid, speed
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import scalar


class Ramp(NamedTuple):
    """A speed that changes by so much from `begin` to `end`, at once where these are the same."""

    change: float
    begin: float
    end: float


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
            Ramp(ramp.change * height, ramp.begin, ramp.end)
            for ramp in (first, second or Ramp(0.0, 0.0, 0.0))
        )
        return TwoRamps(before * height, first, second, self.period or 0.0)


@component
class Cessation(InStages):
    """Cessation: a steady shear rate until `stop`, then none.

    With a `period` shear and rest follow one another.

    >>> history = Cessation(rate=0.1, stop=10.0)
    >>> history.rate_at(9.0), history.rate_at(11.0), float(history.strain_at(15.0))
    (0.1, 0.0, 1.0)
    """

    rule: Literal["cessation"] = tag("cessation")
    rate: float = param(
        doc="shear rate before it ceases", symbol=r"\dot\gamma", unit="1/time", ge=-1e6, le=1e6
    )
    stop: float = param(doc="time of shear", unit="time", gt=0, le=1e9)

    def stages(self) -> tuple[float, Ramp, Ramp | None]:
        return self.rate, Ramp(-self.rate, self.stop, self.stop), None


@component
class StartUp(InStages):
    """Start-up: no shear until `start`, then a steady shear rate.

    With a `period` the shear ceases at its end, and rest and shear follow one another.

    >>> history = StartUp(rate=0.1, start=10.0)
    >>> history.rate_at(9.0), history.rate_at(11.0), float(history.strain_at(15.0))
    (0.0, 0.1, 0.5)
    """

    rule: Literal["start-up"] = tag("start-up")
    rate: float = param(
        doc="shear rate after the start", symbol=r"\dot\gamma", unit="1/time", ge=-1e6, le=1e6
    )
    start: float = param(0.0, doc="time of rest before it", unit="time", ge=0, le=1e9)

    def stages(self) -> tuple[float, Ramp, Ramp | None]:
        return 0.0, Ramp(self.rate, self.start, self.start), None


@component
class ShearRamp(InStages):
    """Ramp: the shear rate goes evenly from `initial` to `rate` from `start` on, for `duration`.

    >>> history = ShearRamp(rate=0.2, start=10.0, duration=20.0)
    >>> history.rate_at(20.0), float(history.strain_at(30.0)), float(history.strain_at(40.0))
    (0.1, 2.0, 4.0)
    """

    rule: Literal["ramp"] = tag("ramp")
    rate: float = param(doc="shear rate after the ramp", unit="1/time", ge=-1e6, le=1e6)
    duration: float = param(doc="time from one shear rate to the other", unit="time", gt=0, le=1e9)
    start: float = param(0.0, doc="time before the ramp", unit="time", ge=0, le=1e9)
    initial: float = param(0.0, doc="shear rate before the ramp", unit="1/time", ge=-1e6, le=1e6)

    def stages(self) -> tuple[float, Ramp, Ramp | None]:
        end = self.start + self.duration
        return self.initial, Ramp(self.rate - self.initial, self.start, end), None


@component
class StepStrain(InStages):
    """Step strain: a shear by `strain` within `duration`, after which the box stays as it is.

    What the stress is afterwards, over the strain, is the relaxation modulus G(t).

    >>> history = StepStrain(strain=0.5, duration=2.0, start=10.0)
    >>> history.rate_at(11.0), float(history.strain_at(11.0)), float(history.strain_at(99.0))
    (0.25, 0.25, 0.5)
    """

    rule: Literal["step-strain"] = tag("step-strain")
    strain: float = param(doc="by how much it is sheared", ge=-1e6, le=1e6)
    duration: float = param(doc="time that this takes", unit="time", gt=0, le=1e9)
    start: float = param(0.0, doc="time of rest before it", unit="time", ge=0, le=1e9)

    def stages(self) -> tuple[float, Ramp, Ramp | None]:
        rate, end = self.strain / self.duration, self.start + self.duration
        return 0.0, Ramp(rate, self.start, self.start), Ramp(-rate, end, end)


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
    return floor(time / history.period) if history.period > 0.0 else 0.0


@speed.register(TwoRamps)
def _(history, time):
    now = time - periods(history, time) * history.period
    return history.before + changed(history.first, now) + changed(history.second, now)


@slid.register(TwoRamps)
def _(history, time):
    passed = periods(history, time)
    once = covered_once(history, time - passed * history.period)
    return passed * covered_once(history, history.period) + once
