"""Base of the pair laws of soft spheres: potentials of mesokit, and laws of contact.

The first argument of the scalar functions is the NamedTuple of parameters that `normal` returns;
its class selects the implementation.
"""

import math
from abc import ABC, abstractmethod
from typing import Any, Literal, NamedTuple

from mesokit.case.case import Case
from mesokit.case.component import component, param
from mesokit.case.registry import family
from mesokit.potential.protocol import Pair
from mesokit.scalar.jit import generic, scalar

SOLID_SPHERES = 2 / 7  # tangential over normal stiffness: sliding and pressing take equally long


@family("pair law of soft spheres", "rule", "mesokit.soft_pair")
@component
class PairLaw(ABC):  # noqa: B024  each sort of law has its own questions
    """Force law of two soft spheres."""


PairLaw.register(Pair)  # type: ignore[type-abstract]


@component
class ContactLaw(PairLaw):
    """Force law of two spheres that touch: a force along the normal, which a subclass gives,
    friction and resistance to rolling (Cundall and Strack 1979; Luding 2008)."""

    friction: float = param(
        0.0,
        doc="Coulomb's coefficient: largest tangential over normal force",
        ge=0,
        le=1e6,
        kw_only=True,
    )
    tangential: Literal["history", "viscous"] = param(
        "history",
        doc="'history': a spring along the surface, which remembers how far it slid (Cundall and "
        "Strack 1979); 'viscous': a dashpot alone (Haff and Werner 1986)",
        kw_only=True,
    )
    tangential_stiffness: float = param(
        SOLID_SPHERES,
        doc="of the spring along the surface, over the normal stiffness",
        gt=0,
        le=10,
        kw_only=True,
    )
    tangential_damping: float = param(
        0.2,
        doc="of the dashpot along the surface, over sqrt(normal stiffness * reduced mass)",
        ge=0,
        le=10,
        kw_only=True,
    )
    rolling: float = param(
        0.0,
        doc="coefficient of rolling resistance: largest torque over normal force and radius",
        ge=0,
        le=1e6,
        kw_only=True,
    )

    @abstractmethod
    def normal(self) -> Any:
        """Parameters for the scalar functions below."""

    @abstractmethod
    def largest_force(self, case: Case) -> float:
        """Force at an overlap of a whole diameter, about; quanta of force are a part of it."""

    @abstractmethod
    def contact_time_of(self, mass: float, speed: float) -> float:
        """Duration of a collision at this relative speed, of this reduced mass."""

    @abstractmethod
    def overlap_of(self, mass: float, speed: float) -> float:
        """The largest overlap of such a collision, without damping."""

    @abstractmethod
    def restitution_of(self, mass: float, speed: float) -> float:
        """Restitution of such a collision."""

    @property
    def elastic(self) -> bool:
        """Whether energy is kept."""
        return self.restitution_of(1.0, 1.0) == 1.0 and self.friction == 0.0 and self.rolling == 0.0

    def width(self, rubs: bool) -> int:
        """Number of components of springs of a contact; `rubs`: walls have their own friction."""
        if self.rolling > 0:
            return 6
        return 3 if (self.friction > 0 or rubs) and self.tangential == "history" else 0


def damping_ratio(restitution: float) -> float:
    """Damping over sqrt(stiffness * mass) of a spring and dashpot that has this restitution.

    >>> damping_ratio(1.0)
    0.0
    """
    if restitution == 1.0:
        return 0.0
    log = math.log(restitution)
    return -2.0 * log / math.hypot(math.pi, log)


class Closing(NamedTuple):
    """Growth of an overlap per time: `now`, with the forces of the last step; `before`: mean over
    the step; half: half the time of a step (0: springs do not change)."""

    now: float
    before: float
    half: float


@generic
def normal_force(law, overlap, closing, reduced, ratio):
    """Force along the normal at an overlap (below 0: a gap), and the stiffness.

    `closing`: growth of the overlap; `reduced`: reduced mass; `ratio`: damping ratio of a surface
    that has its own, else -1.
    """


@scalar
def rate_of_now(overlap, closing, spring, stiffness, damping, reduced):
    """The growth of an overlap per time, to second order in the step: `closing.now`, and half a
    step of the change of the pair's own force; at the first touch all of this force is new."""
    per_mass = closing.half / reduced
    grown = 2.0 * closing.half * closing.before
    more = -spring
    if overlap > grown:
        more = damping * (2.0 * closing.before - closing.now) - stiffness * grown
    return (closing.now + per_mass * more) / (1.0 + per_mass * damping)


@generic
def normal_energy(law, overlap, reduced):
    """Energy of the spring along the normal."""
