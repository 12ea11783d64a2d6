"""Hard spheres that attract one another within a distance."""

import math
from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.hard.collision.protocol import (
    SphereCollision,
    next_contact,
    restitution,
    step_of_energy,
    touching,
)
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import dot

ON_EDGE = 1e-12  # of r^2: a pair as near to the edge has just arrived there


class Well(NamedTuple):
    """Depth, width in diameters, and restitution."""

    depth: float
    width: float
    value: float


@component
class SquareWell(SphereCollision):
    """A potential of -depth between touching and `width` diameters; a shoulder where depth < 0.

    A pair gains the depth on entering. It leaves if its energy along the line of centres exceeds
    the depth, and is reflected otherwise.

    Examples
    --------
    >>> SquareWell(depth=1.0, width=1.5).reach
    1.5
    """

    rule: Literal["square-well"] = tag("square-well")
    depth: float = param(
        1.0, doc="energy of a bound pair is minus this", unit="kT", ge=-1e6, le=1e6
    )
    width: float = param(1.5, doc="distance up to which it acts", unit="diameters", gt=1, le=3)
    restitution: float = param(
        1.0, doc="normal velocity after a collision over minus that before", ge=0, le=1
    )

    @property
    def elastic(self) -> bool:
        return self.keeps_energy(self.restitution)

    @property
    def reach(self) -> float:
        return self.width

    @property
    def energy_within(self) -> float:
        return -self.depth

    def kernel(self) -> Well:
        return Well(self.depth, self.width, self.restitution)


restitution.register(Well)(lambda rule, speed: rule.value)


@scalar
def is_inside(rule, r, v, contact):
    """Whether a pair is in the well; on its edge it is if it moves inwards.

    `contact` is the distance at which the spheres touch.
    """
    edge = rule.width * contact
    past = dot(r, r) / (edge * edge) - 1.0
    return past < -ON_EDGE or (past < ON_EDGE and dot(r, v) < 0.0)


@next_contact.register(Well)
def _(rule, r, v, contact, growth):
    # Outside, the time to the edge; inside, to the core, or else to the edge from within: the later
    # root of |r + v t| = edge. The edge does not grow.
    edge = rule.width * contact
    if not is_inside(rule, r, v, contact):
        return touching(r, v, edge, 0.0)
    meets = touching(r, v, contact, growth)
    if meets < math.inf:
        return meets
    a, b, c = dot(v, v), dot(r, v), dot(r, r) - edge * edge
    if a == 0.0:
        return math.inf
    return (math.sqrt(max(b * b - a * c, 0.0)) - b) / a


@step_of_energy.register(Well)
def _(rule, distance, contact):
    # The event is at the edge if the distance is nearer to the edge than to the core.
    return rule.depth, distance > 0.5 * (1.0 + rule.width) * contact
