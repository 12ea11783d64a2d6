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

    def kernel(self, dimension: int, kT: float) -> Uncollided:
        return Uncollided()

    def own_sums(self, dimension: int) -> tuple[str, ...]:
        return ()

    def coefficient_count(self, dimension: int, stretched: bool) -> int:
        """Numbers that `coefficients` gives: one, which is not read, as records need one."""
        return 1


class Uncollided(NamedTuple):
    """No collision."""


contribute.register(Uncollided)(lambda rule, counter, key, m, v, r: (v, ()))


freedom.register(Uncollided)(lambda rule, n: 0.0)


coefficients.register(Uncollided)(lambda rule, thermostat, variate, chance, cell: (0.0,))


collide.register(Uncollided)(lambda rule, c, v, r: v)
