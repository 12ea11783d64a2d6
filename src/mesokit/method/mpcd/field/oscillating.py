"""A force that oscillates."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.field.protocol import Swing
from mesokit.method.mpcd.field.varying import Varying, factor
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.intrinsics import floor


@component
class OscillatingForce(Varying):
    """Another force times cos(frequency t + phase), t since the start of the warm-up.

    >>> from mesokit import Uniform
    >>> OscillatingForce(Uniform([0.01, 0]), frequency=0.1).largest
    0.01
    """

    rule: Literal["oscillating"] = tag("oscillating")
    frequency: float = param(doc="angular frequency", unit="1/time", gt=0, le=1e6)
    phase: float = param(0.0, doc="at time 0; -90 makes a sine", unit="degrees", ge=-360, le=360)

    def at(self, time: float) -> float:
        return math.cos(self.frequency * time + math.radians(self.phase))

    def swing(self) -> Swing:
        return Swing(self.of, self.frequency, math.radians(self.phase))

    def change(self) -> Cosine:
        return Cosine(self.frequency / (2 * math.pi), self.phase / 360.0)


class Cosine(NamedTuple):
    """Turns in a unit of time, and turns at time 0."""

    turns: float
    phase: float


@factor.register(Cosine)
def _(change, time):
    turns = change.turns * time + change.phase
    _, cosine = sincos_turn(turns - floor(turns))
    return cosine
