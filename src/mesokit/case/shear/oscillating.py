"""A shear rate that goes as a cosine: small amplitude oscillatory shear, where it is small."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.case.shear.protocol import ShearHistory, slid, speed
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import scalar

TURNS = 0.5 / math.pi  # in a radian


@component
class OscillatingShear(ShearHistory):
    """The shear rate is rate cos(frequency t): what `shear_rate` with `shear_frequency` gives.

    >>> round(float(OscillatingShear(rate=0.1, frequency=2.0).strain_at(math.pi / 4)), 12)
    0.05
    """

    rule: Literal["oscillating"] = tag("oscillating")
    rate: float = param(
        doc="largest shear rate", symbol=r"\dot\gamma_0", unit="1/time", ge=-1e6, le=1e6
    )
    frequency: float = param(doc="angular frequency", symbol=r"\omega", unit="1/time", gt=0, le=1e6)

    @property
    def largest(self) -> float:
        return abs(self.rate)

    @property
    def repeats_after(self) -> float:
        return 2 * math.pi / self.frequency

    def kernel(self, height: float) -> Cosine:
        return Cosine(self.rate * height, self.frequency)


class Cosine(NamedTuple):
    """A speed that is `fastest` times the cosine of `frequency` times the time."""

    fastest: float
    frequency: float


@scalar
def waved(history, time):
    """Sine and cosine of the phase at a time."""
    turns = history.frequency * time * TURNS
    return sincos_turn(turns - floor(turns))


speed.register(Cosine)(lambda history, time: history.fastest * waved(history, time)[1])


@slid.register(Cosine)
def _(history, time):
    return history.fastest / history.frequency * waved(history, time)[0]
