"""The same shear rate at all times."""

from __future__ import annotations

from typing import ClassVar, Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.case.shear.protocol import ShearHistory, slid, speed


@component
class SteadyShear(ShearHistory):
    """A steady shear: what `shear_rate` alone gives.

    >>> float(SteadyShear(rate=0.1).strain_at(5.0))
    0.5
    """

    rule: Literal["steady"] = tag("steady")
    rate: float = param(doc="shear rate", symbol=r"\dot\gamma", unit="1/time", ge=-1e6, le=1e6)

    steady: ClassVar[bool] = True

    @property
    def largest(self) -> float:
        return abs(self.rate)

    def kernel(self, height: float) -> Even:
        return Even(self.rate * height)


class Even(NamedTuple):
    """The same speed at all times."""

    speed: float


speed.register(Even)(lambda history, time: history.speed)


slid.register(Even)(lambda history, time: history.speed * time)
