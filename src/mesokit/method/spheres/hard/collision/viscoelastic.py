"""Spheres that lose more the faster they meet."""

import math
from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.hard.collision.protocol import SphereCollision, restitution
from mesokit.scalar.jit import scalar

STEPS = 12  # more than are needed from 1e-60 to 1e60


class Falling(NamedTuple):
    """A, and the least value."""

    dissipation: float
    least: float


@component
class Viscoelastic(SphereCollision):
    """e(v) = 1 - A v^(1/5) + (3/5) A^2 v^(2/5), the first terms of viscoelastic spheres.

    After Schwager and Poeschel (1998), Phys. Rev. E 57, 650, eq. 20; not below `least`. Slow
    collisions are elastic.

    Examples
    --------
    >>> Viscoelastic(dissipation=0.1).elastic
    False
    """

    rule: Literal["viscoelastic"] = tag("viscoelastic")
    dissipation: float = param(0.1, doc="A", unit="(length/time)^(-1/5)", gt=0, le=1e3)
    least: float = param(
        0.0, doc="coefficient of restitution below which it does not fall", ge=0, le=1
    )

    @property
    def elastic(self) -> bool:
        return False

    def kernel(self) -> Falling:
        return Falling(self.dissipation, self.least)


@scalar
def fifth_root(x):
    """x^(1/5) by Newton's steps from x^(3/16), the same bits on any machine.

    >>> fifth_root(32.0), fifth_root(0.0)
    (2.0, 0.0)
    """
    if x <= 0.0:
        return 0.0
    eighth = math.sqrt(math.sqrt(math.sqrt(x)))
    root = eighth * math.sqrt(eighth)
    for _ in range(STEPS):
        square = root * root
        root = 0.8 * root + 0.2 * x / (square * square)
    return root


@restitution.register(Falling)
def _(rule, speed):
    x = rule.dissipation * fifth_root(speed)
    # The series has its minimum at x = 5/6 and is not valid beyond.
    x = min(x, 5.0 / 6.0)
    return max(1.0 - x + 0.6 * x * x, rule.least)
