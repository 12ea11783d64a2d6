"""The same acceleration everywhere: gravity, or the pressure gradient that drives a channel."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.method.mpcd.field.protocol import Force, acceleration


@component
class Uniform(Force):
    """A uniform acceleration."""

    rule: Literal["uniform"] = tag("uniform")
    acceleration: Many[float] = param(
        doc="one number for each axis", symbol="g", unit="a/time^2", min_length=2, max_length=3
    )

    @property
    def largest(self) -> float:
        return math.hypot(*self.acceleration)

    def uniform(self, dimension: int) -> tuple[float, ...]:
        return self.acceleration

    def vectors(self) -> dict[str, tuple[float, ...]]:
        return {"acceleration": self.acceleration}

    def kernel(self, size: tuple[int, ...]) -> Everywhere:
        return Everywhere(self.acceleration)


class Everywhere(NamedTuple):
    """The same acceleration at every place."""

    vector: tuple[float, ...]


acceleration.register(Everywhere)(lambda field, r: field.vector)
