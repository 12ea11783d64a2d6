"""A linear spring and a dashpot."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from pydantic import model_validator

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.spheres.soft.pair.protocol import (
    ContactLaw,
    damping_ratio,
    normal_energy,
    normal_force,
    rate_of_now,
)

USUAL_RESTITUTION, USUAL_TIME = 0.8, 0.01


class Linear(NamedTuple):
    """stiffness, per_mass: the stiffness is the first and the second times the reduced mass;
    damping, ratio: the damping is the first and the second times sqrt(stiffness * mass); pulls."""

    stiffness: float
    per_mass: float
    damping: float
    ratio: float
    pulls: float


@component
class SpringDashpot(ContactLaw):
    """A force F = k x + g dx/dt at the overlap x.

    Given by restitution and contact time, the stiffness k and the damping g of a pair are such that
    all pairs have these, whatever their masses; given by stiffness and damping, these are the same
    for all pairs. Without `pulls` the force is cut off where it would pull, at the end of a
    contact: the restitution is then a little larger (Schwager and Poschel 2007).

    Examples
    --------
    >>> law = SpringDashpot(restitution=0.8, contact_time=0.01)
    >>> round(law.restitution_of(0.5, 1.0), 12), round(law.contact_time_of(0.5, 1.0), 12)
    (0.8, 0.01)
    >>> round(SpringDashpot(stiffness=1e5, damping=20).restitution_of(0.5, 1.0), 6)
    0.868805
    >>> round(SpringDashpot(stiffness=1e5, damping=20, pulls=False).restitution_of(0.5, 1.0), 6)
    0.872291
    """

    rule: Literal["spring-dashpot"] = tag("spring-dashpot")
    restitution: float | None = param(
        None,
        doc="normal velocity after over before a collision (0.8 unless said)",
        symbol="e",
        gt=0,
        le=1,
    )
    contact_time: float | None = param(
        None, doc="how long a collision takes (0.01 unless said)", unit="time", ge=1e-9, le=1e9
    )
    stiffness: float | None = param(
        None, doc="of the spring, in place of the contact time", unit="mass/time^2", gt=0, le=1e15
    )
    damping: float | None = param(
        None, doc="of the dashpot, in place of the restitution", unit="mass/time", ge=0, le=1e15
    )
    pulls: bool = param(True, doc="whether the dashpot may pull at the end of a contact")

    @model_validator(mode="after")
    def _one_choice(self) -> SpringDashpot:
        if self.stiffness is None and self.damping is not None:
            raise ValueError("expected a stiffness with the damping")
        if self.stiffness is not None and self.contact_time is not None:
            raise ValueError("expected a contact time or a stiffness, not both")
        if self.damping is not None and self.restitution is not None:
            raise ValueError("expected a restitution or a damping, not both")
        return self

    def normal(self) -> Linear:
        ratio, per_mass = 0.0, 0.0
        if self.damping is None:
            wanted = USUAL_RESTITUTION if self.restitution is None else self.restitution
            ratio = damping_ratio(wanted)
        if self.stiffness is None:
            time = USUAL_TIME if self.contact_time is None else self.contact_time
            per_mass = (math.pi / time) ** 2 / (1 - (ratio / 2) ** 2)
        return Linear(
            self.stiffness or 0.0, per_mass, self.damping or 0.0, ratio, float(self.pulls)
        )

    def constants(self, mass: float) -> tuple[float, float]:
        """Stiffness and damping of a pair of this reduced mass."""
        law = self.normal()
        k = law.stiffness + law.per_mass * mass
        return k, law.damping + law.ratio * math.sqrt(k * mass)

    def largest_force(self, case: Case) -> float:
        box, kinds = case.box, case.spheres.kinds
        heaviest = max(kind.mean_mass(box.dimension) * (1 + kind.spread) ** 3 for kind in kinds)
        k, _ = self.constants(heaviest)
        return k * max(kind.diameter for kind in kinds) * case.spheres.scale(box)

    def contact_time_of(self, mass: float, speed: float) -> float:
        """How long a collision takes; the speed does not matter."""
        return theory.spring_dashpot(*self.constants(mass), mass, self.pulls).time

    def overlap_of(self, mass: float, speed: float) -> float:
        return speed * math.sqrt(mass / self.constants(mass)[0])

    def restitution_of(self, mass: float, speed: float) -> float:
        return theory.spring_dashpot(*self.constants(mass), mass, self.pulls).restitution


@normal_force.register(Linear)
def _(law, overlap, closing, reduced, ratio):
    stiffness = law.stiffness + law.per_mass * reduced
    damping = law.damping + law.ratio * math.sqrt(stiffness * reduced)
    if ratio >= 0.0:
        damping = ratio * math.sqrt(stiffness * reduced)
    spring = stiffness * max(overlap, 0.0)
    rate = closing.now
    if overlap > 0.0:
        rate = rate_of_now(overlap, closing, spring, stiffness, damping, reduced)
    # the dashpot's force begins and ends at once: of a step in which spheres touch or part it acts
    # for as long as they overlap
    change = closing.half * abs(rate)
    if abs(overlap) < change:
        rate *= 0.5 + 0.5 * overlap / change
    elif overlap <= 0.0:
        rate = 0.0
    force = spring + damping * rate
    return (force if law.pulls > 0.5 else max(force, 0.0)), stiffness


@normal_energy.register(Linear)
def _(law, overlap, reduced):
    return 0.5 * (law.stiffness + law.per_mass * reduced) * overlap * overlap
