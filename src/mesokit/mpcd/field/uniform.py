"""The same acceleration everywhere: gravity, or the pressure gradient that drives a channel."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from mesokit.component import component, param, tag
from mesokit.mpcd.field.protocol import acceleration


@component
class Uniform:
    """A uniform acceleration."""

    rule: Literal["uniform"] = tag("uniform")
    acceleration: tuple[float, ...] = param(
        doc="one number for each axis", unit="a/time^2", min_length=2, max_length=3
    )

    @property
    def largest(self) -> float:
        """Largest size of the acceleration."""
        return math.hypot(*self.acceleration)

    def kernel(self, size: tuple[int, ...]) -> Everywhere:
        """Parameters for the scalar function below."""
        return Everywhere(self.acceleration)


class Everywhere(NamedTuple):
    """The same acceleration at every place."""

    vector: tuple[float, ...]


@acceleration.register(Everywhere)
def _(field, r):
    return field.vector
