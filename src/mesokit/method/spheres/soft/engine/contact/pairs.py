"""Contacts of spheres with spheres, in batches.

First the near pairs are found, without branches; then their properties are copied side by side;
then forces follow in a loop over vectors, and are added up. If both spheres of a pair belong to one
thread, the force is computed once, for the sphere before in memory; else each thread computes it.
The bits depend neither on that nor on batches. Springs are kept where forces are computed.
"""

import numpy as np

from mesokit.method.spheres.common.contacts.geometry import from_to, reach, row
from mesokit.method.spheres.common.contacts.remembered import (
    NO_SPRINGS,
    keep,
    kept,
    kept_between,
)
from mesokit.method.spheres.soft.engine.central import add_product
from mesokit.method.spheres.soft.engine.contact.force import (
    answer,
    at_rest,
    between,
    body,
    meeting,
    torque_of,
    torque_on_other,
)
from mesokit.method.spheres.soft.engine.contact.room import (
    BACK,
    BATCH,
    BOUND,
    COUNT,
    FIRST,
    FORCE,
    GROUP,
    PLACE,
    ROW,
    SECOND,
    SEPARATION,
    TORQUE,
    VECTOR,
    load,
    load_meeting,
    load_springs,
    store,
    store_meeting,
    store_springs,
)
from mesokit.method.spheres.soft.engine.contact.sums import abs_sum, add, counted, subtract
from mesokit.method.spheres.soft.engine.groups import ENERGY, TOUCHING
from mesokit.scalar.fixed_point import quanta
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import dot

PART = 16  # of a list at a time


@scalar
def add_contact_forces(law, mine, step, world, room):
    """Add forces and torques of all pairs of this thread; returns a bound of them."""
    lists, largest = world.lists, 0.0
    i, last, begin, next_contact = mine[0], mine[1], 0, lists.begin[mine[0]]
    # Batches fill the first-level cache: parts of lists are searched until a batch is nearly full,
    # then its forces are one loop over vectors. Springs of all contacts searched are cleared before
    # those that still touch are written again.
    while i < last:
        n, first_contact = 0, next_contact
        while i < last and n <= BATCH - PART:
            end = min(begin + PART, lists.own[i])
            n = find_near(law, i, begin, end, world, room, n)
            next_contact += end - begin
            begin = end
            if begin == lists.own[i]:
                i, begin = i + 1, 0
        bring(world, room, n)
        for c in range(first_contact, next_contact):
            keep(lists.springs, c, NO_SPRINGS)  # those that are over; others are written again
        if law.rolling > 0.0:
            follow(law, step, room, n, True)
        else:
            follow(law, step, room, n, False)
        largest = max(largest, add_up(law, mine, world, room, n))
    return largest


@scalar
def find_near(law, i, begin, end, world, room, n):
    """Add the pairs of sphere i that touch, or soon will, to the batch; returns their number."""
    bodies, box, lists = world.bodies, world.box, world.lists
    r, far, kept_at = row(bodies.place, i), reach(bodies, i), lists.begin[i]
    # Places at t + dt. Every candidate is written into the next row of the batch, which advances
    # only if it is near: no branch depends on the distance.
    for s in range(begin, end):
        j = np.uint64(lists.near[i, s])
        separation = from_to(box, bodies.place, j, r)
        apart = far + reach(bodies, j) + law.ahead
        near = 1 if dot(separation, separation) < apart * apart else 0
        c = np.uint64(n)
        at = np.uint64(kept_at + s)
        room.pairs[FIRST + c], room.pairs[SECOND + c], room.pairs[PLACE + c] = np.uint64(i), j, at
        store(room.numbers, SEPARATION, c, separation)
        n += near
    return n


@scalar
def bring(world, room, n):
    """Copy velocities, radii, masses and springs of the pairs of a batch side by side."""
    bodies = world.bodies
    for c in range(np.uint64(n)):
        i, j = room.pairs[FIRST + c], room.pairs[SECOND + c]
        met = meeting(body(bodies, bodies.seen, i), body(bodies, bodies.seen, j))
        store_meeting(room.numbers, c, met)
        store_springs(room.numbers, c, kept(world.lists.springs, room.pairs[PLACE + c]))


@scalar
def follow(law, step, room, n, rolls):
    """Compute forces and torques of a batch; `rolls`: whether rolling is resisted."""
    numbers = room.numbers
    # Rows of the batch lie at constant offsets, so this loop becomes one over vectors of contacts.
    # Forces are rounded to quanta here: the other sphere gets exactly the opposite.
    for c in range(np.uint64((n + GROUP - 1) & -GROUP)):
        met = load_meeting(numbers, c)
        touch = between(law, 0.5 * step, load(numbers, SEPARATION, c, VECTOR), met)
        found = answer(law, touch, load_springs(numbers, c), step, rolls)
        torque = torque_of(touch, found, met.reach, rolls)
        back = torque_on_other(touch, found, met.other, rolls)
        store(room.counts, FORCE, c, counted(found.force, law.scale))
        store(room.counts, TORQUE, c, counted(torque, law.scale))
        store(room.counts, BACK, c, counted(back, law.scale))
        store(numbers, BOUND, c, (max(abs_sum(found.force), abs_sum(torque), abs_sum(back)),))
        store_springs(numbers, c, found.springs)


@scalar
def add_up(law, mine, world, room, n):
    """Add a batch to the sums of its spheres; returns a bound of its forces and torques."""
    bodies, largest = world.bodies, 0.0
    # The second sphere is written only if it belongs to this thread, so threads do not race. Else
    # its own thread finds the same force with the opposite sign. Quanta add up without an order.
    for c in range(np.uint64(n)):
        i, j = room.pairs[FIRST + c], room.pairs[SECOND + c]
        force = load(room.counts, FORCE, c, COUNT)
        add(bodies.force, i, force)
        add(bodies.torque, i, load(room.counts, TORQUE, c, COUNT))
        if mine[0] <= np.int64(j) < mine[1]:
            subtract(bodies.force, j, force)
            add(bodies.torque, j, load(room.counts, BACK, c, COUNT))
        largest = max(largest, room.numbers[np.uint64(BOUND) * ROW + c])
        keep(world.lists.springs, room.pairs[PLACE + c], load_springs(room.numbers, c))
    return largest


@scalar
def measure_pairs(law, i, world, readings):
    """Add the contacts of sphere i with spheres to its readings."""
    bodies, box, lists = world.bodies, world.box, world.lists
    r, one = row(bodies.place, i), body(bodies, bodies.velocity, i)
    for s in range(lists.count[i]):
        j = lists.near[i, s]
        separation = from_to(box, bodies.place, j, r)
        square, sum_of_radii = dot(separation, separation), reach(bodies, i) + reach(bodies, j)
        if square < sum_of_radii * sum_of_radii and j != i:
            touch = between(law, 0.0, separation, meeting(one, body(bodies, bodies.velocity, j)))
            energy, force = at_rest(law, touch, kept_between(lists, i, j))
            readings[ENERGY] += quanta(energy, law.scale)
            readings[TOUCHING] += 1
            add_product(readings, law.scale, force, separation)
