"""No body force."""

from __future__ import annotations

from typing import ClassVar, Literal, NamedTuple

from mesokit.case.component import component, tag
from mesokit.method.mpcd.field.protocol import Force, acceleration


@component
class NoForce(Force):
    """Particles fly straight."""

    rule: Literal["none"] = tag("none")

    acts: ClassVar[bool] = False

    @property
    def largest(self) -> float:
        return 0.0

    def uniform(self, dimension: int) -> tuple[float, ...]:
        return (0.0,) * dimension

    def kernel(self, size: tuple[int, ...]) -> Zero:
        return Zero()


class Zero(NamedTuple):
    """No acceleration."""


acceleration.register(Zero)(lambda field, r: ())
