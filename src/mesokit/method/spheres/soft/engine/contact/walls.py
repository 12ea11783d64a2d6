"""Contacts of spheres with walls and solids, and the forces and readings of all contacts."""

from mesokit.geometry.protocol import Nothing
from mesokit.geometry.solids.bodies import NO_TERM
from mesokit.method.spheres.common.contacts.geometry import from_wall, reach, row
from mesokit.method.spheres.common.contacts.groups import OPENS, Solid
from mesokit.method.spheres.common.contacts.remembered import NO_SPRINGS, keep, kept
from mesokit.method.spheres.common.contacts.solid import (
    body_of,
    contact_with,
    forget_others,
    moves_at,
    touched,
)
from mesokit.method.spheres.common.contacts.taken import take
from mesokit.method.spheres.soft.engine.acting import act, beside, measure, measure_beside
from mesokit.method.spheres.soft.engine.contact.force import (
    Contact,
    answer,
    at_rest,
    at_wall,
    body,
    surface,
    torque_of,
)
from mesokit.method.spheres.soft.engine.contact.pairs import add_contact_forces, measure_pairs
from mesokit.method.spheres.soft.engine.contact.sums import abs_sum, add, counted
from mesokit.method.spheres.soft.engine.groups import ENERGY, LARGEST, TOUCHING
from mesokit.scalar.fixed_point import quanta
from mesokit.scalar.jit import scalar


@act.register(Contact)
def _(law, mine, time, step, world, noted, room):
    largest = add_contact_forces(law, mine, step, world, room)
    for i in range(mine[0], mine[1]):
        largest = max(largest, contact_forces_from_walls(law, i, time, step, world, room))
    noted[LARGEST] = max(noted[LARGEST], largest * law.scale)


@measure.register(Contact)
def _(law, i, time, world, readings):
    measure_pairs(law, i, world, readings)
    measure_walls(law, i, time, world, readings)


@scalar
def contact_forces_from_walls(law, i, time, step, world, room):
    """Add forces and torques of walls on sphere i; returns a bound of them."""
    bodies, box, walls = world.bodies, world.box, world.walls
    r, largest = row(bodies.place, i), 0.0
    # Walls at t + dt, as spheres are. Each sphere has memory for a contact with each wall; the
    # springs of one that does not touch are cleared.
    for w in range(len(walls.rows)):
        distance, out, moves = from_wall(walls.rows, w, box, r, time)
        if distance < reach(bodies, i) + law.ahead and time < walls.own[w, OPENS]:
            there = surface(distance, out, moves, walls.own, w)
            c = i * len(walls.rows) + w
            bound, counts = add_force(law, i, there, walls.springs, c, step, bodies)
            take(room.taken, w, counts)
            largest = max(largest, bound)
        else:
            keep(walls.springs, i * len(walls.rows) + w, NO_SPRINGS)
    return max(largest, beside(walls.solid, law, i, time, step, world, room))


@scalar
def add_force(law, i, there, springs, c, step, bodies):
    """Add the force and the torque of a contact with a wall to those of sphere i, and bring its
    springs, row c, up to date; a bound of both, and the force in quanta."""
    rolls = law.rolling > 0.0
    touch = at_wall(0.5 * step, body(bodies, bodies.seen, i), there)
    found = answer(law, touch, kept(springs, c), step, rolls)
    torque = torque_of(touch, found, touch.arm, rolls)
    keep(springs, c, found.springs)
    counts = counted(found.force, law.scale)
    add(bodies.force, i, counts)
    add(bodies.torque, i, counted(torque, law.scale))
    return max(abs_sum(found.force), abs_sum(torque)), counts


@scalar
def measure_walls(law, i, time, world, readings):
    """Add the contacts of sphere i with walls to its readings."""
    bodies, box, walls = world.bodies, world.box, world.walls
    r, one = row(bodies.place, i), body(bodies, bodies.velocity, i)
    for w in range(len(walls.rows)):
        distance, out, moves = from_wall(walls.rows, w, box, r, time)
        if distance < reach(bodies, i) and time < walls.own[w, OPENS]:
            there = surface(distance, out, moves, walls.own, w)
            c = i * len(walls.rows) + w
            measure_wall(law, at_wall(0.0, one, there), kept(walls.springs, c), readings)
    measure_beside(walls.solid, law, i, time, world, readings)


@scalar
def measure_wall(law, touch, springs, readings):
    """Add a contact with a wall to the readings of a sphere."""
    energy, _ = at_rest(law, touch, springs)
    readings[ENERGY] += quanta(2.0 * energy, law.scale)
    readings[TOUCHING] += 1


beside.register(Nothing)(lambda solid, law, i, time, step, world, room: 0.0)


@measure_beside.register(Nothing)
def _(solid, law, i, time, world, readings):
    return


@scalar
def surface_at(solid, bodies, i, place):
    """The surface at a place beside sphere i, and the number of its body."""
    body = body_of(solid, place.term)
    moves = moves_at(solid, row(bodies.place, i), place)
    return surface(place.distance, place.normal, moves, solid.own, body), body


@beside.register(Solid)
def _(solid, law, i, time, step, world, room):
    bodies, largest = world.bodies, 0.0
    # Terms at the places of t + dt. A contact that ends frees the memory of its springs first.
    places = touched(solid, row(bodies.place, i), time, reach(bodies, i) + law.ahead)
    forget_others(solid, i, places[0].term, places[1].term, places[2].term)
    for place in places:
        if place.term != NO_TERM:
            there, b = surface_at(solid, bodies, i, place)
            c = contact_with(solid, i, place.term)
            bound, counts = add_force(law, i, there, solid.springs, c, step, bodies)
            take(room.taken, len(world.walls.rows) + b, counts)
            largest = max(largest, bound)
    return largest


@measure_beside.register(Solid)
def _(solid, law, i, time, world, readings):
    bodies = world.bodies
    for place in touched(solid, row(bodies.place, i), time, reach(bodies, i) + law.ahead):
        if place.term != NO_TERM and place.distance < reach(world.bodies, i):
            there, _ = surface_at(solid, world.bodies, i, place)
            touch = at_wall(0.0, body(world.bodies, world.bodies.velocity, i), there)
            springs = kept(solid.springs, contact_with(solid, i, place.term))
            measure_wall(law, touch, springs, readings)
