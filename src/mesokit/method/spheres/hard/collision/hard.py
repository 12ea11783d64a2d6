"""A restitution that does not depend on the speed."""

from __future__ import annotations

from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.hard.collision.protocol import SphereCollision, restitution


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
        """Whether it keeps energy: that of spins as well."""
        rough = self.tangential == 1.0 and self.friction is None
        return self.restitution == 1.0 and (not self.rough or rough)

    @property
    def constant_restitution(self) -> float:
        """The coefficient of restitution, at any speed."""
        return self.restitution

    def kernel(self) -> Constant:
        """Parameters for the scalar function below."""
        return Constant(self.restitution)


class Constant(NamedTuple):
    """The coefficient of restitution."""

    value: float


@restitution.register(Constant)
def _(rule, speed):
    return rule.value
