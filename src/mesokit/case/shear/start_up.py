"""Start-up of steady shear: rest, then a steady shear rate."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.case.shear.two_ramps import InStages, Ramp


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
