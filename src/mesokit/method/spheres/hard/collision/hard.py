"""A restitution that does not depend on the speed."""

from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.hard.collision.protocol import SphereCollision, restitution


class Constant(NamedTuple):
    """The coefficient of restitution."""

    value: float


@component
class HardCollision(SphereCollision):
    """A part of the normal velocity remains, at any speed.

    Examples
    --------
    >>> HardCollision().elastic, HardCollision(0.9).elastic
    (True, False)
    """

    rule: Literal["hard"] = tag("hard")
    restitution: float = param(
        1.0, doc="normal velocity after a collision over minus that before", symbol="e", ge=0, le=1
    )

    @property
    def elastic(self) -> bool:
        return self.keeps_energy(self.restitution)

    @property
    def constant_restitution(self) -> float:
        return self.restitution

    def kernel(self) -> Constant:
        return Constant(self.restitution)


restitution.register(Constant)(lambda rule, speed: rule.value)
