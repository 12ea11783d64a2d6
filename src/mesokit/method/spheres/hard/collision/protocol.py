"""Base of the collision rules of hard spheres, and their compiled functions."""

import math
from abc import ABC, abstractmethod
from typing import Any

from mesokit.case.component import component, option
from mesokit.case.registry import family
from mesokit.scalar.jit import generic, scalar
from mesokit.scalar.vector import dot


@scalar
def touching(r, v, reach, growth):
    """The time after which |r + v t| = reach + growth t from above, infinite if never.

    The branch comes last, when all numbers are there, so that the compiler makes vectors of pairs.
    """
    a = dot(v, v) - growth * growth
    b = dot(r, v) - reach * growth
    c = dot(r, r) - reach * reach
    square = b * b - a * c
    root = math.sqrt(max(square, 0.0))
    if growth != 0.0 and b >= 0.0:
        return (b + root) / -a if c > 0.0 and a < 0.0 and square >= 0.0 else math.inf
    time = max(c, 0.0) / (root - b)
    return time if (b < 0.0) & (square >= 0.0) else math.inf


@family("collision rule of hard spheres", "rule", "mesokit.sphere_collision")
@component
class SphereCollision(ABC):
    """Collision rule of two hard spheres.

    The tangential velocity of the contact after a collision is minus `tangential` times that
    before, unless the impulse would be more than `friction` times the normal one (Walton 1993): -1
    is smooth, 1 perfectly rough.
    """

    tangential: float = option(
        default=-1.0,
        doc="tangential velocity of the contact after over minus before: -1 smooth, 1 rough",
        kw_only=True,
        ge=-1,
        le=1,
    )
    friction: float | None = option(
        default=None,
        doc="largest tangential over normal impulse (no limit unless said)",
        kw_only=True,
        ge=0,
        le=1e6,
    )
    contact_time: float = option(
        default=0.0,
        doc="collisions sooner than this after the last of one of both lose nothing, against "
        "inelastic collapse (Luding and McNamara 1998)",
        unit="time",
        kw_only=True,
        ge=0,
    )

    @abstractmethod
    def kernel(self) -> Any:
        """Parameters for `restitution` below."""

    @property
    @abstractmethod
    def elastic(self) -> bool:
        """Whether it keeps energy."""

    @property
    def constant_restitution(self) -> float | None:
        """Coefficient of restitution of hard spheres if it is the same at any speed, else None."""
        return None

    @property
    def reach(self) -> float:
        """Range of the potential, in diameters."""
        return 1.0

    @property
    def hard(self) -> bool:
        """Whether spheres act on one another only where they touch."""
        return self.reach <= 1.0

    @property
    def energy_within(self) -> float:
        """Potential energy of two spheres nearer than `reach`."""
        return 0.0

    @property
    def rough(self) -> bool:
        """Whether it changes spins."""
        return self.tangential > -1.0 and self.friction != 0.0

    def keeps_energy(self, restitution: float) -> bool:
        """Whether energy, that of spins included, is kept at this restitution."""
        perfectly_rough = self.tangential == 1.0 and self.friction is None
        return restitution == 1.0 and (not self.rough or perfectly_rough)


@generic
def restitution(rule, speed):
    """Normal velocity after over minus that before, of spheres that meet at this speed."""


@generic
def next_contact(rule, r, v, contact, growth):
    """The time after which two spheres have an event, infinite if they have none.

    r and v are relative place and velocity; surfaces meet at the distance contact + growth t.
    """


@generic
def step_of_energy(rule, distance, contact):
    """How much less energy the pair has nearer than this distance, and whether there is such a step
    and not a collision of surfaces."""


next_contact.otherwise(lambda rule, r, v, contact, growth: touching(r, v, contact, growth))
step_of_energy.otherwise(lambda rule, distance, contact: (0.0, False))
