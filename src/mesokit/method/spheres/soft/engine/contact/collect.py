"""A row for each contact of the present state, as observables and trajectories take them."""

from typing import Any, NamedTuple

from mesokit.geometry.protocol import Nothing
from mesokit.geometry.solids.bodies import NO_TERM
from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import share
from mesokit.method.spheres.common.contacts.geometry import from_to, from_wall, reach, row
from mesokit.method.spheres.common.contacts.groups import OPENS, Solid
from mesokit.method.spheres.common.contacts.now import FORCE, GAP, NORMAL, PLACE
from mesokit.method.spheres.common.contacts.remembered import kept, kept_between
from mesokit.method.spheres.common.contacts.solid import contact_with, touched
from mesokit.method.spheres.soft.engine.central import Central
from mesokit.method.spheres.soft.engine.contact.force import (
    Contact,
    at_rest,
    at_wall,
    between,
    body,
    meeting,
    surface,
)
from mesokit.method.spheres.soft.engine.contact.walls import surface_at
from mesokit.scalar.jit import generic, scalar
from mesokit.scalar.vector import added_scaled, dot


class Rows(NamedTuple):
    """begin (n,): the first row of each sphere, in the order of memory; pairs (rows, 2): numbers of
    the two, of a wall -1 less that of its row or body; values (rows, 10): see `contacts.now`."""

    begin: Any
    pairs: Any
    values: Any


@kernel
def collect_all(worker, time, law, world, rows):
    """Write the contacts of every sphere with those of larger numbers and with walls."""
    first, last = share(len(world.bodies.number), worker.thread, worker.threads)
    for i in range(first, last):
        collect(law, i, time, world, rows)


@generic
def collect(law, i, time, world, rows):
    """Write the contacts of sphere i; potentials have none."""


@generic
def collect_beside(solid, law, i, time, world, rows, c):
    """Write the contacts of sphere i with a solid, from row c on."""


@collect.register(Central)
def _(law, i, time, world, rows):
    return


@collect.register(Contact)
def _(law, i, time, world, rows):
    c = collect_pairs(law, i, world, rows, rows.begin[i])
    c = collect_walls(law, i, time, world, rows, c)
    collect_beside(world.walls.solid, law, i, time, world, rows, c)


@scalar
def collect_pairs(law, i, world, rows, c):
    """Write the contacts of sphere i with others; returns the next row."""
    bodies, box, lists = world.bodies, world.box, world.lists
    r, one = row(bodies.place, i), body(bodies, bodies.velocity, i)
    for s in range(lists.count[i]):
        j = lists.near[i, s]
        separation = from_to(box, bodies.place, j, r)
        square, sum_of_radii = dot(separation, separation), reach(bodies, i) + reach(bodies, j)
        # Both spheres have the other on their lists; the one with the smaller number writes.
        if square < sum_of_radii * sum_of_radii and bodies.number[i] < bodies.number[j]:
            touch = between(law, 0.0, separation, meeting(one, body(bodies, bodies.velocity, j)))
            _, force = at_rest(law, touch, kept_between(lists, i, j))
            place = added_scaled(r, -(touch.arm - 0.5 * touch.overlap), touch.normal)
            c = write(rows, c, (bodies.number[i], bodies.number[j]), touch, force, place)
    return c


@scalar
def collect_walls(law, i, time, world, rows, c):
    """Write the contacts of sphere i with rows of walls; returns the next row."""
    bodies, box, walls = world.bodies, world.box, world.walls
    r, one = row(bodies.place, i), body(bodies, bodies.velocity, i)
    for w in range(len(walls.rows)):
        distance, out, moves = from_wall(walls.rows, w, box, r, time)
        if distance < reach(bodies, i) and time < walls.own[w, OPENS]:
            touch = at_wall(0.0, one, surface(distance, out, moves, walls.own, w))
            springs = kept(walls.springs, i * len(walls.rows) + w)
            c = collect_wall(law, touch, springs, rows, c, (bodies.number[i], w), r)
    return c


@scalar
def collect_wall(law, touch, springs, rows, c, which, r):
    """Write a contact of a sphere at r with a wall; `which`: number of the sphere and the wall."""
    _, force = at_rest(law, touch, springs)
    place = added_scaled(r, -(touch.arm - touch.overlap), touch.normal)
    return write(rows, c, (which[0], -1 - which[1]), touch, force, place)


collect_beside.register(Nothing)(lambda solid, law, i, time, world, rows, c: None)


@collect_beside.register(Solid)
def _(solid, law, i, time, world, rows, c):
    bodies = world.bodies
    r, one = row(bodies.place, i), body(bodies, bodies.velocity, i)
    for place in touched(solid, r, time, reach(bodies, i)):
        if place.term != NO_TERM and place.distance < reach(bodies, i):
            there, b = surface_at(solid, bodies, i, place)
            springs = kept(solid.springs, contact_with(solid, i, place.term))
            which = bodies.number[i], len(world.walls.rows) + b
            c = collect_wall(law, at_wall(0.0, one, there), springs, rows, c, which, r)


@scalar
def write(rows, c, pair, touch, force, place):
    """Write one row; returns the next."""
    rows.pairs[c, 0], rows.pairs[c, 1] = pair
    for k in range(3):
        rows.values[c, NORMAL + k] = touch.normal[k]
        rows.values[c, FORCE + k] = force[k]
        rows.values[c, PLACE + k] = place[k]
    rows.values[c, GAP] = -touch.overlap
    return c + 1
