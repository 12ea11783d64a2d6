"""Contacts of a step: pairs of grains, and grains at walls, that may touch within it."""

import math
from typing import Any, NamedTuple

import numpy as np

from mesokit.geometry.protocol import Nothing
from mesokit.geometry.solids.bodies import NO_TERM
from mesokit.method.spheres.common.contacts.geometry import from_to, reach, row
from mesokit.method.spheres.common.contacts.groups import OPENS, Solid
from mesokit.method.spheres.common.contacts.remembered import NO_SPRINGS, keep
from mesokit.method.spheres.common.contacts.solid import (
    body_of,
    contact_with,
    forget_others,
    moves_at,
    touched,
)
from mesokit.method.spheres.common.walls import KIND, MOVES, PLANE, displaced, entries, outward
from mesokit.method.spheres.rigid.engine.groups import DRAG, INVERSE, LEAST, PER_MASS, SHIFT
from mesokit.method.spheres.rigid.engine.sliding import image_speed
from mesokit.method.spheres.rigid.law.cohesion import pull
from mesokit.method.spheres.rigid.law.restitution import bouncing
from mesokit.method.spheres.rigid.law.signorini import closing
from mesokit.scalar.jit import by_type, for_each, generic, scalar
from mesokit.scalar.vector import added_scaled, dot, first, scaled

PAIR, ROW, TERM = range(3)  # kinds of slots: of lists, walls that are rows, and other walls
KINDS = 3
FRICTION, RESTITUTION = 0, 1  # columns of `Walls.own`
GAP, PULL = 0, 1  # columns of `Found.beside`
TORQUE, INERTIA, LIMIT, ONE, OTHER = 0, 3, 4, 5, 6  # columns of `Found.roll`


@by_type
def alongside(flat):
    """A pattern of what lies along a surface, or of spins: one number in 2D, three in 3D."""
    if len(flat) == 2:
        return lambda flat: (0.0,)
    return lambda flat: (0.0, 0.0, 0.0)


@by_type
def after_drag(flat):
    """The column of friction, after normal, least velocity, mass, push and drag; in the next one is
    the speed of an image along x."""
    if len(flat) == 2:
        return lambda flat: 6
    return lambda flat: 9


@by_type
def spin_at(flat):
    """The first column of the spin in `Bodies.motion`."""
    if len(flat) == 2:
        return lambda flat: 2
    return lambda flat: 4


@for_each
def write(rows, i, start, values):
    """Write a tuple into consecutive entries of row i."""
    return "rows[i, start + {k}] = values[{k}]"


class Room(NamedTuple):
    """Room for the contacts of a thread: the first place, how many there are, and whether all
    contacts are new, since places in memory have changed."""

    start: int
    most: int
    afresh: bool


class Look(NamedTuple):
    """What contacts are looked for with: the law, the time of a step, the time at its start, and
    the gap up to which two may come together in it."""

    law: Any
    step: float
    time: float
    ahead: float


class Side(NamedTuple):
    """Sides of a contact: normal, gap, speed of the image along x, friction and restitution."""

    normal: Any
    gap: float
    moves: float
    friction: float
    restitution: float


@scalar
def find_contacts(look, mine, world, found, room):
    """Find the contacts of the grains of a thread; their number, and whether they are others than
    those of the last step.

    mine: first grain and last + 1.
    """
    bodies, lists, box = world.bodies, world.lists, world.box
    law, step, ahead = look.law, look.step, look.ahead
    count, changed = 0, room.afresh
    if room.afresh:  # places in memory have changed: none of the pairs written here is known
        for f in range(room.start, room.start + room.most):
            found.pair[f, 0] = -1
    # Places and velocities at the start of the step. Impulses of pairs that came apart are
    # forgotten here, those of the others are read when all contacts are in order.
    for i in range(mine[0], mine[1]):
        r, reached = row(bodies.place, i), reach(bodies, i)
        for s in range(lists.own[i]):
            j = np.int64(lists.near[i, s])
            separation, slot = from_to(box, bodies.place, j, r), lists.begin[i] + s
            touch, square = reached + reach(bodies, j), dot(separation, separation)
            if square < (touch + ahead) * (touch + ahead):
                f, distance = place_for(room, count), math.sqrt(square)
                changed |= note(found, room, f, i, j, slot * KINDS + PAIR)
                one, other = bodies.number[i], bodies.number[j]
                found.key[f, 0], found.key[f, 1] = min(one, other), max(one, other)
                normal = first(scaled(1.0 / distance, separation), world.flat)
                moves = image_speed(box, added_scaled(r, -1.0, row(bodies.place, j)))
                side = Side(normal, distance - touch, moves, law.friction, law.restitution)
                put(law, step, world, found, f, side)
                put_roll(law, world, found, f, reached, 1.0 / reach(bodies, j))
                count += 1
            elif remembers(lists.springs, slot):
                keep(lists.springs, slot, NO_SPRINGS)
        count, changed = find_at_rows(look, i, world, found, room, count, changed)
        count, changed = find_beside(world.walls.solid, look, i, world, found, room, count, changed)
    return count, changed


@scalar
def place_for(room, count):
    """The place of the next contact; without room the last one, as often as it takes to count."""
    return room.start + min(count, room.most - 1)


@scalar
def note(found, room, f, i, j, slot):
    """Write which two touch; whether that is new."""
    same = found.pair[f, 0] == i and found.pair[f, 1] == j and found.slot[f] == slot
    found.pair[f, 0], found.pair[f, 1], found.slot[f] = i, j, slot
    return not same


@scalar
def remembers(springs, slot):
    """Whether a contact had an impulse in the last step."""
    return springs[slot, 0] != 0.0 or springs[slot, 1] != 0.0 or springs[slot, 2] != 0.0


@scalar
def put(law, step, world, found, f, side):
    """Write what the sweeps need of a contact, without impulses."""
    d, motion = len(world.flat), world.motion
    i, j, normal = found.pair[f, 0], found.pair[f, 1], side.normal
    least = closing(side.gap, step)
    if side.restitution > 0.0:
        apart = added_scaled(entries(motion, i, 0, normal), -1.0, entries(motion, j, 0, normal))
        before = dot(apart, normal) - side.moves * normal[0]
        least = bouncing(side.restitution, before, least)
    mass = 1.0 / (motion[i, INVERSE] + motion[j, INVERSE])
    write(found.contact, f, 0, normal)
    write(found.contact, f, d + LEAST, (least, mass, 0.0))
    write(found.contact, f, d + DRAG, alongside(normal))
    write(found.contact, f, after_drag(normal), (side.friction, side.moves))
    found.beside[f, GAP] = side.gap
    found.beside[f, PULL] = pull(law.pull, law.within, side.gap, step)


@scalar
def put_roll(law, world, found, f, reached, inverse):
    """Write what friction against rolling needs; inverse: of the other radius, 0 of a wall."""
    if law.rolling > 0.0:
        motion, i, j = world.motion, found.pair[f, 0], found.pair[f, 1]
        one, other = 1.0 / reached, inverse
        per_inertia = motion[i, INVERSE] * one * one + motion[j, INVERSE] * other * other
        write(found.roll, f, 0, (0.0, 0.0, 0.0, law.turns / per_inertia))
        write(found.roll, f, LIMIT, (law.rolling / (one + other), one, other))


@scalar
def find_at_rows(look, i, world, found, room, count, changed):
    """Find the contacts of a grain with walls that are rows."""
    bodies, walls, box = world.bodies, world.walls, world.box
    law, step, time = look.law, look.step, look.time
    r, reached, rows = row(bodies.place, i), reach(bodies, i), walls.rows
    # Walls at the start of the step; one that vibrates has the mean speed of the step.
    for w in range(len(rows)):
        distance, out = outward(rows, w, box, r)
        moves, shift = entries(rows, w, MOVES, r), 0.0
        pushed = world.plates.drive[w, PER_MASS] > 0.0
        if pushed:
            shift = world.plates.state[w, SHIFT]
        elif rows[w, KIND] == PLANE:
            shift, _ = displaced(rows, w, time)
            later, _ = displaced(rows, w, time + step)
            moves = added_scaled(moves, (later - shift) / step, out)
        gap, slot = distance - shift - reached, i * len(rows) + w
        if gap < look.ahead and time < walls.own[w, OPENS]:
            f = place_for(room, count)
            at = world.plates.first + w if pushed else len(bodies.number) + f
            if not pushed:
                still(world, at, moves)
            changed |= put_wall(world, found, room, f, i, slot * KINDS + ROW, w, at)
            normal = first(out, world.flat)
            side = Side(normal, gap, 0.0, walls.own[w, FRICTION], walls.own[w, RESTITUTION])
            put(law, step, world, found, f, side)
            put_roll(law, world, found, f, reached, 0.0)
            count += 1
        elif remembers(walls.springs, slot):
            keep(walls.springs, slot, NO_SPRINGS)
    return count, changed


@scalar
def put_wall(world, found, room, f, i, slot, w, at):
    """Write a contact of a grain with a wall number w, in row `at` of motion; whether it is new."""
    found.key[f, 0], found.key[f, 1] = world.bodies.number[i], len(world.bodies.number) + w
    return note(found, room, f, i, at, slot)


@scalar
def still(world, at, moves):
    """Write the motion of a wall that nothing moves, in a row of its own for each contact."""
    for motion in (world.motion, world.before):
        write(motion, at, 0, first(moves, world.flat))
        motion[at, INVERSE] = 0.0
        write(motion, at, spin_at(world.flat), alongside(world.flat))


@generic
def find_beside(solid, look, i, world, found, room, count, changed):
    """Find the contacts of a grain with walls of any shape."""


find_beside.register(Nothing)(
    lambda solid, look, i, world, found, room, count, changed: (count, changed)
)


@find_beside.register(Solid)
def _(solid, look, i, world, found, room, count, changed):
    r, reached, rows = row(world.bodies.place, i), reach(world.bodies, i), len(world.walls.rows)
    places = touched(solid, r, look.time, reached + look.ahead)
    # A contact that ends frees the memory of its impulse first.
    forget_others(solid, i, places[0].term, places[1].term, places[2].term)
    for place in places:
        if place.term != NO_TERM:
            f, body = place_for(room, count), body_of(solid, place.term)
            slot = contact_with(solid, i, place.term) * KINDS + TERM
            at = len(world.bodies.number) + f
            still(world, at, moves_at(solid, r, place))
            changed |= put_wall(world, found, room, f, i, slot, rows + place.term, at)
            own, normal = solid.own, first(place.normal, world.flat)
            gap = place.distance - reached
            side = Side(normal, gap, 0.0, own[body, FRICTION], own[body, RESTITUTION])
            put(look.law, look.step, world, found, f, side)
            put_roll(look.law, world, found, f, reached, 0.0)
            count += 1
    return count, changed
