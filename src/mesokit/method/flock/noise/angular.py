"""Angular noise: a bird errs in what it does (Vicsek et al. 1995)."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.method.flock.noise.protocol import TURN, Noise, counted, direction, turned
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.jit import by_type
from mesokit.scalar.random import unit, words
from mesokit.theory.heading_memory import angular_memory
from mesokit.theory.polar_order import CrowdOrder, mean_square_order


@component
class AngularNoise(Noise):
    """The mean direction in reach, turned at random.

    In 2D by an angle uniform in [-strength/2, strength/2] (Vicsek et al., Phys. Rev. Lett. 75, 1226
    (1995)). In 3D to a direction uniform in the cap of the sphere about the mean direction that has
    the same share strength/(2 pi) of all directions (Chate et al., Phys. Rev. E 77, 046113 (2008)).
    """

    rule: Literal["angular"] = tag("angular")
    strength: float = param(
        2.0,
        doc="width of the range of directions: 2 pi is all",
        symbol=r"\eta",
        unit="rad",
        ge=0,
        le=2 * math.pi,
    )

    def kernel(self) -> Angular:
        return Angular(self.strength / (2 * math.pi))

    def memory(self, dimension: int) -> float:
        """sin(strength/2)/(strength/2) in 2D, 1 - strength/(2 pi) in 3D."""
        return angular_memory(self.strength, dimension)

    def crowd(self, dimension: int, number: int) -> CrowdOrder:
        """All turn from one direction: of many birds the order is the memory."""
        memory = max(self.memory(dimension), 0.0)
        return CrowdOrder(memory, math.nan, mean_square_order(memory, number))


class Angular(NamedTuple):
    """Share of all directions."""

    share: float


@counted.register(Angular)
def _(noise):
    return False


@turned.register(Angular)
def _(noise, counter, number, heading, total, around):
    a, b, c, d = words(counter, TURN, number, 0)
    return _turned(noise.share, unit(a, b), unit(c, d), direction(total, heading))


@by_type
def _turned(share, one, other, mean):
    if len(mean) == 2:

        def in_plane(share, one, other, mean):
            turn = share * (one - 0.5)
            s, c = sincos_turn(turn if turn >= 0.0 else turn + 1.0)
            return c * mean[0] - s * mean[1], s * mean[0] + c * mean[1]

        return in_plane

    def in_space(share, one, other, mean):
        # two vectors across the mean: Duff et al., J. Comput. Graph. Tech. 6, 1 (2017)
        x, y, z = mean
        sign = 1.0 if z >= 0.0 else -1.0
        a = -1.0 / (sign + z)
        b = x * y * a
        # uniform in the cap: the cosine is uniform (Archimedes)
        rest = 2.0 * share * one
        along, across = 1.0 - rest, math.sqrt(rest * (2.0 - rest))
        s, c = sincos_turn(other)
        p, q = across * c, across * s
        return (
            along * x + p * (1.0 + sign * x * x * a) + q * b,
            along * y + p * (sign * b) + q * (sign + y * y * a),
            along * z - p * (sign * x) - q * y,
        )

    return in_space
