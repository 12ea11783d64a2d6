"""Elastic spheres, with the damping of viscoelastic ones."""

import math
from typing import Literal, NamedTuple

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.spheres.soft.pair.protocol import (
    ContactLaw,
    normal_energy,
    normal_force,
    rate_of_now,
)


class Hertz(NamedTuple):
    """Stiffness, damping time and whether it pulls."""

    stiffness: float
    damping: float
    pulls: float


@component
class HertzLaw(ContactLaw):
    """A force F = k (x^(3/2) + (3/2) A x^(1/2) dx/dt) at the overlap x.

    Hertz (1882); the damping is that of viscoelastic spheres (Brilliantov, Spahn, Hertzsch and
    Poschel 1996). The restitution falls with the speed.

    Examples
    --------
    >>> law = HertzLaw(stiffness=1e5)
    >>> round(law.contact_time_of(0.5, 1.0) / law.overlap_of(0.5, 1.0), 6)
    2.943275
    """

    rule: Literal["hertz"] = tag("hertz")
    stiffness: float = param(
        1e6, doc="k, force over overlap^(3/2)", unit="mass/(length^1/2 time^2)", gt=0, le=1e15
    )
    damping: float = param(0.0, doc="A, a time of the material", unit="time", ge=0, le=1e9)
    pulls: bool = param(True, doc="whether the damping may pull at the end of a contact")

    def normal(self) -> Hertz:
        return Hertz(self.stiffness, self.damping, float(self.pulls))

    def largest_force(self, case: Case) -> float:
        diameter = max(kind.diameter for kind in case.spheres.kinds)
        return float(self.stiffness * (diameter * case.spheres.scale(case.box)) ** 1.5)

    def contact_time_of(self, mass: float, speed: float) -> float:
        """How long a collision takes without damping."""
        return theory.hertz_contact(self.stiffness, mass, speed).time

    def overlap_of(self, mass: float, speed: float) -> float:
        return theory.hertz_contact(self.stiffness, mass, speed).overlap

    def restitution_of(self, mass: float, speed: float) -> float:
        """Restitution of slow collisions: 1 - 1.15344 (3/2) A (k/m)^(2/5) v^(1/5) (Schwager and
        Poschel 1998)."""
        if self.damping == 0.0:
            return 1.0
        slow = (self.stiffness / mass) ** 0.4 * speed**0.2
        return max(0.0, 1.0 - 1.15344 * 1.5 * self.damping * slow)


@normal_force.register(Hertz)
def _(law, overlap, closing, reduced, ratio):
    overlap = max(overlap, 0.0)
    stiffness = 1.5 * law.stiffness * math.sqrt(overlap)
    damping = law.damping * stiffness
    if ratio >= 0.0:
        damping = ratio * math.sqrt(stiffness * reduced)
    spring = stiffness * overlap / 1.5
    rate = rate_of_now(overlap, closing, spring, stiffness, damping, reduced)
    force = spring + damping * rate
    return (force if law.pulls > 0.5 else max(force, 0.0)), stiffness


@normal_energy.register(Hertz)
def _(law, overlap, reduced):
    return 0.4 * law.stiffness * overlap * overlap * math.sqrt(overlap)
