"""Forces of spheres that touch: along the normal, along the surface, and against rolling.

Where both spheres of a pair are one thread's, the force is found once, from the one before in
memory; else each finds it for itself. Nothing depends on which: what one finds is bit for bit
minus what the other does, for all the same numbers come in, with the other sign or in another order
of two terms. Springs are remembered where they are found; `mirror_springs` tells the other sphere.
Pairs that will touch within half a step have a force as well, of the dashpot alone.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from mesokit.method.soft_spheres.machine.acting import act, ahead, quantum, tell, turns
from mesokit.method.soft_spheres.machine.central import add_product
from mesokit.method.soft_spheres.machine.geometry import from_to, from_wall, reach, row
from mesokit.method.soft_spheres.machine.groups import ENERGY, INVERSE, LARGEST, TOUCHING
from mesokit.method.soft_spheres.machine.lists import ROLLING, SLIDING
from mesokit.method.soft_spheres.machine.spring import Slider, stretched
from mesokit.method.soft_spheres.pair.protocol import Closing, normal_energy, normal_force
from mesokit.scalar.fixed_point import quanta
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added, added_scaled, dot, outer, scaled

DAMPING_RATIO, FRICTION, OWN = 0, 1, 2  # columns of `Walls.own`, and their number


class Contact(NamedTuple):
    """What happens at a contact.

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


@act.register(Contact)
def _(law, i, time, step, world, mine, noted):
    bodies, box, lists, walls = world
    first, last = mine
    r = row(bodies.place, i)
    force, torque = row(bodies.force, i), row(bodies.torque, i)
    largest = 0.0
    for s in range(lists.count[i]):
        j = lists.near[i, s]
        if first <= j <= i:
            continue  # found from there, or the list is filled up with the sphere itself
        way = from_to(box, bodies.place, j, r)
        square, sum_of_radii = dot(way, way), reach(bodies, i) + reach(bodies, j)
        if square < (sum_of_radii + law.ahead) * (sum_of_radii + law.ahead):
            touch = between(law, bodies, bodies.seen, 0.5 * step, i, j, way)
            found = answer(law, touch, lists.springs, i, s, step)
            twisted = torque_of(law, touch, found, touch.arm)
            force = counted(force, found.force, law.scale)
            torque = counted(torque, twisted, law.scale)
            largest = max(largest, abs_sum(found.force), abs_sum(twisted))
            if i < j < last:
                other = Answer(found.force, found.along, opposite(found.against))
                back = torque_of(law, touch, other, reach(bodies, j))
                count(bodies.force, j, opposite(found.force), law.scale)
                count(bodies.torque, j, back, law.scale)
                largest = max(largest, abs_sum(back))
        else:
            forget(lists.springs, i, s)
    for w in range(len(walls.rows)):
        distance, out, moves = from_wall(walls.rows, w, box, r, time)
        if distance < reach(bodies, i) + law.ahead:
            touch = at_wall(walls, bodies, bodies.seen, 0.5 * step, i, w, (distance, out, moves))
            found = answer(law, touch, walls.springs, i, w, step)
            twisted = torque_of(law, touch, found, touch.arm)
            force = counted(force, found.force, law.scale)
            torque = counted(torque, twisted, law.scale)
            largest = max(largest, abs_sum(found.force), abs_sum(twisted))
        else:
            forget(walls.springs, i, w)
    for k in range(3):
        bodies.force[i, k], bodies.torque[i, k] = force[k], torque[k]
    noted[LARGEST] = max(noted[LARGEST], largest * law.scale)


@scalar
def between(law, bodies, seen, half, i, j, way):
    """The contact of sphere i with sphere j, which is `way` off; dashpots see velocities `seen`."""
    distance = math.sqrt(dot(way, way))
    arm, other = reach(bodies, i), reach(bodies, j)
    normal = scaled(1.0 / distance, way)
    spin, spin_of_other = row(bodies.spin, i), row(bodies.spin, j)
    rolled = added(scaled(arm, spin), scaled(other, spin_of_other))
    foreseen = added_scaled(row(seen, i), -1.0, row(seen, j))
    velocity = added_scaled(row(bodies.velocity, i), -1.0, row(bodies.velocity, j))
    closing = Closing(-dot(foreseen, normal), -dot(velocity, normal), half)
    velocity = added_scaled(velocity, -1.0, outer(rolled, normal))
    inverse = bodies.velocity[i, INVERSE] + bodies.velocity[j, INVERSE]
    return Touch(
        arm + other - distance,
        normal,
        1.0 / inverse,
        arm,
        arm * other / (arm + other),
        closing,
        velocity,
        added_scaled(spin, -1.0, spin_of_other),
        -1.0,
        law.friction,
    )


@scalar
def at_wall(walls, bodies, seen, half, i, w, there):
    """The contact of sphere i with a wall: `there` are its distance, normal and velocity."""
    distance, out, moves = there
    arm, spin = reach(bodies, i), row(bodies.spin, i)
    foreseen = added_scaled(row(seen, i), -1.0, moves)
    velocity = added_scaled(row(bodies.velocity, i), -1.0, moves)
    closing = Closing(-dot(foreseen, out), -dot(velocity, out), half)
    velocity = added_scaled(velocity, -1.0, outer(scaled(arm, spin), out))
    mass = 1.0 / bodies.velocity[i, INVERSE]
    ratio, friction = walls.own[w, DAMPING_RATIO], walls.own[w, FRICTION]
    return Touch(arm - distance, out, mass, arm, arm, closing, velocity, spin, ratio, friction)


class Answer(NamedTuple):
    """Force on the sphere, and the cross products of the normal with the force along the surface
    and with that against rolling. The other sphere has minus the first and the third, and the
    second as it is."""

    force: tuple[float, float, float]
    along: tuple[float, float, float]
    against: tuple[float, float, float]


@scalar
def answer(law, touch, springs, i, s, step):
    """What a contact does; what it remembers is brought up to date."""
    push, stiffness = normal_force(
        law.normal, touch.overlap, touch.closing, touch.reduced, touch.ratio
    )
    force, along, against = scaled(push, touch.normal), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if touch.overlap <= 0.0:
        forget(springs, i, s)
        return Answer(force, along, against)
    if touch.friction > 0.0:
        sliding = added_scaled(touch.velocity, -dot(touch.velocity, touch.normal), touch.normal)
        slider = Slider(
            law.memory * law.stiffness * stiffness,
            law.damping * math.sqrt(stiffness * touch.reduced),
            touch.friction * abs(push),
        )
        drag, spring = stretched(slider, kept(springs, i, s, SLIDING), sliding, touch.normal, step)
        keep(springs, i, s, SLIDING, spring)
        force, along = added(force, drag), outer(touch.normal, drag)
    if law.rolling > 0.0:
        # the velocity with which the surfaces would slip if they did not roll (Luding 2008, eq. 22)
        rolling = scaled(-touch.roller, outer(touch.turning, touch.normal))
        slider = Slider(
            law.stiffness * stiffness,
            law.damping * math.sqrt(stiffness * touch.reduced),
            law.rolling * abs(push),
        )
        drag, spring = stretched(slider, kept(springs, i, s, ROLLING), rolling, touch.normal, step)
        keep(springs, i, s, ROLLING, spring)
        against = outer(touch.normal, drag)
    return Answer(force, along, against)


@scalar
def torque_of(law, touch, found, arm):
    """Torque on a sphere of this radius."""
    torque = scaled(-arm, found.along)
    if law.rolling > 0.0:
        torque = added_scaled(torque, -touch.roller, found.against)
    return torque


@scalar
def opposite(vector):
    """Minus a vector."""
    return -vector[0], -vector[1], -vector[2]


@scalar
def kept(springs, i, s, at):
    """A spring of a contact; not stretched where contacts remember nothing."""
    if springs.shape[2] <= at:
        return 0.0, 0.0, 0.0
    return springs[i, s, at], springs[i, s, at + 1], springs[i, s, at + 2]


@scalar
def keep(springs, i, s, at, spring):
    """Remember a spring."""
    if springs.shape[2] > at:
        springs[i, s, at], springs[i, s, at + 1], springs[i, s, at + 2] = spring


@scalar
def forget(springs, i, s):
    """Forget a contact that is over."""
    for k in range(springs.shape[2]):
        springs[i, s, k] = 0.0


@scalar
def counted(total, vector, scale):
    """A sum in whole quanta, and a vector more: cut off toward zero, so that what the other sphere
    adds is exactly minus this."""
    return (
        total[0] + np.int64(vector[0] * scale),
        total[1] + np.int64(vector[1] * scale),
        total[2] + np.int64(vector[2] * scale),
    )


@scalar
def count(sums, i, vector, scale):
    """Add a vector to those of sphere i, in whole quanta."""
    a, b, c = counted(row(sums, i), vector, scale)
    sums[i, 0], sums[i, 1], sums[i, 2] = a, b, c


@scalar
def abs_sum(vector):
    """A bound of the numbers of a vector; infinite where one is none."""
    found = abs(vector[0]) + abs(vector[1]) + abs(vector[2])
    return found if found >= 0.0 else np.inf


@tell.register(Contact)
def _(law, i, time, world, told):
    bodies, box, lists, walls = world
    r = row(bodies.place, i)
    for s in range(lists.count[i]):
        j = lists.near[i, s]
        way = from_to(box, bodies.place, j, r)
        square, sum_of_radii = dot(way, way), reach(bodies, i) + reach(bodies, j)
        if square < sum_of_radii * sum_of_radii and j != i:
            touch = between(law, bodies, bodies.velocity, 0.0, i, j, way)
            energy, force = at_rest(law, touch, lists.springs, i, s)
            told[ENERGY] += quanta(energy, law.scale)
            told[TOUCHING] += 1
            add_product(told, law.scale, force, way)
    for w in range(len(walls.rows)):
        distance, out, moves = from_wall(walls.rows, w, box, r, time)
        if distance < reach(bodies, i):
            touch = at_wall(walls, bodies, bodies.velocity, 0.0, i, w, (distance, out, moves))
            energy, _ = at_rest(law, touch, walls.springs, i, w)
            told[ENERGY] += quanta(2.0 * energy, law.scale)
            told[TOUCHING] += 1


@scalar
def at_rest(law, touch, springs, i, s):
    """Energy of the springs of a contact, and its force; dashpots along the surface count as they
    are, and nothing changes."""
    push, stiffness = normal_force(
        law.normal, touch.overlap, touch.closing, touch.reduced, touch.ratio
    )
    energy = normal_energy(law.normal, touch.overlap, touch.reduced)
    force = scaled(push, touch.normal)
    if touch.friction > 0.0:
        spring = kept(springs, i, s, SLIDING)
        slider = Slider(
            law.memory * law.stiffness * stiffness,
            law.damping * math.sqrt(stiffness * touch.reduced),
            touch.friction * abs(push),
        )
        sliding = added_scaled(touch.velocity, -dot(touch.velocity, touch.normal), touch.normal)
        along, _ = stretched(slider, spring, sliding, touch.normal, 0.0)
        force = added(force, along)
        energy += 0.5 * slider.stiffness * dot(spring, spring)
    if law.rolling > 0.0:
        spring = kept(springs, i, s, ROLLING)
        energy += 0.5 * law.stiffness * stiffness * dot(spring, spring)
    return energy, force
