"""Forces of spheres that touch: along the normal, along the surface, and against rolling.

The forces on the two spheres of a contact are opposite to the last bit: the same numbers enter
both, with opposite signs or with two terms exchanged. Pairs that will touch within half a step have
the force of the dashpot alone.
"""

import math
from typing import Any, NamedTuple

from mesokit.method.spheres.common.contacts.geometry import reach, row
from mesokit.method.spheres.common.contacts.groups import INVERSE
from mesokit.method.spheres.common.contacts.remembered import Slider, Springs, stretched
from mesokit.method.spheres.soft.engine.acting import turns
from mesokit.method.spheres.soft.pair.protocol import Closing, normal_energy, normal_force
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added, added_scaled, dot, outer, scaled

NONE = (0.0, 0.0, 0.0)
DAMPING_RATIO, FRICTION, OWN = 0, 1, 3  # columns of `Walls.own` before OPENS; number of all


class Contact(NamedTuple):
    """The law of a contact.

    normal: force along the normal; stiffness, damping: of the spring along the surface, over the
    normal stiffness and over sqrt(normal stiffness * mass); friction: Coulomb's coefficient;
    memory: 1 for a spring along the surface, 0 for the dashpot alone; rolling: its coefficient;
    ahead: largest approach of spheres in half a step; quantum of force and its inverse.
    """

    normal: Any
    stiffness: float
    damping: float
    friction: float
    memory: float
    rolling: float
    ahead: float
    quantum: float
    scale: float


class Touch(NamedTuple):
    """One contact of a sphere with another, or with a wall.

    overlap; normal: from the other to this; reduced: mass; arm: radius of this; roller: reduced
    radius; closing: growth of the overlap; velocity: of this relative to the other at the contact;
    turning: difference of the angular velocities; ratio: of damping; friction: of Coulomb.
    """

    overlap: float
    normal: tuple[float, float, float]
    reduced: float
    arm: float
    roller: float
    closing: Closing
    velocity: tuple[float, float, float]
    turning: tuple[float, float, float]
    ratio: float
    friction: float


turns.register(Contact)(lambda law: True)


class Body(NamedTuple):
    """One sphere of a contact: radius, inverse mass, velocity for dashpots along the normal (at the
    end of the step), velocity (at half the step) and angular velocity."""

    reach: float
    inverse: float
    seen: tuple[float, float, float]
    velocity: tuple[float, float, float]
    spin: tuple[float, float, float]


@scalar
def body(bodies, seen, i):
    """Sphere i, with the velocities `seen` (n, 3) for dashpots along the normal."""
    velocity = row(bodies.velocity, i)
    return Body(
        reach(bodies, i), bodies.velocity[i, INVERSE], row(seen, i), velocity, row(bodies.spin, i)
    )


class Meeting(NamedTuple):
    """Two spheres of a contact: their radii, the sum of their inverse masses, the differences of
    `Body.seen` and of velocities, the sum of radii times angular velocities, and the difference of
    the angular velocities."""

    reach: float
    other: float
    inverse: float
    foreseen: tuple[float, float, float]
    velocity: tuple[float, float, float]
    rolled: tuple[float, float, float]
    turning: tuple[float, float, float]


@scalar
def meeting(one, other):
    """The numbers of a contact of two spheres that do not depend on places."""
    return Meeting(
        one.reach,
        other.reach,
        one.inverse + other.inverse,
        added_scaled(one.seen, -1.0, other.seen),
        added_scaled(one.velocity, -1.0, other.velocity),
        added(scaled(one.reach, one.spin), scaled(other.reach, other.spin)),
        added_scaled(one.spin, -1.0, other.spin),
    )


@scalar
def between(law, half, separation, met):
    """The contact of one sphere with another; `half`: half a step, `separation`: from the other."""
    distance = math.sqrt(dot(separation, separation))
    normal, both = scaled(1.0 / distance, separation), met.reach + met.other
    closing = Closing(-dot(met.foreseen, normal), -dot(met.velocity, normal), half)
    velocity = added_scaled(met.velocity, -1.0, outer(met.rolled, normal))
    return Touch(
        both - distance,
        normal,
        1.0 / met.inverse,
        met.reach,
        met.reach * met.other / both,
        closing,
        velocity,
        met.turning,
        -1.0,
        law.friction,
    )


class Surface(NamedTuple):
    """A surface beside a sphere: distance of its centre, normal, velocity of the surface there,
    damping ratio (-1: as of pairs) and friction."""

    distance: float
    out: tuple[float, float, float]
    moves: tuple[float, float, float]
    ratio: float
    friction: float


@scalar
def surface(distance, out, moves, own, w):
    """A surface whose damping ratio and friction are in a row of `own`."""
    return Surface(distance, out, moves, own[w, DAMPING_RATIO], own[w, FRICTION])


@scalar
def at_wall(half, one, there):
    """The contact of a sphere with a surface."""
    out = there.out
    foreseen = added_scaled(one.seen, -1.0, there.moves)
    velocity = added_scaled(one.velocity, -1.0, there.moves)
    closing = Closing(-dot(foreseen, out), -dot(velocity, out), half)
    velocity = added_scaled(velocity, -1.0, outer(scaled(one.reach, one.spin), out))
    return Touch(
        one.reach - there.distance,
        out,
        1.0 / one.inverse,
        one.reach,
        one.reach,
        closing,
        velocity,
        one.spin,
        there.ratio,
        there.friction,
    )


class Answer(NamedTuple):
    """Force on the sphere, cross products of the normal with the force along the surface and with
    that against rolling, and springs. For the other sphere the force and the third change sign."""

    force: tuple[float, float, float]
    along: tuple[float, float, float]
    against: tuple[float, float, float]
    springs: Springs


@scalar
def sliding_of(law, touch, normal_part, stiffness):
    """The slider of friction, and the velocity of the surfaces along one another."""
    damping = law.damping * math.sqrt(stiffness * touch.reduced)
    limit = touch.friction * abs(normal_part)
    slider = Slider(law.memory * law.stiffness * stiffness, damping, limit)
    return slider, added_scaled(touch.velocity, -dot(touch.velocity, touch.normal), touch.normal)


@scalar
def answer(law, touch, springs, step, rolls):
    """Force and torque of a contact, and its springs after a step; `rolls`: rolling is resisted."""
    normal_part, stiffness = normal_force(
        law.normal, touch.overlap, touch.closing, touch.reduced, touch.ratio
    )
    force, along, against = scaled(normal_part, touch.normal), NONE, NONE
    slid, rolled = NONE, NONE
    if touch.overlap > 0.0:
        slider, sliding = sliding_of(law, touch, normal_part, stiffness)
        if touch.friction > 0.0:
            drag, slid = stretched(slider, springs.sliding, sliding, touch.normal, step)
            force, along = added(force, drag), outer(touch.normal, drag)
        if rolls:
            # The velocity at which surfaces would slip without rolling (Luding 2008, eq. 22).
            rolling = scaled(-touch.roller, outer(touch.turning, touch.normal))
            limit = law.rolling * abs(normal_part)
            roller = Slider(law.stiffness * stiffness, slider.damping, limit)
            drag, rolled = stretched(roller, springs.rolling, rolling, touch.normal, step)
            against = outer(touch.normal, drag)
    return Answer(force, along, against, Springs(slid, rolled))


@scalar
def torque_of(touch, found, arm, rolls):
    """Torque on a sphere of this radius."""
    torque = scaled(-arm, found.along)
    if rolls:
        torque = added_scaled(torque, -touch.roller, found.against)
    return torque


@scalar
def torque_on_other(touch, found, arm, rolls):
    """Torque on the other sphere, of this radius."""
    torque = scaled(-arm, found.along)
    if rolls:
        torque = added_scaled(torque, touch.roller, found.against)
    return torque


@scalar
def at_rest(law, touch, springs):
    """Energy of the springs of a contact, and its force; dashpots along the surface count as they
    are, and nothing changes."""
    normal_part, stiffness = normal_force(
        law.normal, touch.overlap, touch.closing, touch.reduced, touch.ratio
    )
    energy = normal_energy(law.normal, touch.overlap, touch.reduced)
    force = scaled(normal_part, touch.normal)
    if touch.friction > 0.0:
        slider, sliding = sliding_of(law, touch, normal_part, stiffness)
        along, _ = stretched(slider, springs.sliding, sliding, touch.normal, 0.0)
        force = added(force, along)
        energy += 0.5 * slider.stiffness * dot(springs.sliding, springs.sliding)
    if law.rolling > 0.0:
        energy += 0.5 * law.stiffness * stiffness * dot(springs.rolling, springs.rolling)
    return energy, force
