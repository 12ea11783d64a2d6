"""No body force."""

from __future__ import annotations

from typing import Literal, NamedTuple

from mesokit.component import component, tag
from mesokit.mpcd.field.protocol import acceleration


@component
class NoForce:
    """Particles fly straight."""

    rule: Literal["none"] = tag("none")

    @property
    def largest(self) -> float:
        """Largest size of the acceleration."""
        return 0.0

    def kernel(self, size: tuple[int, ...]) -> Zero:
        """Parameters for the scalar function below."""
        return Zero()


class Zero(NamedTuple):
    """No acceleration."""


@acceleration.register(Zero)
def _(field, r):
    return ()
