"""Forces of spheres that touch: along the normal, along the surface, and against rolling.

What one sphere of a contact finds is bit for bit minus what the other does, for all the same
numbers come in, with the other sign or in another order of two terms. Pairs that will touch within
half a step have a force as well, of the dashpot alone.
"""

import math
from typing import Any, NamedTuple

from mesokit.method.spheres.soft.engine.acting import ahead, quantum, turns
from mesokit.method.spheres.soft.engine.contact.spring import Slider, Springs, stretched
from mesokit.method.spheres.soft.engine.contact.sums import opposite
from mesokit.method.spheres.soft.engine.geometry import reach, row
from mesokit.method.spheres.soft.engine.groups import INVERSE
from mesokit.method.spheres.soft.pair.protocol import Closing, normal_energy, normal_force
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added, added_scaled, dot, outer, scaled

NONE = (0.0, 0.0, 0.0)
DAMPING_RATIO, FRICTION, OWN = 0, 1, 2  # columns of `Walls.own`, and their number


class Contact(NamedTuple):
    """The law of a contact.

    normal: force along the normal; stiffness, damping: of the spring along the surface, over the
    normal stiffness and over sqrt(normal stiffness * mass); friction: Coulomb's coefficient;
    memory: 1 for a spring along the surface, 0 for the dashpot alone; rolling: its coefficient;
    ahead: how far spheres may come nearer in half a step; quantum and its inverse.
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
    """One contact, as one of the two spheres sees it.

    overlap; normal: from the other to this; reduced: mass; arm: radius of this; roller: reduced
    radius; closing: how fast the overlap grows; velocity: of this against the other at the contact;
    turning: difference of the angular velocities; ratio, friction: of damping and of Coulomb.
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


@quantum.register(Contact)
def _(law):
    return law.quantum


@ahead.register(Contact)
def _(law):
    return law.ahead


@turns.register(Contact)
def _(law):
    return True


class Body(NamedTuple):
    """One of the two of a contact: radius, inverse mass, the velocity that dashpots see, the
    velocity and the angular velocity."""

    reach: float
    inverse: float
    seen: tuple[float, float, float]
    velocity: tuple[float, float, float]
    spin: tuple[float, float, float]


@scalar
def body(bodies, seen, i):
    """Sphere i, whose dashpots see velocities `seen`."""
    velocity = row(bodies.velocity, i)
    return Body(
        reach(bodies, i), bodies.velocity[i, INVERSE], row(seen, i), velocity, row(bodies.spin, i)
    )


class Meeting(NamedTuple):
    """Two spheres of a contact: their radii, the sum of their inverse masses, the difference of the
    velocities that dashpots see and of those there are, the sum of radii times angular velocities,
    and the difference of the angular velocities."""

    reach: float
    other: float
    inverse: float
    foreseen: tuple[float, float, float]
    velocity: tuple[float, float, float]
    rolled: tuple[float, float, float]
    turning: tuple[float, float, float]


@scalar
def meeting(one, other):
    """All that a contact of two spheres depends on, except their places."""
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
    """The contact of one sphere with another, which is `separation` off, half a step long."""
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
    """Force on the sphere, the cross products of the normal with the force along the surface and
    with that against rolling, and what is remembered. The other sphere has minus the first and the
    third, and the second as it is."""

    force: tuple[float, float, float]
    along: tuple[float, float, float]
    against: tuple[float, float, float]
    springs: Springs


@scalar
def answer(law, touch, springs, step, rolls):
    """Force and torque of a contact, and its springs after a step; `rolls`: rolling is resisted."""
    normal_part, stiffness = normal_force(
        law.normal, touch.overlap, touch.closing, touch.reduced, touch.ratio
    )
    force, along, against = scaled(normal_part, touch.normal), NONE, NONE
    slid, rolled = NONE, NONE
    if touch.overlap > 0.0:
        damping = law.damping * math.sqrt(stiffness * touch.reduced)
        if touch.friction > 0.0:
            sliding = added_scaled(touch.velocity, -dot(touch.velocity, touch.normal), touch.normal)
            slider = Slider(
                law.memory * law.stiffness * stiffness, damping, touch.friction * abs(normal_part)
            )
            drag, slid = stretched(slider, springs.sliding, sliding, touch.normal, step)
            force, along = added(force, drag), outer(touch.normal, drag)
        if rolls:
            # how fast surfaces would slip if they did not roll (Luding 2008, eq. 22)
            rolling = scaled(-touch.roller, outer(touch.turning, touch.normal))
            slider = Slider(law.stiffness * stiffness, damping, law.rolling * abs(normal_part))
            drag, rolled = stretched(slider, springs.rolling, rolling, touch.normal, step)
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
    back = Answer(found.force, found.along, opposite(found.against), found.springs)
    return torque_of(touch, back, arm, rolls)


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
        slider = Slider(
            law.memory * law.stiffness * stiffness,
            law.damping * math.sqrt(stiffness * touch.reduced),
            touch.friction * abs(normal_part),
        )
        sliding = added_scaled(touch.velocity, -dot(touch.velocity, touch.normal), touch.normal)
        along, _ = stretched(slider, springs.sliding, sliding, touch.normal, 0.0)
        force = added(force, along)
        energy += 0.5 * slider.stiffness * dot(springs.sliding, springs.sliding)
    if law.rolling > 0.0:
        energy += 0.5 * law.stiffness * stiffness * dot(springs.rolling, springs.rolling)
    return energy, force
