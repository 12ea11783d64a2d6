"""Ramp: a shear rate that grows evenly from one to another."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.case.shear.two_ramps import InStages, Ramp


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
