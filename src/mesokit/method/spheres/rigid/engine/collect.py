"""A row for each contact with a force, as observables and trajectories take them."""

import math
from typing import Any, NamedTuple

import numpy as np

from mesokit.geometry.protocol import Nothing
from mesokit.geometry.solids.bodies import NO_TERM
from mesokit.kernels.kernel import kernel
from mesokit.method.spheres.common.contacts.geometry import from_to, from_wall, reach, row
from mesokit.method.spheres.common.contacts.groups import OPENS, Solid
from mesokit.method.spheres.common.contacts.now import FORCE, GAP, NORMAL, PLACE
from mesokit.method.spheres.common.contacts.solid import MOST, body_of, touched
from mesokit.method.spheres.common.walls import entries
from mesokit.method.spheres.rigid.engine.find import remembers, write
from mesokit.method.spheres.rigid.engine.groups import PER_MASS, SHIFT
from mesokit.method.spheres.rigid.law.cohesion import pull
from mesokit.scalar.jit import generic, scalar
from mesokit.scalar.vector import added_scaled, dot, scaled

ZERO = (0.0, 0.0, 0.0)


class Rows(NamedTuple):
    """pairs (rows, 2): numbers of the two, of a wall -1 less that of its row or body; values
    (rows, 10): see `contacts.now`."""

    pairs: Any
    values: Any


@kernel
def collect(law, step, time, world, rows):
    """Write all contacts that had an impulse in the last step, or that pull; places and normals are
    those of now."""
    bodies, lists, c = world.bodies, world.lists, 0
    for i in range(len(bodies.number)):
        for s in range(lists.own[i]):
            slot, sign = lists.begin[i] + s, 1.0
            one, other = np.int64(i), np.int64(lists.near[i, s])
            if bodies.number[other] < bodies.number[one]:  # places have the same bits either way
                one, other, sign = other, one, -1.0
            r, reached = row(bodies.place, one), reach(bodies, one)
            separation = from_to(world.box, bodies.place, other, r)
            distance = math.sqrt(dot(separation, separation))
            gap = distance - (reached + reach(bodies, other))
            if acts(law, lists.springs, slot, gap):
                normal = scaled(1.0 / distance, separation)
                force = force_of(law, step, lists.springs, slot, sign, normal, gap)
                place = added_scaled(r, -(reached + 0.5 * gap), normal)
                c = fill(
                    rows, c, bodies.number[one], bodies.number[other], normal, force, place, gap
                )
        c = collect_walls(law, step, time, i, world, rows, c)
        c = collect_beside(world.walls.solid, law, step, time, i, world, rows, c)


@kernel
def find_deepest(time, world, found):
    """Write the smallest gap of all pairs and of grains at walls, below 0 where any overlap."""
    bodies, lists, walls, least = world.bodies, world.lists, world.walls, 0.0
    for i in range(len(bodies.number)):
        r, reached = row(bodies.place, i), reach(bodies, i)
        for s in range(lists.own[i]):
            j = lists.near[i, s]
            separation = from_to(world.box, bodies.place, j, r)
            least = min(least, dot(separation, separation) ** 0.5 - reached - reach(bodies, j))
        for w in range(len(walls.rows)):
            distance, _, _ = from_wall(walls.rows, w, world.box, r, time)
            if world.plates.drive[w, PER_MASS] > 0.0:
                distance -= world.plates.state[w, SHIFT]
            if time < walls.own[w, OPENS]:
                least = min(least, distance - reached)
        least = min(least, nearest_beside(walls.solid, time, r, reached))
    found[0] = least


@generic
def nearest_beside(solid, time, r, reached):
    """Gap between a grain and the nearest wall of any shape; 0 where they do not overlap."""


nearest_beside.register(Nothing)(lambda solid, time, r, reached: 0.0)


@nearest_beside.register(Solid)
def _(solid, time, r, reached):
    nearest, _, _ = touched(solid, r, time, reached)
    return min(nearest.distance - reached, 0.0)


@scalar
def acts(law, springs, slot, gap):
    """Whether a contact had an impulse in the last step, or its surfaces pull one another."""
    return remembers(springs, slot) or pull(law.pull, law.within, gap, 1.0) > 0.0


@scalar
def force_of(law, step, springs, slot, sign, normal, gap):
    """The force of a contact, the pull of cohesion included; sign: 1 if the impulse is on the first
    of the two, else -1."""
    whole = scaled(sign / step, entries(springs, slot, 0, ZERO))
    return added_scaled(whole, -pull(law.pull, law.within, gap, 1.0), normal)


@scalar
def fill(rows, c, one, other, normal, force, place, gap):
    """Write a row; the number of the next one."""
    rows.pairs[c, 0], rows.pairs[c, 1] = one, other
    write(rows.values, c, NORMAL, normal)
    write(rows.values, c, FORCE, force)
    write(rows.values, c, PLACE, place)
    rows.values[c, GAP] = gap
    return c + 1


@scalar
def collect_walls(law, step, time, i, world, rows, c):
    """Write the contacts of a grain with walls that are rows; the number of the next row."""
    bodies, walls = world.bodies, world.walls
    r, reached = row(bodies.place, i), reach(bodies, i)
    for w in range(len(walls.rows)):
        slot = i * len(walls.rows) + w
        distance, out, _ = from_wall(walls.rows, w, world.box, r, time)
        if world.plates.drive[w, PER_MASS] > 0.0:
            distance -= world.plates.state[w, SHIFT]
        gap = distance - reached
        if time < walls.own[w, OPENS] and acts(law, walls.springs, slot, gap):
            force = force_of(law, step, walls.springs, slot, 1.0, out, gap)
            place = added_scaled(r, -distance, out)
            c = fill(rows, c, bodies.number[i], -1 - w, out, force, place, gap)
    return c


@generic
def collect_beside(solid, law, step, time, i, world, rows, c):
    """Write the contacts of a grain with walls of any shape; the number of the next row."""


collect_beside.register(Nothing)(lambda solid, law, step, time, i, world, rows, c: c)


@collect_beside.register(Solid)
def _(solid, law, step, time, i, world, rows, c):
    r, reached = row(world.bodies.place, i), reach(world.bodies, i)
    for place in touched(solid, r, time, reached + world.lists.skin):
        for s in range(MOST):
            slot = i * MOST + s
            touches, gap = place.term != NO_TERM, place.distance - reached
            touches = touches and solid.terms[i, s] == place.term
            if touches and acts(law, solid.springs, slot, gap):
                b = -1 - len(world.walls.rows)
                force = force_of(law, step, solid.springs, slot, 1.0, place.normal, gap)
                at = added_scaled(r, -place.distance, place.normal)
                number, other = world.bodies.number[i], b - body_of(solid, place.term)
                c = fill(rows, c, number, other, place.normal, force, at, gap)
    return c
