"""Contacts of spheres with walls."""

from mesokit.method.spheres.soft.engine.acting import beside, measure_beside
from mesokit.method.spheres.soft.engine.contact.force import (
    answer,
    at_rest,
    at_wall,
    body,
    surface,
    torque_of,
)
from mesokit.method.spheres.soft.engine.contact.remembered import NO_SPRINGS, keep, kept
from mesokit.method.spheres.soft.engine.contact.sums import abs_sum, add, counted
from mesokit.method.spheres.soft.engine.geometry import from_wall, reach, row
from mesokit.method.spheres.soft.engine.groups import ENERGY, TOUCHING
from mesokit.method.spheres.soft.engine.taken import take
from mesokit.scalar.fixed_point import quanta
from mesokit.scalar.jit import scalar


@scalar
def contact_forces_from_walls(law, i, time, step, world, room):
    """Add forces and torques of walls on sphere i; returns a bound of them."""
    bodies, box, walls = world.bodies, world.box, world.walls
    r, largest = row(bodies.place, i), 0.0
    for w in range(len(walls.rows)):
        distance, out, moves = from_wall(walls.rows, w, box, r, time)
        if distance < reach(bodies, i) + law.ahead:
            there = surface(distance, out, moves, walls.own, w)
            c = i * len(walls.rows) + w
            bound, counts = add_force(law, i, there, walls.springs, c, step, bodies)
            take(room.taken, w, counts)
            largest = max(largest, bound)
        else:
            keep(walls.springs, i * len(walls.rows) + w, NO_SPRINGS)
    return max(largest, beside(walls.solid, law, i, step, world, room))


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
        if distance < reach(bodies, i):
            there = surface(distance, out, moves, walls.own, w)
            c = i * len(walls.rows) + w
            measure_wall(law, at_wall(0.0, one, there), kept(walls.springs, c), readings)
    measure_beside(walls.solid, law, i, world, readings)


@scalar
def measure_wall(law, touch, springs, readings):
    """Add a contact with a wall to the readings of a sphere."""
    energy, _ = at_rest(law, touch, springs)
    readings[ENERGY] += quanta(2.0 * energy, law.scale)
    readings[TOUCHING] += 1
