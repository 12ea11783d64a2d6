"""No collision: particles fly freely, an ideal gas without a viscosity."""

from __future__ import annotations

from typing import ClassVar, Literal, NamedTuple

from mesokit.case.component import component, tag
from mesokit.method.mpcd.collision.protocol import (
    CollisionRule,
    coefficients,
    collide,
    contribute,
    freedom,
)


@component
class NoCollision(CollisionRule):
    """Particles never meet: streaming alone. Only this rule allows a box that is open."""

    rule: Literal["none"] = tag("none")

    acts: ClassVar[bool] = False
    conserves: ClassVar[tuple[str, ...]] = ("mass", "momentum", "energy", "angular momentum")
    rates: ClassVar[dict[int, float]] = {2: 280.0, 3: 190.0}

    def kernel(self, dimension: int, kT: float) -> Free:
        """Parameters for the scalar functions below."""
        return Free()

    def own_sums(self, dimension: int) -> tuple[str, ...]:
        """None."""
        return ()

    def coefficient_count(self, dimension: int, stretched: bool) -> int:
        """How many numbers `coefficients` gives: one, which nobody reads, as records need one."""
        return 1


class Free(NamedTuple):
    """No collision."""


@contribute.register(Free)
def _(rule, counter, who, m, v, r):
    return v, ()


@freedom.register(Free)
def _(rule, n):
    return 0.0


@coefficients.register(Free)
def _(rule, thermostat, variate, chance, cell):
    return (0.0,)


@collide.register(Free)
def _(rule, c, v, r):
    return v
