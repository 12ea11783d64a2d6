"""Stiffness of a chain: the worm-like chain."""

from __future__ import annotations

from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.potential.protocol import Angle, angular


@component
class Bending(Angle):
    """U = kappa (1 - cos theta), theta the angle between two bonds in a row: 0 where straight."""

    rule: Literal["bending"] = tag("bending")
    kappa: float = param(doc="bending stiffness", unit="kT", ge=0, le=1e9)

    @property
    def stiffness(self) -> float:
        return self.kappa

    def kernel(self) -> Cosine:
        return Cosine(self.kappa)


class Cosine(NamedTuple):
    """U = kappa (1 - cosine)."""

    kappa: float


@angular.register(Cosine)
def _(potential, cosine):
    return potential.kappa * (1.0 - cosine), -potential.kappa
