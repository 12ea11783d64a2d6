"""A finitely extensible bond."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.potential.protocol import Bond, breaks, central


@component
class FENE(Bond):
    """U = -(k R0^2/2) ln(1 - r^2/R0^2): never longer than R0 (Warner 1972)."""

    rule: Literal["fene"] = tag("fene")
    k: float = param(30.0, doc="spring constant of a short bond", unit="kT/a^2", gt=0, le=1e9)
    R0: float = param(1.5, doc="length that the bond cannot reach", unit="a", ge=1e-3, le=1e6)

    @property
    def longest(self) -> float:
        return self.R0

    def kernel(self) -> Finite:
        return Finite(self.k, self.R0 * self.R0)


class Finite(NamedTuple):
    """Spring constant, and square of the length that cannot be reached."""

    k: float
    limit: float


@central.register(Finite)
def _(potential, square):
    left = max(1.0 - square / potential.limit, 1e-12)  # a broken bond stops the run: see `breaks`
    return -0.5 * potential.k * potential.limit * math.log(left), -potential.k / left


breaks.register(Finite)(lambda potential, square: square >= potential.limit)
